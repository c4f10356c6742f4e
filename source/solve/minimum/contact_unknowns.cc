// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/minimum/contact_unknowns.h>

#include <boost/serialization/utility.hpp>

#include <unordered_map>

namespace Debond
{
  Eigen::VectorXd
  ContactUnknowns::trace(const DistributedVector &v) const
  {
    // Each of them belongs to one rank, so that a sum over the ranks gives s to
    // all of them.
    Eigen::VectorXd s = Eigen::VectorXd::Zero(dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (own.is_element(dofs[i]))
        s(i) = v(dofs[i]);
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(s.data(),
                                                                s.size()),
                                ranks,
                                dealii::ArrayView<double>(s.data(), s.size()));
    return s;
  }



  void
  ContactUnknowns::add(const VectorView &s, DistributedVector &v) const
  {
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (own.is_element(dofs[i]))
        v(dofs[i]) += s(i);
  }



  void
  ContactUnknowns::set(const VectorView &s, DistributedVector &v) const
  {
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (own.is_element(dofs[i]))
        v(dofs[i]) = s(i);
  }



  void
  ContactUnknowns::set_zero(const ActiveSet &held, DistributedVector &v) const
  {
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (held[i] != 0 && own.is_element(dofs[i]))
        v(dofs[i]) = 0.;
  }



  Eigen::SparseMatrix<double>
  ContactUnknowns::block_of(const dealii::SparseMatrix<double> &A) const
  {
    // The columns of A that belong to the contact boundary are found by a map
    // from the numbers of unknowns to those of nodes, since rows of A list all
    // neighbours.
    std::unordered_map<dealii::types::global_dof_index, unsigned int> nodes;
    for (unsigned int i = 0; i < dofs.size(); ++i)
      nodes[dofs[i]] = i;
    using Place = std::pair<unsigned int, unsigned int>;
    // Each rank reads its own rows, and the contact boundary is small enough
    // for all ranks to have the whole block.
    std::vector<std::pair<Place, double>> entries;
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (own.is_element(dofs[i]))
        for (auto entry = A.begin(dofs[i]); entry != A.end(dofs[i]); ++entry)
          if (const auto node = nodes.find(entry->column());
              node != nodes.end())
            entries.emplace_back(Place(i, node->second), entry->value());
    std::vector<Eigen::Triplet<double>> all;
    for (const auto &of_rank :
         dealii::Utilities::MPI::all_gather(ranks, entries))
      for (const auto &[place, value] : of_rank)
        all.emplace_back(place.first, place.second, value);
    Eigen::SparseMatrix<double> block(dofs.size(), dofs.size());
    block.setFromTriplets(all.begin(), all.end());
    return block;
  }



  void
  ContactUnknowns::truncate(const Eigen::SparseMatrix<double> &E,
                            const ActiveSet                   &held,
                            TruncatedMultigrid                &cycle) const
  {
    // Each rank gives the cycle the entries of E in its own rows and the held
    // ones that are its own.
    std::vector<TruncatedMultigrid::Entry> entries;
    std::vector<unsigned int>              held_unknowns;
    for (int j = 0; j < E.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(E, j); entry;
           ++entry)
        if (own.is_element(dofs[entry.row()]))
          entries.push_back({dofs[entry.row()], dofs[j], entry.value()});
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (held[i] != 0 && own.is_element(dofs[i]))
        held_unknowns.push_back(dofs[i]);
    cycle.truncate(entries, held_unknowns);
  }
} // namespace Debond
