// SPDX-License-Identifier: LGPL-2.1-or-later
// A search whose work is limited, and search and proof of a law of another
// shape.

#include <debond/base/processes.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/input/bad_input.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/minimum/which_minimum.h>
#include <debond/solve/path/global_branch.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <vector>

#include "../check.h"
#include "../solved.h"

using namespace Debond;

namespace
{
  /// Search and proof take a law that is no spring at first.
  void
  test_other_law()
  {
    const AdhesiveLaw law(
      {{0., -0.1, -1e-3, "sliding"}, {0., 0., no_end, "off"}});
    std::vector<double> values;
    bool                is_proved = false;
    for (const std::string entry :
         {"Solver/Search=full", "Solver/Prove=true", "Solver/Search=automatic"})
      {
        const Parameters parameters = parameters_of(
          {"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)", entry});
        const Scene<2>     scene(parameters);
        const Condensation condensed =
          condense_to_contact(scene.problem(), scene.adhesion());
        const ContactQuadrature<2> quadrature(parameters.quadrature, 1);
        const AdhesionIntegral<2>  adhesion(scene.contact_boundary(),
                                           law,
                                           quadrature);
        Eigen::VectorXd    s = Eigen::VectorXd::Zero(condensed.load().size());
        const WhichMinimum result = find_better_minimum(
          parameters.solver, adhesion, condensed, Interruption::by_signal(), s);
        is_proved = is_proved || result.kind == MinimumKind::global;
        values.push_back(
          condensed_functional(condensed_problem(condensed, adhesion), s));
      }
    if (is_first_rank())
      std::cout << "a law that is rigid at first is proved: "
                << (is_proved ? "yes" : "NO") << ", all find the same: "
                << (*std::max_element(values.begin(), values.end()) <=
                        (1. - 1e-9) *
                          *std::min_element(values.begin(), values.end()) ?
                      "yes" :
                      "NO")
                << '\n';
  }



  /// At its limit of work a search says that it has ended, and claims nothing.
  /// Work is counted, so that each run and each rank does the same.
  void
  test_limit_of_work()
  {
    const Parameters parameters =
      parameters_of({"Contact law/Bond stiffness=690",
                     "Contact law/Quadrature=gauss 2",
                     "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)"});
    const Scene<2>     scene(parameters);
    const Condensation condensed =
      condense_to_contact(scene.problem(), scene.adhesion());
    std::vector<unsigned int> trials;
    for (const double limit :
         {0., 1e6, 1e6, std::numeric_limits<double>::infinity()})
      {
        SolverParameters solver  = parameters.solver;
        solver.search_operations = limit;
        // The intact state, which is a minimum far above the least one.
        Eigen::VectorXd  s = Eigen::VectorXd::Zero(condensed.load().size());
        CondensedProblem problem(condensed_problem(condensed, scene.adhesion()),
                                 s);
        MajoriseMinimise(solver.majorise_minimise).minimize(problem);
        const Eigen::VectorXd start  = s;
        const WhichMinimum    result = find_better_minimum(
          solver, scene.adhesion(), condensed, Interruption::by_signal(), s);
        if (is_first_rank())
          std::cout << "limit of " << limit
                    << " operations: " << to_string(result.kind) << ", "
                    << result.notes.size() << " notes"
                    << (s == start ? ", nothing lower" : "") << '\n';
        trials.push_back(result.search_trials);
      }
    if (is_first_rank())
      std::cout << "the same limit twice: "
                << verdict(trials[1] == trials[2] && trials[1] > trials[0] &&
                           trials[3] > trials[2])
                << '\n';
  }
} // namespace



int
main()
{
  if (n_started_ranks() > 1)
    start_mpi();
  test_other_law();
  test_limit_of_work();
  end_mpi();
}
