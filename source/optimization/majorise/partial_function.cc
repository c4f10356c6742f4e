// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/majorise/partial_function.h>

namespace Debond
{
  PartialFunction::PartialFunction(const PiecewiseQuadratic        &function,
                                   const VectorView                &point,
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



  Eigen::VectorXd
  PartialFunction::whole(const VectorView &part) const
  {
    Eigen::VectorXd result = s;
    for (unsigned int k = 0; k < components.size(); ++k)
      result(components[k]) = part(k);
    return result;
  }



  double
  PartialFunction::value(const VectorView &part) const
  {
    return phi.value(whole(part));
  }



  Eigen::VectorXd
  PartialFunction::subgradient(const VectorView &part) const
  {
    const Eigen::VectorXd forces = phi.subgradient(whole(part));
    Eigen::VectorXd       xi(components.size());
    for (unsigned int k = 0; k < components.size(); ++k)
      xi(k) = forces(components[k]);
    return xi;
  }



  Eigen::SparseMatrix<double>
  PartialFunction::curvature(const VectorView &part) const
  {
    return selection.transpose() * phi.curvature(whole(part)) * selection;
  }



  bool
  PartialFunction::has_moving_points() const
  {
    return phi.has_moving_points();
  }
} // namespace Debond
