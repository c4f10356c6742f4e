// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/number_text.h>
#include <debond/input/solver_parameters.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

namespace Debond
{
  namespace
  {
    const std::string bundle_section   = "Solver/Euclidean bundle/";
    const std::string energy_section   = "Solver/Energy bundle/";
    const std::string majorise_section = "Solver/Majorise minimise/";
    const std::string proof_section    = "Solver/Proof/";

    const std::vector<std::string> search_names = {"automatic",
                                                   "none",
                                                   "quick",
                                                   "full"};



    void
    declare_bundle(ParameterTable &table)
    {
      const ProximalBundleParameters defaults;
      const auto                     declare = [&](const std::string &name,
                               const std::string &value,
                               const Pattern     &pattern,
                               const std::string &documentation,
                               const std::string &units) {
        table.declare(
          bundle_section + name, value, pattern, documentation, units);
      };

      declare("Proximal weight",
              shortest_text(defaults.u),
              positive_number(),
              "u_k, the weight of the proximal term u_k/2 |d|^2",
              "energy per squared length");
      declare(
        "Distance weight",
        shortest_text(defaults.gamma),
        number(">= 0", [](double x) { return x >= 0; }),
        "gamma, the weight of the distance in the subgradient locality measure",
        "energy per squared length");
      declare("Long step threshold",
              shortest_text(defaults.t_bar),
              number("in (0, 1]", [](double x) { return x > 0 && x <= 1; }),
              "t_bar, the step length below which a step is a short one",
              "none");
      declare(
        "Descent fraction",
        shortest_text(defaults.m_L),
        number("in (0, 0.5)", [](double x) { return x > 0 && x < 0.5; }),
        "m_L, the part of the predicted descent that a step has to reach, eq. (14)",
        "none");
      declare(
        "Slope fraction",
        shortest_text(defaults.m_R),
        number("in (0, 1)", [](double x) { return x > 0 && x < 1; }),
        "m_R, the part of the predicted slope that a new subgradient has to exceed, eq. (15); above the descent fraction m_L",
        "none");
      declare(
        "Line search",
        "minimum",
        one_of({"largest", "halving", "minimum"}),
        "Which step with (14) is taken: 'largest' in [0, 1] by bisection, as in the paper's text; 'halving', the first of 1, 1/2, 1/4, ...; 'minimum', on along these while the functional falls, then the minimum of a parabola",
        "none");
      declare(
        "Stop tolerance",
        shortest_text(defaults.epsilon_s),
        positive_number(),
        "epsilon_s: the method stops when the predicted descent is not above it, v_k >= -epsilon_s",
        "energy");
      declare("Bundle size",
              std::to_string(defaults.bundle_size),
              whole_number(2, 100000),
              "Subgradients that are kept before the bundle is emptied",
              "none");
      declare(
        "Maximum iterations",
        std::to_string(defaults.maximum_iterations),
        whole_number(1, 1000000000),
        "Iterations after which the method gives up; the program then returns 3",
        "none");
      declare(
        "Start",
        "zero",
        Pattern("zero or a path",
                [](const std::string &value) { return !value.empty(); }),
        "The first iterate: zero is the undeformed body; otherwise the path of the displacement.txt of a scene with the same mesh and boundary conditions",
        "none");
    }



    void
    declare_condensed_methods(ParameterTable &table)
    {
      const Parameters defaults;
      table.declare(
        energy_section + "Stop tolerance",
        shortest_text(defaults.energy_bundle.epsilon_s),
        positive_number(),
        "epsilon_s relative to the energy 1/2 <A u, u> that the body has without contact",
        "none");
      table.declare(
        energy_section + "Distance weight",
        shortest_text(defaults.energy_bundle.gamma),
        number(">= 0", [](double x) { return x >= 0; }),
        "gamma, the weight of the distance, measured in the energy norm, in the subgradient locality measure",
        "none");
      table.declare(energy_section + "Bundle size",
                    std::to_string(defaults.energy_bundle.bundle_size),
                    whole_number(2, 1000),
                    "Subgradients that are kept before the bundle is emptied",
                    "none");
      table.declare(
        energy_section + "Maximum iterations",
        std::to_string(defaults.energy_bundle.maximum_iterations),
        whole_number(1, 1000000),
        "Iterations after which the method gives up; the program then returns 3",
        "none");

      table.declare(
        majorise_section + "Stop tolerance",
        shortest_text(defaults.majorise_minimise.tolerance),
        positive_number(),
        "The optimality conditions hold to this part of the largest force on a contact node",
        "none");
      table.declare(
        majorise_section + "Maximum iterations",
        std::to_string(defaults.majorise_minimise.maximum_iterations),
        whole_number(1, 1000000),
        "Iterations after which the method gives up; the program then returns 3",
        "none");
    }



