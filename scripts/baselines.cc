// SPDX-License-Identifier: LGPL-2.1-or-later
// baselines DIRECTORY SOLVER...: solves A u = f, the body without any contact,
// from the files that Output/Matrices writes, by cholesky, ml or hypre, and
// prints for each a line of CSV. scripts/benchmarks builds and runs it.

#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <Eigen/Sparse>
#include <Teuchos_ParameterList.hpp>
#include <cholmod.h>
#include <ml_MultiLevelPreconditioner.h>
#include <petscksp.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{
  /// Of iterative solves, relative to |f|: that of contact solves.
  constexpr double tolerance  = 1e-10;
  constexpr int    most_steps = 1000;

  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, PetscInt>;
  using Vector = Eigen::VectorXd;



  std::ifstream
  open(const std::string &path, std::istringstream &sizes)
  {
    std::ifstream file(path);
    std::string   line;
    std::getline(file, line); // what it has
    std::getline(file, line);
    if (!file)
      throw std::runtime_error("Cannot read " + path);
    sizes.str(line);
    return file;
  }



  Matrix
  read_sparse(const std::string &path, const bool is_symmetric)
  {
    std::istringstream sizes;
    std::ifstream      file = open(path, sizes);
    PetscInt           m, n, i, j;
    std::size_t        n_entries;
    double             number;
    sizes >> m >> n >> n_entries;
    std::vector<Eigen::Triplet<double, PetscInt>> entries;
    entries.reserve(2 * n_entries);
    while (file >> i >> j >> number)
      {
        entries.emplace_back(i - 1, j - 1, number);
        if (is_symmetric && i != j)
          entries.emplace_back(j - 1, i - 1, number);
      }
    Matrix result(m, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }



  Eigen::MatrixXd
  read_dense(const std::string &path)
  {
    std::istringstream sizes;
    std::ifstream      file = open(path, sizes);
    Eigen::Index       m, n;
    sizes >> m >> n;
    Eigen::MatrixXd result(m, n);
    for (Eigen::Index k = 0; k < m * n; ++k)
      file >> result.data()[k];
    return result;
  }



  /// In Cartesian components, which is how hypre and ML know them: with the
  /// normal first at contact nodes they would take it for the component of the
  /// other nodes' first unknown.
  struct Problem
  {
    Matrix          A;
    Vector          f;
    Eigen::MatrixXd modes; ///< rigid motions, a column for each
    int             dim;
  };



  Problem
  read_problem(const std::string &directory)
  {
    const Matrix          F     = read_sparse(directory + "/frames.mtx", false);
    const Matrix          A     = read_sparse(directory + "/A.mtx", true);
    const Eigen::MatrixXd modes = read_dense(directory + "/modes.mtx");
    return {F.transpose() * A * F,
            F.transpose() * read_dense(directory + "/f.mtx"),
            F.transpose() * modes,
            modes.cols() == 3 ? 2 : 3};
  }



  /// Supernodal, by the AMD ordering: analysis, factorisation, solve.
  int
  solve_by_cholesky(const Problem &problem, Vector &u)
  {
    cholmod_common common;
    cholmod_start(&common);
    common.nmethods           = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.supernodal         = CHOLMOD_SUPERNODAL;
    // The rows of the lower triangle are the columns of the upper one.
    Matrix         lower = problem.A.triangularView<Eigen::Lower>();
    const auto     n     = static_cast<std::size_t>(lower.rows());
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = n;
    matrix.nzmax              = static_cast<std::size_t>(lower.nonZeros());
    matrix.p                  = lower.outerIndexPtr();
    matrix.i                  = lower.innerIndexPtr();
    matrix.x                  = lower.valuePtr();
    matrix.stype              = 1;
    matrix.itype              = CHOLMOD_INT;
    matrix.xtype              = CHOLMOD_REAL;
    matrix.sorted = matrix.packed = 1;
    cholmod_factor *factor        = cholmod_analyze(&matrix, &common);
    cholmod_factorize(&matrix, factor, &common);
    Vector        f = problem.f;
    cholmod_dense b{
      n, 1, n, n, f.data(), nullptr, CHOLMOD_REAL, CHOLMOD_DOUBLE};
    cholmod_dense *x = cholmod_solve(CHOLMOD_A, factor, &b, &common);
    if (common.status != CHOLMOD_OK || x == nullptr)
      throw std::runtime_error("CHOLMOD failed");
    u = Eigen::Map<const Vector>(static_cast<double *>(x->x),
                                 static_cast<Eigen::Index>(n));
    cholmod_free_dense(&x, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
    return 0;
  }



  /// Conjugate gradients with smoothed aggregation and the rigid body modes.
  int
  solve_by_ml(const Problem &problem, Vector &u)
  {
    constexpr unsigned int most_entries = 64; // about, of a row
    const auto             n = static_cast<unsigned int>(problem.A.rows());
    dealii::TrilinosWrappers::SparseMatrix matrix(n, n, most_entries);
    for (PetscInt i = 0; i < problem.A.outerSize(); ++i)
      for (Matrix::InnerIterator entry(problem.A, i); entry; ++entry)
        matrix.set(static_cast<unsigned int>(i),
                   static_cast<unsigned int>(entry.col()),
                   entry.value());
    matrix.compress(dealii::VectorOperation::insert);

    Eigen::MatrixXd        modes = problem.modes;
    Teuchos::ParameterList parameters;
    ML_Epetra::SetDefaults("SA", parameters);
    parameters.set("ML output", 0);
    parameters.set("PDE equations", problem.dim);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", static_cast<int>(modes.cols()));
    parameters.set("null space: vectors", modes.data());
    parameters.set("aggregation: type", "Uncoupled");
    parameters.set("smoother: type", "Chebyshev");
    parameters.set("smoother: sweeps", 2);
    parameters.set("coarse: type", "Amesos-KLU");
    parameters.set("coarse: max size", 2000);
    dealii::TrilinosWrappers::PreconditionAMG cycle;
    cycle.initialize(matrix, parameters);

    dealii::Vector<double> x(n), f(n);
    std::copy(problem.f.begin(), problem.f.end(), f.begin());
    dealii::SolverControl control(most_steps, tolerance * f.l2_norm());
    dealii::SolverCG<dealii::Vector<double>>(control).solve(matrix,
                                                            x,
                                                            f,
                                                            cycle);
    u = Eigen::Map<const Vector>(x.begin(), problem.f.size());
    return static_cast<int>(control.last_step());
  }



  /// The same with one V-cycle of BoomerAMG by PETSc: its defaults, each
  /// Cartesian component coarsened apart, connections strong above 0.25 (in 3D
  /// 0.5) of the largest, as hypre's manual has it.
  int
  solve_by_hypre(const Problem &problem, Vector &u)
  {
    Matrix             A      = problem.A;
    Vector             f      = problem.f;
    const PetscInt     n      = static_cast<PetscInt>(A.rows());
    Mat                matrix = nullptr;
    Vec                b = nullptr, x = nullptr;
    KSP                solver     = nullptr;
    PC                 cycle      = nullptr;
    KSPConvergedReason reason     = KSP_CONVERGED_ITERATING;
    PetscInt           iterations = 0;
    u                             = Vector::Zero(n);

    const auto solve = [&]() -> PetscErrorCode {
      PetscCall(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF,
                                          n,
                                          n,
                                          A.outerIndexPtr(),
                                          A.innerIndexPtr(),
                                          A.valuePtr(),
                                          &matrix));
      PetscCall(MatSetBlockSize(matrix, problem.dim));
      PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, f.data(), &b));
      PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, u.data(), &x));
      PetscCall(KSPCreate(PETSC_COMM_SELF, &solver));
      PetscCall(KSPSetOperators(solver, matrix, matrix));
      PetscCall(KSPSetType(solver, KSPCG));
      PetscCall(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
      PetscCall(KSPSetTolerances(
        solver, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, most_steps));
      PetscCall(KSPGetPC(solver, &cycle));
      PetscCall(PCSetType(cycle, PCHYPRE));
      PetscCall(PCHYPRESetType(cycle, "boomeramg"));
      PetscCall(PetscOptionsSetValue(nullptr,
                                     "-pc_hypre_boomeramg_strong_threshold",
                                     problem.dim == 2 ? "0.25" : "0.5"));
      PetscCall(PCSetFromOptions(cycle));
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
      throw std::runtime_error("hypre by PETSc failed");
    return static_cast<int>(iterations);
  }



  /// The median of as many solves as take a second, at most 20.
  void
  measure(const Problem &problem, const std::string &solver)
  {
    std::vector<double> seconds;
    Vector              u;
    int                 iterations = 0;
    double              sum        = 0.;
    while (seconds.empty() || (sum < 1. && seconds.size() < 20))
      {
        const dealii::Timer timer;
        iterations = solver == "cholesky" ? solve_by_cholesky(problem, u) :
                     solver == "ml"       ? solve_by_ml(problem, u) :
                                            solve_by_hypre(problem, u);
        seconds.push_back(timer.wall_time());
        sum += seconds.back();
      }
    std::sort(seconds.begin(), seconds.end());
    std::cout << solver << ',' << seconds[seconds.size() / 2] << ','
              << iterations << ',' << 0.5 * problem.f.dot(u) << ','
              << (problem.A * u - problem.f).norm() / problem.f.norm()
              << std::endl;
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Problem problem = read_problem(argc > 1 ? argv[1] : ".");
  std::cout.precision(12);
  std::cout << "solver,seconds,iterations,energy,residual" << std::endl;
  for (int k = 2; k < argc; ++k)
    measure(problem, argv[k]);
}
