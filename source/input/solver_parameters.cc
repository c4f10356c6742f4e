// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/solver_parameters.h>

namespace Debond
{
  namespace
  {
    const std::string end_of_iterations =
      "Iterations after which the method gives up; the program then returns 3";



    void
    bind_euclidean_bundle(ProximalBundleParameters &bundle,
                          std::string              &start,
                          ParameterTable           &table)
    {
      // The descriptions have the symbols of the paper, whose algorithm this
      // is. The tolerance at which it stops is an energy in the units of the
      // scene, while those of the other methods are relative.
      const std::string section = "Solver/Euclidean bundle/";
      table.bind(section + "Proximal weight",
                 bundle.u,
                 positive_number(),
                 "u_k, the weight of the proximal term u_k/2 |d|^2",
                 "energy per squared length");
      table.bind(
        section + "Distance weight",
        bundle.gamma,
        number(">= 0", [](double x) { return x >= 0.; }),
        "gamma, the weight of the distance in the subgradient locality measure",
        "energy per squared length");
      table.bind(section + "Long step threshold",
                 bundle.t_bar,
                 number("in (0, 1]", [](double x) { return x > 0 && x <= 1; }),
                 "t_bar, the step length below which a step is a short one");
      table.bind(
        section + "Descent fraction",
        bundle.m_L,
        number("in (0, 0.5)", [](double x) { return x > 0 && x < 0.5; }),
        "m_L, the part of the predicted descent that a step has to reach, eq. (14)");
      table.bind(
        section + "Slope fraction",
        bundle.m_R,
        number("in (0, 1)", [](double x) { return x > 0 && x < 1; }),
        "m_R, the part of the predicted slope that a new subgradient has to exceed, eq. (15); above the descent fraction m_L");
      table.bind_choice(
        section + "Line search",
        bundle.line_search,
        {{"largest", DescentRule::largest},
         {"halving", DescentRule::halving},
         {"minimum", DescentRule::minimum}},
        "Which step with (14) is taken: 'largest' in [0, 1] by bisection, as in the paper's text; 'halving', the first of 1, 1/2, 1/4, ...; 'minimum', on along these while the functional falls, then the minimum of a parabola");
      table.bind(
        section + "Stop tolerance",
        bundle.epsilon_s,
        positive_number(),
        "epsilon_s: the method stops when the predicted descent is not above it, v_k >= -epsilon_s",
        "energy");
      table.bind(section + "Bundle size",
                 bundle.bundle_size,
                 whole_number(2, 100000),
                 "Subgradients that are kept before the bundle is emptied");
      table.bind(section + "Maximum iterations",
                 bundle.maximum_iterations,
                 whole_number(1, 1000000000),
                 end_of_iterations);
      table.declare(
        section + "Start",
        "zero",
        Pattern("zero or a path",
                [](const std::string &value) { return !value.empty(); }),
        "The first iterate: zero is the undeformed body; otherwise the path of the displacement.txt of a scene with the same mesh and boundary conditions",
        "none",
        [&start](const std::string &text) {
          start = text == "zero" ? "" : text;
        });
    }



    void
    bind_energy_bundle(ProximalBundleParameters &bundle, ParameterTable &table)
    {
      // The energy norm takes the place of the proximal weight. Fractions of
      // descent and the line search have no entries and keep their defaults.
      const std::string section = "Solver/Energy bundle/";
      table.bind(
        section + "Stop tolerance",
        bundle.epsilon_s,
        positive_number(),
        "epsilon_s relative to the energy 1/2 <A u, u> that the body has without contact");
      table.bind(
        section + "Distance weight",
        bundle.gamma,
        number(">= 0", [](double x) { return x >= 0.; }),
        "gamma, the weight of the distance, measured in the energy norm, in the subgradient locality measure");
      table.bind(section + "Bundle size",
                 bundle.bundle_size,
                 whole_number(2, 1000),
                 "Subgradients that are kept before the bundle is emptied");
      table.bind(section + "Maximum iterations",
                 bundle.maximum_iterations,
                 whole_number(1, 1000000),
                 end_of_iterations);
    }



    void
    bind_majorise_minimise(MajoriseMinimiseParameters &majorise_minimise,
                           ParameterTable             &table)
    {
      const std::string section = "Solver/Majorise minimise/";
      table.bind(
        section + "Stop tolerance",
        majorise_minimise.tolerance,
        positive_number(),
        "The optimality conditions hold to this part of the largest force on a contact node");
      table.bind(section + "Maximum iterations",
                 majorise_minimise.maximum_iterations,
                 whole_number(1, 1000000),
                 end_of_iterations);
    }



    void
    bind_search(SolverParameters &solver, ParameterTable &table)
    {
      table.bind_choice(
        "Solver/Search",
        solver.search,
        {{"automatic", BondSearchChoice::automatic},
         {"none", BondSearchChoice::none},
         {"full", BondSearchChoice::full}},
        "Whether a lower minimum than the one found is searched for by changing which bonds are broken: full does what automatic does, and then starts from rest and from all bonds broken, moves the edges of the broken patches by up to four nodes and breaks, closes and splits patches; automatic is none unless the method is automatic, and then as much of this as it takes until a lower bound of J (with nodal quadrature) says that it is enough, with more than 200 contact nodes on coarser ones but for the starts from rest and from all bonds broken");
    }



