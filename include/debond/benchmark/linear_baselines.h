// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_benchmark_linear_baselines_h
#define debond_benchmark_linear_baselines_h

#include <deal.II/lac/sparse_matrix.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>

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

  /// By conjugate gradients down to 1e-10 of the first residual, preconditioned
  /// by Multigrid. The problem's matrix has to be Trilinos'.
  template <int dim>
  LinearSolve
  solve_by_multigrid(const ElasticProblem<dim> &problem);
} // namespace Debond

#endif