    /// The moves of a full search by name.
    BranchSearchParameters
    search_with(const std::vector<std::string> &moves)
    {
      const auto has = [&moves](const std::string &move) {
        return std::find(moves.begin(), moves.end(), move) != moves.end();
      };
      BranchSearchParameters search;
      search.starts = has("starts");
      search.flips  = has("flips");
      search.splits = has("splits");
      if (!has("shifts"))
        search.maximum_shift = 0;
      return search;
    }



    void
    declare_which_minimum(ParameterTable &table)
    {
      const Parameters defaults;
      table.declare(
        "Solver/Search",
        search_names[0],
        one_of(search_names),
        "Whether a lower minimum than the one found is searched for by changing which bonds are broken, with a direct linear solver: quick starts from rest and from all bonds broken and moves the edges of the broken patches by a node, full moves them by up to four nodes and breaks, closes and splits patches; automatic is none unless the method is automatic, and then as much of this as it takes until a lower bound of J (with nodal quadrature) or the minimum on coarser contact nodes says that it is enough, with more than 200 contact nodes on coarser ones but for the starts from rest and from all bonds broken",
        "none");
      table.declare(
        "Solver/Search moves",
        "starts, shifts, flips, splits",
        list_of({"starts", "shifts", "flips", "splits"}),
        "The moves of Search = full: starts from rest and from all bonds broken; shifts of the edges of broken patches; flips, which break or close a patch; splits of patches",
        "none");
      table.declare(
        "Solver/Prove",
        "false",
        one_of({"true", "false"}),
        "Whether the result is proved to be the global minimum, or replaced by it, by branch and bound on the broken bonds. Needs a direct linear solver and nodal quadrature",
        "none");
      table.declare(
        proof_section + "Tolerance",
        shortest_text(defaults.proof.tolerance),
        number("> 0 and <= 1e-2", [](double x) { return x > 0 && x <= 1e-2; }),
        "The gap between J and its lower bound that counts as a proof, relative to what the bonds can change in J: the energy of all bonds when they break, or what the contact nodes would gain without foundation and bonds if that is less",
        "none");
      table.declare(
        proof_section + "Maximum nodes",
        std::to_string(defaults.proof.maximum_nodes),
        whole_number(1, 1000000000),
        "Nodes of the branch and bound tree after which the proof ends with the gap that is left",
        "none");
      table.declare(
        proof_section + "Maximum time",
        shortest_text(defaults.proof.maximum_seconds),
        positive_number(),
        "Wall time after which the proof ends with the gap that is left",
        "seconds");
      table.declare(
        proof_section + "Threads",
        "available",
        Pattern("available, or a whole number from 1 to 64",
                [whole = whole_number(1, 64)](const std::string &text) {
                  return text == "available" || whole.match(text);
                }),
        "Nodes that are bounded at the same time, at most 8; available is one for each core. The result does not depend on it, but for limits of time",
        "none");
    }
  } // namespace