    void
    bind_proof(bool                     &prove,
               BranchAndBoundParameters &proof,
               ParameterTable           &table)
    {
      table.bind(
        "Solver/Prove",
        prove,
        "Whether the result is proved to be the global minimum, or replaced by it, by branch and bound on the broken bonds; of meshes that are refined on the last one. Needs nodal quadrature");
      const std::string section = "Solver/Proof/";
      table.bind(
        section + "Tolerance",
        proof.tolerance,
        number("> 0 and <= 1e-2", [](double x) { return x > 0 && x <= 1e-2; }),
        "The gap between J and its lower bound that counts as a proof, relative to what the bonds can change in J: the energy of all bonds when they break, or what the contact nodes would gain without foundation and bonds if that is less");
      table.bind(
        section + "Maximum nodes",
        proof.maximum_nodes,
        whole_number(1, 1000000000),
        "Nodes of the branch and bound tree after which the proof ends with the gap that is left");
      table.bind(
        section + "Maximum time",
        proof.maximum_seconds,
        positive_number(),
        "Wall time after which the proof ends with the gap that is left",
        "seconds");
      // The number of threads is a word or a number, and is known when the
      // scene is read: one for each core that the system reports, or one if it
      // reports none.
      table.declare(
        section + "Threads",
        "available",
        Pattern("available, or a whole number from 1 to 64",
                [whole = whole_number(1, 64)](const std::string &text) {
                  return text == "available" || whole.match(text);
                }),
        "Nodes that are bounded at the same time, at most 8; available is one for each core. The result does not depend on it, but for limits of time",
        "none",
        [&proof](const std::string &text) {
          proof.n_threads =
            text == "available" ?
              std::max(1u, std::thread::hardware_concurrency()) :
              static_cast<unsigned int>(std::stoul(text));
        });
    }
    /// Values with their names.
    template <typename T>
    std::vector<std::pair<std::string, T>>
    choices(const std::initializer_list<T> values)
    {
      std::vector<std::pair<std::string, T>> result;
      for (const T value : values)
        result.emplace_back(to_string(value), value);
      return result;
    }
  } // namespace



  std::string
  to_string(const SolverMethod method)
  {
    // The names are in the order of the enumeration. Scenes, the log and
    // summary.json have them.
    static const std::array<const char *, 4> names = {
      {"automatic", "euclidean bundle", "energy bundle", "majorise minimise"}};
    return names[static_cast<std::size_t>(method)];
  }



  std::string
  to_string(const LinearSolver solver)
  {
    static const std::array<const char *, 4> names = {
      {"none", "automatic", "direct", "multigrid"}};
    return names[static_cast<std::size_t>(solver)];
  }



  void
  bind_solver(SolverParameters &solver, ParameterTable &table)
  {
    table.bind_choice(
      "Solver/Method",
      solver.method,
      choices({SolverMethod::automatic,
               SolverMethod::euclidean_bundle,
               SolverMethod::energy_bundle,
               SolverMethod::majorise_minimise}),
      "The minimiser: euclidean bundle is the paper's proximal bundle method; energy bundle is the same method on the normal displacements of the contact nodes alone, in the energy norm; majorise minimise fixes the branch of the law at each quadrature point in turn and is exact after finitely many steps; automatic chooses and says why");
    table.bind_choice(
      "Solver/Linear solver",
      solver.linear_solver,
      choices({LinearSolver::automatic,
               LinearSolver::direct,
               LinearSolver::multigrid}),
      "How the linear systems of energy bundle and majorise minimise are solved: direct factorises A once and goes on with the contact normals alone, multigrid iterates on all unknowns, starting from the solutions on coarser meshes, and takes less memory in large scenes; what needs the contact normals alone (energy bundle, Search = full, Prove, an arc, bodies that only bonds hold) takes a solution for each of them then; automatic chooses by size and memory. euclidean bundle needs none");
    // The limit of 0 bytes stands for what the system can give.
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
      "GiB",
      [&solver](const std::string &text) {
        double limit = 0.;
        if (text != "available")
          read_number(text, limit);
        solver.memory_limit = limit * (1 << 30);
      });
    bind_euclidean_bundle(solver.bundle, solver.start, table);
    bind_energy_bundle(solver.energy_bundle, table);
    bind_majorise_minimise(solver.majorise_minimise, table);
    bind_search(solver, table);
    bind_proof(solver.prove, solver.proof, table);
  }



  void
  check_solver(const SolverParameters &solver, ParameterTable &table)
  {
    // Patterns look at one number. That one exceeds another can be checked only
    // when both are known.
    if (!(solver.bundle.m_R > solver.bundle.m_L))
      table.reject("Solver/Euclidean bundle/Slope fraction",
                   words("Slope fraction m_R = ",
                         solver.bundle.m_R,
                         " must be in (m_L, 1)."),
                   {"Solver/Euclidean bundle/Descent fraction"});
  }
} // namespace Debond
