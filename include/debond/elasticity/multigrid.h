// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_multigrid_h
#define debond_elasticity_multigrid_h

#include <deal.II/lac/trilinos_precondition.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>

namespace Debond
{
  /**
   * One V-cycle of smoothed aggregation (Trilinos ML) for A, with the rigid
   * body modes as near null space and Chebyshev smoothers of degree 2, which
   * keep it symmetric: a preconditioner for conjugate gradients.
   *
   * See Vanek, Mandel, Brezina, Computing 56 (1996).
   */
  class Multigrid
  {
  public:
    /// Keeps a reference to the matrix of the problem, whose storage must be
    /// Trilinos'. The cycle is meant for systems in which the degrees of
    /// freedom @p held are zero too: there the coarse spaces vanish.
    template <int dim>
    explicit Multigrid(
      const ElasticProblem<dim>                          &problem,
      const std::vector<dealii::types::global_dof_index> &held = {});

    void
    vmult(DofVector &dst, const DofVector &src) const;

  private:
    dealii::TrilinosWrappers::PreconditionAMG cycle;
  };
} // namespace Debond

#endif
