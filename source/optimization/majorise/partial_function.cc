// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/partial_function.h>

namespace Debond
{
  PartialFunction::PartialFunction(const PiecewiseQuadratic        &function,
                                   const dealii::Vector<double>    &point,
                                   const std::vector<unsigned int> &part)
    : phi(function)
    , s(point)
    , components(part)
    , selection(point.size(), part.size())
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (unsigned int k = 0; k < components.size(); ++k)
      entries.emplace_back(components[k], k, 1.);
    selection.setFromTriplets(entries.begin(), entries.end());
  }



  dealii::Vector<double>
  PartialFunction::whole(const dealii::Vector<double> &part) const
  {
    dealii::Vector<double> result = s;
    for (unsigned int k = 0; k < components.size(); ++k)
      result(components[k]) = part(k);
    return result;
  }



  double
  PartialFunction::value(const dealii::Vector<double> &part) const
  {
    return phi.value(whole(part));
  }



  void
  PartialFunction::subgradient(const dealii::Vector<double> &part,
                               dealii::Vector<double>       &xi) const
  {
    dealii::Vector<double> forces(s.size());
    phi.subgradient(whole(part), forces);
    for (unsigned int k = 0; k < components.size(); ++k)
      xi(k) = forces(components[k]);
  }



  Eigen::SparseMatrix<double>
  PartialFunction::curvature(const dealii::Vector<double> &part) const
  {
    return selection.transpose() * phi.curvature(whole(part)) * selection;
  }
} // namespace Debond
