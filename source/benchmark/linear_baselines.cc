// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>

#include <debond/benchmark/linear_baselines.h>
#include <debond/elasticity/multigrid.h>

#include <cholmod.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace Debond
{
  namespace
  {
    /// The upper triangle by columns, which is the lower one by rows.
    cholmod_sparse *
    convert(const dealii::SparseMatrix<double> &A, cholmod_common &common)
    {
      const std::size_t n = A.m();
      cholmod_sparse   *result =
        cholmod_allocate_sparse(n,
                                n,
                                (A.n_nonzero_elements() + n) / 2,
                                /*sorted=*/1,
                                /*packed=*/1,
                                /*stype=*/1,
                                CHOLMOD_REAL,
                                &common);
      if (result == nullptr)
        throw std::bad_alloc();
      int        *starts = static_cast<int *>(result->p);
      int        *rows   = static_cast<int *>(result->i);
      double     *values = static_cast<double *>(result->x);
      std::size_t next   = 0;
      for (unsigned int i = 0; i < n; ++i)
        {
          starts[i] = static_cast<int>(next);
          // deal.II has the diagonal first.
          for (auto entry = ++A.begin(i); entry != A.end(i); ++entry)
            if (entry->column() < i)
              {
                rows[next]     = static_cast<int>(entry->column());
                values[next++] = entry->value();
              }
          rows[next]     = static_cast<int>(i);
          values[next++] = A.diag_element(i);
        }
      starts[n] = static_cast<int>(next);
      return result;
    }
  } // namespace



  LinearSolve
  solve_by_cholesky(const dealii::SparseMatrix<double> &A, const DofVector &f)
  {
    LinearSolve    result;
    cholmod_common common;
    cholmod_start(&common);
    common.nmethods           = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.supernodal         = CHOLMOD_SUPERNODAL;
    cholmod_sparse *matrix    = convert(A, common);
    cholmod_factor *factor    = cholmod_analyze(matrix, &common);
    cholmod_factorize(matrix, factor, &common);
    cholmod_dense *b =
      cholmod_allocate_dense(f.size(), 1, f.size(), CHOLMOD_REAL, &common);
    std::copy(f.begin(), f.end(), static_cast<double *>(b->x));
    cholmod_dense *x      = cholmod_solve(CHOLMOD_A, factor, b, &common);
    const bool     failed = common.status != CHOLMOD_OK || x == nullptr;
    if (!failed)
      {
        const double *values = static_cast<const double *>(x->x);
        result.u.reinit(f.size());
        std::copy(values, values + f.size(), result.u.begin());
      }

    cholmod_free_dense(&x, &common);
    cholmod_free_dense(&b, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_free_sparse(&matrix, &common);
    cholmod_finish(&common);
    if (failed)
      throw std::runtime_error("CHOLMOD failed, status " +
                               std::to_string(common.status));
    return result;
  }



  template <int dim>
  LinearSolve
  solve_by_multigrid(const ElasticProblem<dim> &problem)
  {
    LinearSolve     result;
    const Multigrid preconditioner(problem);
    result.u.reinit(problem.unknowns().n_dofs());
    dealii::SolverControl       control(1000, 1e-10 * problem.load().l2_norm());
    dealii::SolverCG<DofVector> cg(control);
    cg.solve(problem.trilinos_matrix(),
             result.u,
             problem.load(),
             preconditioner);
    result.iterations = control.last_step();
    return result;
  }



  template decltype(solve_by_multigrid<2>) solve_by_multigrid<2>;
  template decltype(solve_by_multigrid<3>) solve_by_multigrid<3>;
} // namespace Debond
