// SPDX-License-Identifier: LGPL-2.1-or-later
// Mutations of the shipped scenes: each is rejected with the entry or the line
// named, or read; what is small is also solved. An argument gives the number
// of cases. A case that crashes or hangs is printed before the test ends.

#include <deal.II/base/mpi.h>

#include <debond/input/parameters.h>
#include <debond/program/run.h>
#include <debond/solve/method_choice.h>
#include <debond/solve/scene_size.h>

#include <filesystem>
#include <iostream>
#include <regex>
#include <sstream>

#include "../check.h"
#include "mutator.h"

using namespace Debond;
using namespace Fuzz;

namespace
{
  constexpr double largest_scene_to_solve = 1500.; // unknowns



  const std::vector<std::string> hostile_values = {"",
                                                   "0",
                                                   "-0",
                                                   "1",
                                                   "-1",
                                                   "2",
                                                   "3",
                                                   "1e-300",
                                                   "1e300",
                                                   "1e308",
                                                   "-1e308",
                                                   "1e-12",
                                                   "1e12",
                                                   "nan",
                                                   "inf",
                                                   "-inf",
                                                   "1e",
                                                   "0x10",
                                                   "1,5",
                                                   "1, 1",
                                                   "2, 1",
                                                   "3, 2, 1",
                                                   "1, 1, 1",
                                                   "1e-9, 1e9",
                                                   "999999999999",
                                                   "4294967296",
                                                   "0.5",
                                                   "0.4999999",
                                                   "-0.999",
                                                   "left",
                                                   "right, right",
                                                   "bottom",
                                                   "bottom, top",
                                                   "left, right, bottom, top",
                                                   "front",
                                                   "free",
                                                   "fixed",
                                                   "none",
                                                   "winkler",
                                                   "exact",
                                                   "midpoint",
                                                   "gauss 1",
                                                   "gauss 99",
                                                   "gauss 100",
                                                   "gauss -1",
                                                   "plane strain",
                                                   "true",
                                                   "automatic",
                                                   "energy bundle",
                                                   "majorise minimise",
                                                   "multigrid",
                                                   "direct",
                                                   "0; 0",
                                                   "0; 1/x",
                                                   "0; 1/(x-0.2)",
                                                   "0; log(-1)",
                                                   "0; sqrt(x-0.2)",
                                                   "0; rint(1e9*x)",
                                                   "0; x",
                                                   "0; 0; 0",
                                                   "0; 1e300",
                                                   "0; sin(1e6*x)",
                                                   "0; if(x<0.2,1,",
                                                   "0; y z",
                                                   ";",
                                                   "0;",
                                                   "a=1",
                                                   "a=1, a=2",
                                                   "x=1",
                                                   "pi=3",
                                                   "a=nan",
                                                   "{scene}",
                                                   "/",
                                                   "\\",
                                                   "#",
                                                   "end",
                                                   "0; rand()",
                                                   "0; rand_seed(1)",
                                                   "0; x=1",
                                                   "0; 0.69*(x^-1)",
                                                   "..",
                                                   std::string(5000, '9'),
                                                   "0; " +
                                                     std::string(2000, '(')};



  std::vector<std::string>
  shipped_scenes(const std::filesystem::path &directory)
  {
    std::vector<std::string> scenes = read_files(directory, ".prm");
    const auto               hard   = read_files(directory / "hard", ".prm");
    scenes.insert(scenes.end(), hard.begin(), hard.end());
    return scenes;
  }



  struct Counts
  {
    unsigned int rejected = 0, read = 0, solved = 0, not_converged = 0;
    unsigned int multigrid = 0, unnamed = 0, failed = 0;
  };



  /// Whether an error says where the mistake is: the line, an entry, or the
  /// load and the point.
  bool
  is_named(const std::string &error)
  {
    static const std::regex named(
      "^fuzz\\.prm:[0-9]+: [^]*|[^]*(Dimension|[A-Z][A-Za-z ]*/[A-Z][a-z]+|"
      "traction|body force|Boundary conditions|clamped|contact boundary)[^]*");
    return std::regex_match(error, named);
  }



  void
  try_case(const std::string &directory, Counts &counts)
  {
    try
      {
        SceneTable         table;
        std::istringstream input(current_case);
        table.read(input, "fuzz.prm");
        Parameters         parameters = table.parameters("fuzz.prm");
        const MethodChoice choice     = choose_method(parameters);
        ++counts.read;
        if (scene_size(parameters).unknowns > largest_scene_to_solve)
          return;
        // Which is chosen for large scenes only.
        if (counts.read % 4 == 0 &&
            choice.linear_solver == LinearSolver::direct)
          {
            parameters.solver.method        = SolverMethod::majorise_minimise;
            parameters.solver.linear_solver = LinearSolver::multigrid;
            parameters.solver.prove         = false;
            ++counts.multigrid;
          }

        parameters.output.directory = directory;
        for (auto *method :
             {&parameters.solver.bundle, &parameters.solver.energy_bundle})
          method->maximum_iterations =
            std::min(method->maximum_iterations, 50U);
        std::ostringstream log;
        const ExitCode     code = parameters.dimension == 2 ?
                                    run<2>(parameters, log, false) :
                                    run<3>(parameters, log, false);
        ++counts.solved;
        counts.not_converged += code == ExitCode::not_converged;
        if (code != ExitCode::success && code != ExitCode::not_converged)
          {
            ++counts.failed;
            std::cout << "exit code " << static_cast<int>(code)
                      << " of the case\n"
                      << current_case;
          }
      }
    catch (const BadInput &error)
      {
        ++counts.rejected;
        for (const std::string &line : error.lines)
          if (!is_named(line))
            {
              ++counts.unnamed;
              std::cout << "no entry is named: " << line << '\n';
            }
      }
    catch (const std::exception &error)
      {
        ++counts.failed;
        std::cout << "exception " << error.what() << "\nin the case\n"
                  << current_case;
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  const unsigned int n_cases = argc > 1 ? std::stoul(argv[1]) : 500;
  // Multigrid needs MPI, which starts only once in a process.
  int                                            no_arguments = 0;
  char                                         **no_argument  = nullptr;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(no_arguments,
                                                     no_argument,
                                                     1);
  catch_signals();

  const std::vector<std::string> scenes =
    shipped_scenes(SOURCE_DIR "/../../prm");
  const std::string directory = (std::filesystem::temp_directory_path() /
                                 ("debond-fuzz-" + std::to_string(getpid())))
                                  .string();

  std::ostringstream    messages;
  std::streambuf *const errors = std::cerr.rdbuf(messages.rdbuf());
  Mutator               mutator(hostile_values);
  Counts                counts;
  for (unsigned int k = 0; k < n_cases; ++k)
    {
      current_case = mutator(scenes[mutator.below(scenes.size())]);
      alarm(seconds_for_a_case);
      try_case(directory, counts);
      alarm(0);
      messages.str("");
    }
  std::cerr.rdbuf(errors);
  std::filesystem::remove_all(directory);

  std::cout << "failures: " << counts.failed
            << "\nrejections that name nothing: " << counts.unnamed
            << "\nsome of each: "
            << verdict(counts.rejected > 0 && counts.solved > 0) << '\n';
  if (argc > 1)
    std::cout << n_cases << " cases: " << counts.rejected << " rejected, "
              << counts.read << " read, " << counts.solved << " solved ("
              << counts.multigrid << " by multigrid), " << counts.not_converged
              << " not converged\n";
  return counts.failed + counts.unnamed > 0 ? 1 : 0;
}
