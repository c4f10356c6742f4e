// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/memory.h>
#include <debond/input/bad_input.h>
#include <debond/linear_algebra/aggregation.h>
#include <debond/linear_algebra/cholmod_factor.h>
#include <debond/solve/minimum/method_choice.h>

namespace Debond
{
  namespace
  {
    /// The operations that a factorisation may take: less is a second, below
    /// which the choice hardly matters, and with a factorisation the search is
    /// on all contact nodes. Aggregates take about ten times as long as the
    /// coarser meshes of the body, and in 2D longer than any factorisation.
    constexpr double largest_factorisation = 2e10, of_aggregates = 10.;



    std::string
    rounded(const double number)
    {
      std::ostringstream text;
      text << std::setprecision(2) << number;
      return text.str();
    }



    /// The memory of mesh and matrix for each unknown, as measured.
    constexpr double bytes_of_mesh_and_matrix = 600.;

    /// The factor by which multigrid takes more cycles of these materials than
    /// of one with nu = 1/3: it has no grip on fields without divergence if
    /// they are nearly incompressible, nor on inclusions that differ from what
    /// is around them.
    double
    more_cycles(const MaterialParameters &materials)
    {
      // The measure is the largest bulk modulus over the least Young modulus.
      // For one isotropic material that is 1 / (3 (1 - 2 nu)), which is 1 for
      // nu = 1/3 and grows without bound towards 1/2; for several it contains
      // their contrast.
      double     softest  = std::numeric_limits<double>::max();
      double     stiffest = 0.; // as a bulk modulus
      const auto add      = [&](const Material &material) {
        const auto moduli = material.extreme_moduli();
        softest           = std::min(softest, moduli[0]);
        stiffest =
          std::max(stiffest,
                   material.orthotropy ?
                          moduli[1] :
                          moduli[1] / (3. * (1. - 2. * material.poisson_ratio)));
      };
      add(materials.everywhere);
      for (const auto &[region, material] : materials.of_regions())
        add(material);
      return std::pow(std::max(1., stiffest / softest), 0.4);
    }



    /// Returns whether the scene needs S and g: for the metric of the energy
    /// bundle, for Newton steps and second-order conditions if bonds soften,
    /// for full searches, proofs and arcs, for pressures of friction, and for
    /// bodies that only bonds hold, whose resultants are set in g.
    template <int dim>
    bool
    needs_condensed(const Scene<dim>       &scene,
                    const SolverParameters &solver,
                    const SolverMethod      method)
    {
      const LoadPathParameters &path = scene.parameters().load_path;
      return method == SolverMethod::energy_bundle || solver.prove ||
             scene.law().softens() || solver.search == BondSearchChoice::full ||
             path.arc || scene.adhesion().friction().depends_on_pressure() ||
             (!path.factors.empty() &&
              path.global_branch == GlobalBranch::prove) ||
             !scene.problem().unknowns().is_held_by_supports();
    }



    /// Bytes for each unknown, beside mesh and A.
    double
    memory_with_multigrid(const unsigned int dim, const bool has_levels)
    {
      return has_levels ? (dim == 2 ? 300. : 400.) : (dim == 2 ? 1200. : 3000.);
    }



    /// The paper's method solves no linear system.
    LinearSolver
    wanted_linear_solver(const SolverParameters &solver,
                         const SolverMethod      method)
    {
      return method == SolverMethod::euclidean_bundle ? LinearSolver::none :
                                                        solver.linear_solver;
    }



    void
    check_load_path(const ProblemParameters &problem,
                    const bool               proves,
                    const MethodChoice      &choice)
    {
      const auto refuse = [&problem](const std::string &entry,
                                     const std::string &reason) {
        throw BadInput({problem.scene + ": Load path/" + entry + ' ' + reason});
      };
      if (choice.method == SolverMethod::euclidean_bundle)
        refuse("Factors",
               "needs another Solver/Method than " + to_string(choice.method));
      if (proves)
        refuse("Factors",
               "follows minima that need not be global: in place of "
               "Solver/Prove = true use Load path/Global branch = prove");
      if (problem.load_path.global_branch == GlobalBranch::prove &&
          problem.quadrature.rule != ContactQuadratureParameters::Rule::nodal)
        refuse("Global branch",
               "= prove needs Contact law/Quadrature = nodal, which gives "
               "each node a bond of its own");
    }
  } // namespace



