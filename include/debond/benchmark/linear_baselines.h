// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_linear_baselines_h
#define debond_benchmark_linear_baselines_h

#include <deal.II/lac/sparse_matrix.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/mesh/body.h>

namespace Debond
{
  /// One solve of A u = f, the elastic body without any contact.
  struct LinearSolve
  {
    DofVector u;

    /// Of an iterative method.
    unsigned int iterations = 0;
  };

  /// By one supernodal Cholesky factorisation (CHOLMOD) with the AMD ordering.
  LinearSolve
  solve_by_cholesky(const dealii::SparseMatrix<double> &A, const DofVector &f);

  /// By conjugate gradients down to 1e-10 of |f|, preconditioned by Multigrid
  /// (Trilinos ML). The problem's matrix has to be Trilinos'.
  template <int dim>
  LinearSolve
  solve_by_ml(const ElasticProblem<dim> &problem);

  /// The same with one V-cycle of hypre's BoomerAMG, by PETSc: PETSc's
  /// defaults, each Cartesian component of the displacement coarsened apart
  /// (the "unknown approach"), and connections strong above 0.25 (in 3D 0.5) of
  /// the largest, as hypre's manual has it. Throws std::runtime_error if PETSc
  /// fails or does not converge.
  template <int dim>
  LinearSolve
  solve_by_hypre(const ElasticProblem<dim> &problem);

  /// The same with the cycle of contact solves (TruncatedCycle) with nothing
  /// held, and their nested iteration: on each coarser level of the body, from
  /// the coarsest one on, down to 1e-4 of its |f_l|. The iterations are those
  /// on the finest level. Throws std::invalid_argument if the body has no
  /// coarser levels.
  template <int dim>
  LinearSolve
  solve_by_levels(const Body<dim> &body, const ElasticProblem<dim> &problem);
} // namespace Debond

#endif
