// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_multigrid_problem_h
#define debond_elasticity_multigrid_problem_h

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <debond/elasticity/displacement_problem.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/multigrid.h>
#include <debond/linear_algebra/dof_vector.h>

namespace Debond
{
  /**
   * J on all unknowns, for bodies whose factorisation would take too much
   * memory or time and that have no coarser levels: majorants are minimised by
   * active sets, and each linear system is solved by conjugate gradients with a
   * multigrid V-cycle of A as preconditioner, both restricted to the unknowns
   * that are not in contact. Systems are solved to a tenth of the residual that
   * their active set started with, until that is all that the caller requires.
   */
  template <int dim>
  class MultigridProblem : public DisplacementProblem
  {
  public:
    /// Keeps references; @p u is the current point, of which the normal
    /// displacements have to be <= 0. As soon as @p may_go_on returns false,
    /// which each linear iteration asks, minimise() ends and leaves u as it was
    /// before.
    MultigridProblem(const ElasticProblem<dim>   &problem,
                     const PiecewiseQuadratic    &phi,
                     const Multigrid             &multigrid,
                     DofVector                   &u,
                     const std::function<bool()> &may_go_on = {});

    Minimisation
    minimise(const double tolerance) override;

  private:
    class Operator;
    class Preconditioner;

    void
    multiply(DofVector &dst, const DofVector &src) const override;

    const dealii::TrilinosWrappers::SparseMatrix &A;
    const Multigrid                              &multigrid;
  };
} // namespace Debond

#endif