  double
  memory_of_factorisation(const unsigned int dim, const double n)
  {
    // Bytes of mesh, matrix and factor. The fill of minimum degree orderings is
    // about n log n in 2D, n^(4/3) in 3D.
    return dim == 2 ?
             (900. + 29. * std::log2(n)) * n :
             bytes_of_mesh_and_matrix * n + 125. * std::pow(n, 4. / 3.);
  }



  double
  least_memory(const LinearSolver wanted,
               const unsigned int dim,
               const double       n)
  {
    // Without coarser meshes multigrid has levels of aggregates, which take
    // more than those of meshes: the estimate is for these.
    const double with_multigrid =
      (bytes_of_mesh_and_matrix + memory_with_multigrid(dim, false)) * n;
    return wanted == LinearSolver::direct ?
             memory_of_factorisation(dim, n) :
           wanted == LinearSolver::multigrid ?
             with_multigrid :
             std::min(memory_of_factorisation(dim, n), with_multigrid);
  }



  MethodChoice
  choose_method(const ProblemParameters &problem,
                const SolverParameters  &solver)
  {
    // Mesh and matrix are made before a factorisation can be estimated, and may
    // already be too much for the machine. So they are estimated from the
    // number of vertices alone, and the user is told before they are made.
    const double n     = problem.dimension * problem.body->n_vertices();
    const double bytes = bytes_of_mesh_and_matrix * n;
    const double left  = memory_left(solver.memory_limit);
    if (bytes > left)
      throw BadInput(
        {problem.scene + ": about " + rounded(n) + " unknowns need about " +
         in_gib(bytes) + " of memory for mesh and matrix alone, there are " +
         in_gib(left) +
         "; try fewer Mesh/Cells or a higher Solver/Memory limit"});

    // Methods and entries that exclude each other are refused now, without a
    // mesh.
    MethodChoice choice;
    choice.method        = solver.method;
    choice.linear_solver = wanted_linear_solver(solver, choice.method);
    // The paper's method needs thousands of iterations, while this one needs a
    // few majorants; it is there to be reproduced, for those who ask for it.
    if (choice.method == SolverMethod::automatic)
      {
        choice.method = SolverMethod::majorise_minimise;
        choice.reason =
          "it is exact after finitely many steps, at the price of about "
          "one linear solve";
      }
    const bool searches = solver.search == BondSearchChoice::full;
    if (!problem.load_path.factors.empty())
      check_load_path(problem, solver.prove, choice);
    if ((searches || solver.prove) &&
        choice.linear_solver == LinearSolver::none)
      throw BadInput(
        {problem.scene + ": Solver/" + (searches ? "Search" : "Prove") +
         " needs another method than " + to_string(choice.method)});
    if (solver.prove &&
        problem.quadrature.rule != ContactQuadratureParameters::Rule::nodal)
      throw BadInput({problem.scene +
                      ": Solver/Prove needs Contact law/Quadrature = nodal, "
                      "which gives each node a bond of its own"});

    return choice;
  }