  void
  declare_solver(ParameterTable &table)
  {
    const Parameters defaults;
    table.declare(
      "Solver/Method",
      "automatic",
      one_of({"automatic",
              "euclidean bundle",
              "energy bundle",
              "majorise minimise"}),
      "The minimiser: euclidean bundle is the paper's proximal bundle method; energy bundle is the same method on the normal displacements of the contact nodes alone, in the energy norm; majorise minimise fixes the branch of the law at each quadrature point in turn and is exact after finitely many steps; automatic chooses and says why",
      "none");
    table.declare(
      "Solver/Linear solver",
      "automatic",
      one_of({"automatic", "direct", "multigrid"}),
      "How the linear systems of energy bundle and majorise minimise are solved: direct factorises A once and goes on with the contact normals alone, multigrid (majorise minimise only) iterates on all unknowns, starting from the solutions on coarser meshes, and takes less memory in large scenes; automatic chooses by size and memory. euclidean bundle needs none",
      "none");
    table.declare(
      "Solver/Memory limit",
      "available",
      Pattern("available, or a number > 0",
              [](const std::string &text) {
                double limit;
                return text == "available" ||
                       (read_number(text, limit) && limit > 0.);
              }),
      "The memory that a scene may take by the program's estimate; available is what the system can give at the start",
      "GiB");
    table.declare(
      "Solver/Checkpoint interval",
      shortest_text(defaults.checkpoint_interval),
      number(">= 0", [](double x) { return x >= 0; }),
      "Wall time after which the bundle methods write their state again, into the file checkpoint in the output directory, and when they end without success; 'debond SCENE.prm --restart' goes on from it with the same iterates. 0 writes none",
      "seconds");
    declare_bundle(table);
    declare_condensed_methods(table);
    declare_which_minimum(table);
  }



  void
  read_solver(ParameterTable &table, Parameters &p)
  {
    p.method        = table.get("Solver/Method");
    p.linear_solver = table.get("Solver/Linear solver");
    if (table.get("Solver/Memory limit") != "available")
      p.memory_limit = table.get_double("Solver/Memory limit") * (1 << 30);
    p.checkpoint_interval = table.get_double("Solver/Checkpoint interval");
    p.bundle.u     = table.get_double(bundle_section + "Proximal weight");
    p.bundle.gamma = table.get_double(bundle_section + "Distance weight");
    p.bundle.t_bar = table.get_double(bundle_section + "Long step threshold");
    p.bundle.m_L   = table.get_double(bundle_section + "Descent fraction");
    p.bundle.m_R   = table.get_double(bundle_section + "Slope fraction");
    p.energy_bundle.epsilon_s =
      table.get_double(energy_section + "Stop tolerance");
    p.energy_bundle.gamma =
      table.get_double(energy_section + "Distance weight");
    p.energy_bundle.bundle_size =
      table.get_unsigned(energy_section + "Bundle size");
    p.energy_bundle.maximum_iterations =
      table.get_unsigned(energy_section + "Maximum iterations");
    p.majorise_minimise.tolerance =
      table.get_double(majorise_section + "Stop tolerance");
    p.majorise_minimise.maximum_iterations =
      table.get_unsigned(majorise_section + "Maximum iterations");
    const auto search = std::find(search_names.begin(),
                                  search_names.end(),
                                  table.get("Solver/Search"));
    p.search          = static_cast<BondSearchChoice>(
      std::distance(search_names.begin(), search));
    p.full_search         = search_with(table.get_list("Solver/Search moves"));
    p.prove               = table.get_bool("Solver/Prove");
    p.proof.tolerance     = table.get_double(proof_section + "Tolerance");
    p.proof.maximum_nodes = table.get_unsigned(proof_section + "Maximum nodes");
    p.proof.maximum_seconds = table.get_double(proof_section + "Maximum time");
    p.proof.n_threads = table.get(proof_section + "Threads") == "available" ?
                          std::max(1u, std::thread::hardware_concurrency()) :
                          table.get_unsigned(proof_section + "Threads");
    p.bundle.line_search =
      parse_descent_rule(table.get(bundle_section + "Line search"));
    p.bundle.epsilon_s   = table.get_double(bundle_section + "Stop tolerance");
    p.bundle.bundle_size = table.get_unsigned(bundle_section + "Bundle size");
    p.bundle.maximum_iterations =
      table.get_unsigned(bundle_section + "Maximum iterations");
    const std::string start = table.get(bundle_section + "Start");
    p.start                 = start == "zero" ? "" : start;

    // The patterns leave only m_L < m_R to be checked.
    try
      {
        p.bundle.validate();
      }
    catch (const std::invalid_argument &error)
      {
        table.add_error(bundle_section + "Slope fraction",
                        error.what(),
                        {bundle_section + "Descent fraction"});
      }
  }
} // namespace Debond
