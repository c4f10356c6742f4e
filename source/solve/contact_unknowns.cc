// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/contact_unknowns.h>

#include <boost/serialization/utility.hpp>

#include <unordered_map>
#include <utility>

namespace Debond
{
  Eigen::VectorXd
  ContactUnknowns::trace(const DistributedVector &v) const
  {
    // Each normal belongs to one rank, so that a sum over the ranks gives s to
    // all of them.
    Eigen::VectorXd s = Eigen::VectorXd::Zero(normals.size());
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (own.is_element(normals[i]))
        s(i) = v(normals[i]);
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(s.data(),
                                                                s.size()),
                                ranks,
                                dealii::ArrayView<double>(s.data(), s.size()));
    return s;
  }



  void
  ContactUnknowns::add(const VectorView &s, DistributedVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (own.is_element(normals[i]))
        v(normals[i]) += s(i);
  }



  void
  ContactUnknowns::set(const VectorView &s, DistributedVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (own.is_element(normals[i]))
        v(normals[i]) = s(i);
  }



  void
  ContactUnknowns::set_zero(const ActiveSet &held, DistributedVector &v) const
  {
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (held[i] != 0 && own.is_element(normals[i]))
        v(normals[i]) = 0.;
  }



  Eigen::SparseMatrix<double>
  ContactUnknowns::block_of(const dealii::SparseMatrix<double> &A) const
  {
    std::unordered_map<dealii::types::global_dof_index, unsigned int> nodes;
    for (unsigned int i = 0; i < normals.size(); ++i)
      nodes[normals[i]] = i;
    using Place = std::pair<unsigned int, unsigned int>;
    // Each rank reads its own rows, and the contact boundary is small enough
    // for all ranks to have the whole block.
    std::vector<std::pair<Place, double>> entries;
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (own.is_element(normals[i]))
        for (auto entry = A.begin(normals[i]); entry != A.end(normals[i]);
             ++entry)
          if (const auto node = nodes.find(entry->column());
              node != nodes.end())
            entries.emplace_back(Place(i, node->second), entry->value());
    std::vector<Eigen::Triplet<double>> all;
    for (const auto &of_rank :
         dealii::Utilities::MPI::all_gather(ranks, entries))
      for (const auto &[place, value] : of_rank)
        all.emplace_back(place.first, place.second, value);
    Eigen::SparseMatrix<double> block(normals.size(), normals.size());
    block.setFromTriplets(all.begin(), all.end());
    return block;
  }



  void
  ContactUnknowns::truncate(const Eigen::SparseMatrix<double> &E,
                            const ActiveSet                   &held,
                            TruncatedMultigrid                &cycle) const
  {
    // Each rank gives the cycle the entries of E in its own rows and the held
    // normals that are its own.
    std::vector<TruncatedMultigrid::Entry> entries;
    std::vector<unsigned int>              held_unknowns;
    for (int j = 0; j < E.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(E, j); entry;
           ++entry)
        if (own.is_element(normals[entry.row()]))
          entries.push_back({normals[entry.row()], normals[j], entry.value()});
    for (unsigned int i = 0; i < normals.size(); ++i)
      if (held[i] != 0 && own.is_element(normals[i]))
        held_unknowns.push_back(normals[i]);
    cycle.truncate(entries, held_unknowns);
  }
} // namespace Debond