  template <int dim>
  void
  choose_linear_solver(const Scene<dim>       &scene,
                       const SolverParameters &solver,
                       MethodChoice           &choice)
  {
    // Memory comes first, then time, both by the symbolic factorisation of this
    // very matrix. A factorisation is preferred if it fits and its operations
    // are below a limit, since with S and g there are a search and a proof on
    // all contact nodes, and further loads cost little.
    const ProblemParameters    &problem    = scene.parameters();
    const ElasticUnknowns<dim> &unknowns   = scene.problem().unknowns();
    const double                n          = unknowns.n_dofs();
    const double                n_c        = unknowns.contact().size();
    const double                left       = memory_left(solver.memory_limit);
    const bool                  has_levels = scene.body().has_coarse_levels();
    const bool                  has_cycle =
      has_levels || has_aggregation || n <= largest_without_aggregates;
    const bool needs_S      = needs_condensed(scene, solver, choice.method);
    double     direct_bytes = 0.;
    choice.linear_solver    = wanted_linear_solver(solver, choice.method);
    choice.reason_for_multigrid.clear();
    // A is known by now, and its symbolic factorisation gives the numbers of
    // entries and operations of the factor, in a small part of the time.
    if (choice.linear_solver == LinearSolver::automatic ||
        choice.linear_solver == LinearSolver::direct)
      {
        const FactorisationCost cost =
          factorisation_cost({scene.problem().matrix(),
                              unknowns.dof_handler().locally_owned_dofs(),
                              scene.ranks()},
                             unknowns.contact().dofs(),
                             dim);
        choice.operations = cost.operations;
        // The factor, A in it while it is made, S and what is made of it.
        direct_bytes = 8. * cost.entries + 300. * n + 4. * 8. * n_c * n_c;
        if (choice.linear_solver == LinearSolver::automatic)
          {
            // A path has one factorisation for all its factors, while multigrid
            // solves anew at each of them.
            const std::size_t n_steps =
              std::max<std::size_t>(1, problem.load_path.factors.size());
            std::string &why_multigrid = choice.reason_for_multigrid;
            // CHOLMOD counts in 31 bits, so that a factor beyond some size is
            // refused by it whatever the memory. Multigrid pays its cycles for
            // each step of a path, and for each column of S if that is needed,
            // which are too many.
            if (has_cycle && (direct_bytes > left || 8. * cost.entries > 1e12))
              why_multigrid = "a factorisation would take about " +
                              in_gib(direct_bytes) + " more, there are " +
                              in_gib(left);
            else if (has_cycle && (dim == 3 || has_levels) && !needs_S &&
                     cost.operations > largest_factorisation *
                                         (has_levels ? 1. : of_aggregates) *
                                         more_cycles(problem.materials) *
                                         static_cast<double>(n_steps))
              why_multigrid = "it takes less time";
            choice.linear_solver = why_multigrid.empty() ?
                                     LinearSolver::direct :
                                     LinearSolver::multigrid;
          }
      }

    if (choice.linear_solver == LinearSolver::multigrid && !has_cycle)
      throw BadInput({problem.scene +
                      ": Solver/Linear solver = multigrid needs Trilinos with "
                      "ML for a mesh without coarser ones, and the program was "
                      "built without; try direct"});

    choice.has_levels =
      choice.linear_solver == LinearSolver::multigrid && has_levels;
    // S by multigrid only if something needs it, since each of its columns is a
    // solution.
    choice.is_condensed =
      choice.linear_solver == LinearSolver::direct ||
      (choice.linear_solver == LinearSolver::multigrid && needs_S);
    // The paper's method stores its subgradients, the others their factor or
    // their levels, and S with what is made of it.
    const double bytes = choice.linear_solver == LinearSolver::none ?
                           8. * solver.bundle.bundle_size * n :
                         choice.linear_solver == LinearSolver::direct ?
                           direct_bytes :
                           memory_with_multigrid(dim, choice.has_levels) * n +
                             (needs_S ? 4. * 8. * n_c * n_c : 0.);
    choice.memory      = used_memory() + bytes;
    if (bytes > left)
      throw BadInput(
        {problem.scene + ": about " + rounded(n) + " unknowns need about " +
         in_gib(bytes) + " more of memory with " + to_string(choice.method) +
         (choice.linear_solver == LinearSolver::none ?
            "" :
            " and the linear solver " + to_string(choice.linear_solver)) +
         ", there are " + in_gib(left) + "; try fewer Mesh/Cells" +
         (choice.linear_solver == LinearSolver::direct && has_cycle ?
            ", Solver/Linear solver = multigrid," :
            "") +
         " or a higher Solver/Memory limit"});
  }



  template <int dim>
  std::optional<MethodChoice>
  factorisation_instead(const Scene<dim>       &scene,
                        const SolverParameters &solver,
                        const MethodChoice     &choice,
                        const SolverStatus      status)
  {
    if (choice.linear_solver != LinearSolver::multigrid ||
        (status != SolverStatus::stagnated &&
         status != SolverStatus::quadratic_program))
      return {};
    // Multigrid has stagnated, or its conjugate gradients have not reached
    // their tolerance. If there is too little memory for a factorisation, the
    // failure of multigrid remains the result.
    MethodChoice     direct   = choice;
    SolverParameters directly = solver;
    directly.linear_solver    = LinearSolver::direct;
    try
      {
        choose_linear_solver(scene, directly, direct);
      }
    catch (const BadInput &)
      {
        return {};
      }
    return direct;
  }



  DEBOND_INSTANTIATE(choose_linear_solver);
  DEBOND_INSTANTIATE(factorisation_instead);
} // namespace Debond
