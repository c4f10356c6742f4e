// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_bundle_euclidean_direction_h
#define debond_optimization_bundle_euclidean_direction_h

#include <debond/optimization/bundle/bundle_qp.h>
#include <debond/optimization/bundle/direction_problem.h>
#include <debond/optimization/objective.h>

#include <vector>

namespace Debond
{
  /// The paper's direction problem, M = u I (u > 0, energy per squared length),
  /// on any deal.II vector. Only the components with bounds are handed to the
  /// QP; of all others it knows the Gram matrix. Keeps a reference to the
  /// bounds.
  class EuclideanDirection : public DirectionProblem
  {
  public:
    /// @p model: a vector with the layout of x. @p bundle_size: the most
    /// subgradients that will be added.
    EuclideanDirection(const double       u,
                       const UpperBounds &bounds,
                       const unsigned int bundle_size,
                       const DofVector   &model);

    bool
    is_feasible(const DofVector &x) const override;

    unsigned int
    size() const override
    {
      return qp.n_cuts();
    }

    void
    clear() override
    {
      qp.clear();
    }

    void
    add(const DofVector &eta) override;

    const Solution &
    solve(const DofVector &x, const Eigen::VectorXd &beta) override;

    void
    direction(DofVector &d) const override;

    double
    length(const DofVector &d) const override
    {
      return d.l2_norm();
    }

    void
    project(DofVector &x) const override;

  private:
    const double       u;
    const UpperBounds &bounds;
    BundleQP           qp;

    /// With zeros in the bounded components, which the QP holds: so the part of
    /// the Gram matrix that remains when bounds are active is not a difference.
    std::vector<DofVector> subgradients;

    Eigen::VectorXd lambda; ///< of the last solve()
    Eigen::VectorXd d_bounded;
    Solution        solution;
  };
} // namespace Debond

#endif
