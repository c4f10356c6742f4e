// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>

#include <debond/benchmark/linear_baselines.h>
#include <debond/elasticity/elastic_levels.h>
#include <debond/elasticity/multigrid.h>

#include <Eigen/Sparse>
#include <cholmod.h>
#include <petscksp.h>

#include <algorithm>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace Debond
{
  namespace
  {
    /// Of iterative solves, relative to |f|: that of contact solves.
    constexpr double       linear_tolerance  = 1e-10;
    constexpr unsigned int most_linear_steps = 1000;

    /// A level needs to be solved to what the next finer one makes of it.
    constexpr double coarse_tolerance = 1e-4;



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



    using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt>;



    /// With the columns of each row in their order, as PETSc wants them.
    Rows
    rows(const dealii::SparseMatrix<double> &A)
    {
      std::vector<Eigen::Triplet<double, PetscInt>> entries;
      entries.reserve(A.n_nonzero_elements());
      for (const auto &entry : A)
        entries.emplace_back(static_cast<PetscInt>(entry.row()),
                             static_cast<PetscInt>(entry.column()),
                             entry.value());
      Rows result(A.m(), A.n());
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    }



    /// F in u = F x, x: the Cartesian components of the displacement.
    template <int dim>
    Rows
    to_frames(const ElasticUnknowns<dim> &unknowns)
    {
      Rows F(unknowns.n_dofs(), unknowns.n_dofs());
      F.setIdentity();
      std::vector<Eigen::Triplet<double, PetscInt>> entries;
      for (const DisplacementFrame<dim> &frame : unknowns.frames())
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            entries.emplace_back(static_cast<PetscInt>(frame.dofs[i]),
                                 static_cast<PetscInt>(frame.dofs[j]),
                                 frame.to_frame[i][j] - (i == j ? 1. : 0.));
      Rows change(F.rows(), F.cols());
      change.setFromTriplets(entries.begin(), entries.end());
      return F + change;
    }



    /// A product with a matrix, for deal.II's solvers.
    struct ProductWith
    {
      std::function<void(DofVector &, const DofVector &)> product;

      void
      vmult(DofVector &dst, const DofVector &src) const
      {
        product(dst, src);
      }
    };
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
  solve_by_ml(const ElasticProblem<dim> &problem)
  {
    LinearSolve     result;
    const Multigrid preconditioner(problem);
    result.u.reinit(problem.unknowns().n_dofs());
    dealii::SolverControl       control(most_linear_steps,
                                  linear_tolerance * problem.load().l2_norm());
    dealii::SolverCG<DofVector> cg(control);
    cg.solve(problem.trilinos_matrix(),
             result.u,
             problem.load(),
             preconditioner);
    result.iterations = control.last_step();
    return result;
  }



  template <int dim>
  LinearSolve
  solve_by_hypre(const ElasticProblem<dim> &problem)
  {
    // A of Cartesian components, F'A F and F'f, where u = F x: with the normal
    // first at contact nodes hypre would take it for the component of the
    // other nodes' first unknown.
    const Rows F = to_frames(problem.unknowns());
    const Rows A = F.transpose() * rows(problem.matrix()) * F;
    const Eigen::Map<const Eigen::VectorXd> f(problem.load().begin(),
                                              problem.load().size());
    const PetscInt                          n = static_cast<PetscInt>(A.rows());
    Eigen::VectorXd                         load = F.transpose() * f;
    Eigen::VectorXd x_cartesian = Eigen::VectorXd::Zero(A.rows());

    Mat                matrix = nullptr;
    Vec                b = nullptr, x = nullptr;
    KSP                solver         = nullptr;
    PC                 preconditioner = nullptr;
    KSPConvergedReason reason         = KSP_CONVERGED_ITERATING;
    PetscInt           iterations     = 0;

    const auto solve = [&]() -> PetscErrorCode {
      // PETSc only reads them, through pointers that are not const.
      PetscCall(
        MatCreateSeqAIJWithArrays(PETSC_COMM_SELF,
                                  n,
                                  n,
                                  const_cast<PetscInt *>(A.outerIndexPtr()),
                                  const_cast<PetscInt *>(A.innerIndexPtr()),
                                  const_cast<double *>(A.valuePtr()),
                                  &matrix));
      PetscCall(MatSetBlockSize(matrix, dim));
      PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, load.data(), &b));
      PetscCall(
        VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x_cartesian.data(), &x));
      PetscCall(KSPCreate(PETSC_COMM_SELF, &solver));
      PetscCall(KSPSetOperators(solver, matrix, matrix));
      PetscCall(KSPSetType(solver, KSPCG));
      PetscCall(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
      PetscCall(KSPSetTolerances(solver,
                                 linear_tolerance,
                                 PETSC_DEFAULT,
                                 PETSC_DEFAULT,
                                 most_linear_steps));
      PetscCall(KSPGetPC(solver, &preconditioner));
      PetscCall(PCSetType(preconditioner, PCHYPRE));
      PetscCall(PCHYPRESetType(preconditioner, "boomeramg"));
      PetscCall(PetscOptionsSetValue(nullptr,
                                     "-pc_hypre_boomeramg_strong_threshold",
                                     dim == 2 ? "0.25" : "0.5"));
      PetscCall(PCSetFromOptions(preconditioner));
      PetscCall(KSPSolve(solver, b, x));
      PetscCall(KSPGetConvergedReason(solver, &reason));
      PetscCall(KSPGetIterationNumber(solver, &iterations));
      return 0;
    };
    const PetscErrorCode error = solve();
    KSPDestroy(&solver);
    VecDestroy(&x);
    VecDestroy(&b);
    MatDestroy(&matrix);
    if (error != 0 || reason <= 0)
      throw std::runtime_error(
        "hypre by PETSc failed: error " + std::to_string(error) +
        ", reason of convergence " + std::to_string(reason) + " after " +
        std::to_string(iterations) + " steps");
    const Eigen::VectorXd u = F * x_cartesian;
    LinearSolve           result;
    result.u.reinit(static_cast<unsigned int>(n));
    std::copy(u.begin(), u.end(), result.u.begin());
    result.iterations = static_cast<unsigned int>(iterations);
    return result;
  }



  template <int dim>
  LinearSolve
  solve_by_levels(const Body<dim> &body, const ElasticProblem<dim> &problem)
  {
    const auto levels = ElasticLevels<dim>::make(body, problem);
    if (levels == nullptr)
      throw std::invalid_argument("the body has no coarser levels");

    LinearSolve  result;
    unsigned int l = levels->n_levels() - 1;
    result.u.reinit(levels->n_unknowns(l));
    for (;; --l)
      {
        levels->cycle().truncate(l, {}, {}, Eigen::SparseMatrix<double>());
        const double tolerance = l > 0 ? coarse_tolerance : linear_tolerance;
        dealii::SolverControl control(most_linear_steps,
                                      tolerance * levels->load(l).l2_norm());
        const auto product = [&](DofVector &dst, const DofVector &src) {
          levels->vmult(l, dst, src);
        };
        dealii::SolverCG<DofVector>(control).solve(ProductWith{product},
                                                   result.u,
                                                   levels->load(l),
                                                   levels->cycle());
        if (l == 0)
          {
            result.iterations = control.last_step();
            return result;
          }
        result.u = levels->prolongate(l, result.u);
      }
  }



  template decltype(solve_by_ml<2>)     solve_by_ml<2>;
  template decltype(solve_by_ml<3>)     solve_by_ml<3>;
  template decltype(solve_by_hypre<2>)  solve_by_hypre<2>;
  template decltype(solve_by_hypre<3>)  solve_by_hypre<3>;
  template decltype(solve_by_levels<2>) solve_by_levels<2>;
  template decltype(solve_by_levels<3>) solve_by_levels<3>;
} // namespace Debond
