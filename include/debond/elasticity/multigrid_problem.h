// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_multigrid_problem_h
#define debond_elasticity_multigrid_problem_h

#include <debond/elasticity/displacement_problem.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>

namespace Debond
{
  /// J on all unknowns of bodies that have no coarser levels.
  template <int dim>
  class MultigridProblem : public DisplacementProblem
  {
  public:
    /// Keeps references; @p u is the current point, of which the normal
    /// displacements have to be <= 0.
    MultigridProblem(const ElasticProblem<dim>   &problem,
                     const PiecewiseQuadratic    &phi,
                     MultigridCorrection         &cycle,
                     DofVector                   &u,
                     const std::function<bool()> &may_go_on = {});

  private:
    void
    multiply(DofVector &dst, const DofVector &src) const override;

    void
    add_contact_columns(const Eigen::VectorXd &factors,
                        DofVector             &v) const override;

    const dealii::SparseMatrix<double> &A;
  };
} // namespace Debond

#endif
