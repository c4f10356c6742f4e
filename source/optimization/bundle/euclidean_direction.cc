// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/bundle/euclidean_direction.h>

#include <algorithm>

namespace Debond
{
  EuclideanDirection::EuclideanDirection(const double       proximal_weight,
                                         const UpperBounds &upper_bounds,
                                         const unsigned int bundle_size,
                                         const DofVector   &model)
    : u(proximal_weight)
    , bounds(upper_bounds)
    , qp(bundle_size, static_cast<unsigned int>(bounds.indices.size()))
    , subgradients(bundle_size, model)
  {}



  bool
  EuclideanDirection::is_feasible(const DofVector &x) const
  {
    for (unsigned int i = 0; i < bounds.indices.size(); ++i)
      if (!(x(bounds.indices[i]) <= bounds.upper[i]))
        return false;
    return true;
  }



  void
  EuclideanDirection::add(const DofVector &eta)
  {
    const unsigned int j   = size();
    DofVector         &cut = subgradients[j];
    cut                    = eta;

    Eigen::VectorXd bounded(bounds.indices.size());
    for (unsigned int i = 0; i < bounds.indices.size(); ++i)
      {
        bounded(i)             = cut(bounds.indices[i]);
        cut(bounds.indices[i]) = 0.;
      }
    Eigen::VectorXd products(j + 1);
    for (unsigned int k = 0; k <= j; ++k)
      products(k) = subgradients[k] * cut;
    qp.add_cut(products, bounded);
  }



  const EuclideanDirection::Solution &
  EuclideanDirection::solve(const DofVector &x, const Eigen::VectorXd &beta)
  {
    Eigen::VectorXd b(bounds.indices.size());
    for (unsigned int i = 0; i < bounds.indices.size(); ++i)
      b(i) = bounds.upper[i] - x(bounds.indices[i]);

    const BundleQP::Solution &qp_solution = qp.solve(beta, b, u);
    lambda                                = qp_solution.lambda;
    d_bounded                             = qp_solution.d;

    solution.v           = qp_solution.v;
    solution.duality_gap = qp_solution.duality_gap;
    solution.residual    = qp_solution.residual();
    solution.steps       = qp_solution.steps;
    solution.status      = to_string(qp_solution.status);
    solution.slopes      = qp_solution.slopes;
    return solution;
  }



  void
  EuclideanDirection::direction(DofVector &d) const
  {
    d = 0.;
    // Two at a time, to read and write d half as often.
    std::vector<unsigned int> active;
    for (unsigned int j = 0; j < size(); ++j)
      if (lambda(j) > 0.)
        active.push_back(j);
    const auto factor = [&](const unsigned int k) {
      return -lambda(active[k]) / u;
    };
    for (unsigned int k = 0; k + 1 < active.size(); k += 2)
      d.add(factor(k),
            subgradients[active[k]],
            factor(k + 1),
            subgradients[active[k + 1]]);
    if (active.size() % 2 == 1)
      d.add(factor(static_cast<unsigned int>(active.size()) - 1),
            subgradients[active.back()]);
    for (unsigned int i = 0; i < bounds.indices.size(); ++i)
      d(bounds.indices[i]) = d_bounded(i);
  }



  void
  EuclideanDirection::project(DofVector &x) const
  {
    for (unsigned int i = 0; i < bounds.indices.size(); ++i)
      x(bounds.indices[i]) =
        std::min<double>(x(bounds.indices[i]), bounds.upper[i]);
  }

} // namespace Debond
