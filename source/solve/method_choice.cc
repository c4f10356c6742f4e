// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/bad_input.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/scene_size.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// Below, the choice hardly matters, and with a factorisation the search is
    /// on all contact nodes.
    constexpr double seconds_that_matter = 3.;

    /// The estimates are not better than that.
    constexpr double factor_that_matters = 2.;



    std::string
    in_gib(const double bytes)
    {
      const double       gib = bytes / (1 << 30);
      std::ostringstream text;
      text << std::fixed << std::setprecision(gib < 10. ? 1 : 0) << gib
           << " GiB";
      return text.str();
    }



    std::string
    rounded(const double number)
    {
      std::ostringstream text;
      text << std::setprecision(2) << number;
      return text.str();
    }



    double
    memory_limit(const SolverParameters &parameters)
    {
      return parameters.memory_limit > 0. ? parameters.memory_limit :
                                            available_memory();
    }



    /// A path needs S for its many loads.
    void
    check_load_path(const ProblemParameters &problem,
                    const bool               proves,
                    const MethodChoice      &choice)
    {
      const auto refuse = [&problem](const std::string &entry,
                                     const std::string &reason) {
        throw BadInput({problem.scene + ": Load path/" + entry + " " + reason});
      };
      if (choice.method != SolverMethod::majorise_minimise)
        refuse("Factors",
               "needs Solver/Method = majorise minimise or automatic, not " +
                 choice.method);
      if (choice.linear_solver != LinearSolver::direct)
        refuse("Factors",
               "needs Solver/Linear solver = direct, not " +
                 choice.linear_solver);
      if (proves)
        refuse("Factors",
               "follows minima that need not be global: in place of "
               "Solver/Prove = true use Load path/Global branch = prove");
      if (problem.load_path.global_branch == GlobalBranch::prove &&
          !problem.load_path.has_global_branch())
        refuse("Global branch",
               "= prove needs bonds that heal and the same factors for "
               "prescribed displacements");
      if (problem.load_path.global_branch == GlobalBranch::prove &&
          problem.quadrature.rule != ContactQuadratureParameters::Rule::nodal)
        refuse("Global branch",
               "= prove needs Contact law/Quadrature = nodal, which gives "
               "each node a bond of its own");
    }
  } // namespace



  double
  memory_left(const double limit)
  {
    if (limit == 0.)
      return available_memory();
    dealii::Utilities::System::MemoryStats memory;
    dealii::Utilities::System::get_memory_stats(memory);
    return std::max(0., limit - 1024. * static_cast<double>(memory.VmRSS));
  }



  MethodChoice
  choose_method(const ProblemParameters  &problem,
                const SolverParameters   &solver,
                const AccuracyParameters &accuracy)
  {
    const SceneSize    size = scene_size(problem);
    const unsigned int dim  = problem.dimension;
    // What fits in a TB is numbered in 31 bits.
    const double limit         = std::min(1e12, memory_limit(solver));
    const double direct_memory = memory_with_factorisation(size, dim);

    MethodChoice choice = {solver.method, solver.linear_solver, "", 0., false};
    if (choice.method == SolverMethod::euclidean_bundle)
      {
        choice.linear_solver = LinearSolver::none;
        choice.memory =
          memory_with_bundle(size, dim, solver.bundle.bundle_size);
      }
    else
      {
        if (choice.method == SolverMethod::automatic)
          {
            choice.method = SolverMethod::majorise_minimise;
            choice.reason =
              "it is exact after finitely many steps, at the price of about "
              "one linear solve";
          }
        if (choice.method == SolverMethod::energy_bundle)
          {
            if (choice.linear_solver == LinearSolver::multigrid)
              throw BadInput(
                {problem.scene +
                 ": Solver/Method = energy bundle needs the Schur complement "
                 "of a factorisation; Solver/Linear solver must be direct or "
                 "automatic"});
            choice.linear_solver = LinearSolver::direct;
          }
        else if (choice.linear_solver == LinearSolver::automatic &&
                 (accuracy.is_adaptive() || problem.degree == 2))
          choice.linear_solver = LinearSolver::direct;
        else if (choice.linear_solver == LinearSolver::automatic)
          {
            choice.linear_solver        = LinearSolver::direct;
            const double direct_seconds = seconds_with_factorisation(problem);
            const double multigrid_seconds = seconds_with_multigrid(problem);
            std::string  reason;
            if (direct_memory > limit)
              reason = "a factorisation would take about " +
                       in_gib(direct_memory) + ", there are " + in_gib(limit);
            else if (direct_seconds > seconds_that_matter &&
                     direct_seconds > factor_that_matters * multigrid_seconds)
              reason = "it takes less time";
            if (!reason.empty())
              {
                choice.linear_solver = LinearSolver::multigrid;
                choice.reason += (choice.reason.empty() ? "" : "; ") +
                                 ("by multigrid, since " + reason);
              }
            if (std::max(direct_seconds, multigrid_seconds) >
                seconds_that_matter)
              choice.reason +=
                (choice.reason.empty() ? "" : "; ") +
                ("estimated are " + rounded(direct_seconds) +
                 " s with a factorisation, " + rounded(multigrid_seconds) +
                 " s with multigrid");
          }
        choice.has_levels = choice.linear_solver == LinearSolver::multigrid &&
                            problem.body->has_coarse_levels();
        choice.memory = choice.linear_solver == LinearSolver::direct ?
                          direct_memory :
                          memory_with_multigrid(size, dim, choice.has_levels);
      }

    if (!problem.load_path.factors.empty())
      check_load_path(problem, solver.prove, choice);
    const bool searches = solver.search == BondSearchChoice::full;
    if ((searches || solver.prove) &&
        choice.linear_solver != LinearSolver::direct)
      throw BadInput(
        {problem.scene + ": Solver/" + (searches ? "Search" : "Prove") +
         " needs a method with a direct linear solver, not " + choice.method +
         " with the linear solver " + choice.linear_solver});
    if (solver.prove &&
        problem.quadrature.rule != ContactQuadratureParameters::Rule::nodal)
      throw BadInput({problem.scene +
                      ": Solver/Prove needs Contact law/Quadrature = nodal, "
                      "which gives each node a bond of its own"});

    if (choice.memory > limit)
      throw BadInput({problem.scene + ": about " + rounded(size.unknowns) +
                      " unknowns need about " + in_gib(choice.memory) +
                      " of memory with " + choice.method +
                      (choice.linear_solver == LinearSolver::none ?
                         "" :
                         " and the linear solver " + choice.linear_solver) +
                      ", the limit is " + in_gib(limit) +
                      "; try fewer Mesh/Cells" +
                      (choice.linear_solver == LinearSolver::direct ?
                         ", Solver/Linear solver = multigrid," :
                         "") +
                      " or a higher Solver/Memory limit"});
    return choice;
  }
} // namespace Debond
