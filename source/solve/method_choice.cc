// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/memory.h>
#include <debond/input/bad_input.h>
#include <debond/linear_algebra/cholmod_factor.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/method_choice.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// The time below which the choice hardly matters. With a factorisation the
    /// search is on all contact nodes, so that is preferred.
    constexpr double seconds_that_matter = 1.;

    /// The factor by which multigrid has to be faster: the estimates are no
    /// better than that.
    constexpr double factor_that_matters = 1.3;



    std::string
    rounded(const double number)
    {
      std::ostringstream text;
      text << std::setprecision(2) << number;
      return text.str();
    }



    /// The memory of mesh and matrix for each unknown, as measured.
    constexpr double bytes_of_mesh_and_matrix = 600.;

    /// The time of a solve with @p n unknowns and @p n_c contact nodes: of a
    /// node, of an operation with dense fronts, of S, which is factorised a few
    /// times, and of the search, as measured for doc/notes/speed.md.
    double
    seconds_with_factorisation(const unsigned int      dim,
                               const FactorisationCost cost,
                               const double            n,
                               const double            n_c)
    {
      return (dim == 2 ? 2.5e-6 : 6e-6) * n +
             1.4e-11 * (cost.operations + 3. * std::pow(n_c, 3)) +
             5e-7 * n_c * n_c;
    }



    /// The factor by which nearly incompressible materials multiply the cycles,
    /// relative to nu = 1/3. The smoother does not see fields without
    /// divergence. In plane stress there is no such field.
    double
    more_cycles(const ProblemParameters &problem)
    {
      const Material &everywhere = problem.materials.everywhere;
      if (problem.dimension == 2 &&
          everywhere.hypothesis == Material::Hypothesis::plane_stress)
        return 1.;
      // Orthotropic ones are not near to incompressible.
      const auto poisson_ratio = [](const Material &material) {
        return material.orthotropy ? 0. : material.poisson_ratio;
      };
      double largest = poisson_ratio(everywhere);
      for (const auto &[region, material] : problem.materials.of_regions())
        largest = std::max(largest, poisson_ratio(material));
      return std::pow(std::min(1., 3. * (1. - 2. * largest)), -0.4);
    }



    /// The time of a solve of @p n unknowns by multigrid, within a factor of
    /// about 3 on the bodies measured.
    double
    seconds_with_multigrid(const ProblemParameters &problem,
                           const bool               has_levels,
                           const double             n)
    {
      const auto   lengths = problem.body->extents();
      const double slenderness =
        *std::max_element(lengths.begin(),
                          lengths.begin() + problem.dimension) /
        *std::min_element(lengths.begin(), lengths.begin() + problem.dimension);
      if (has_levels)
        return (problem.dimension == 2 ? 0.03 + 2.2e-6 * n :
                                         0.05 + 4.6e-6 * n) *
               more_cycles(problem) * std::max(1., slenderness / 50.);
      if (problem.dimension == 2)
        return 5e-6 * n;

      // The cycle has no grip on the bending of thin bodies unless their
      // contact side is held.
      const double bending = problem.tangential_displacement_fixed ?
                               1. :
                               std::max(1., slenderness / 1.5);
      return 3e-5 * n * bending;
    }



    /// Returns whether the scene needs S and g: for the metric of the energy
    /// bundle, for Newton steps and second-order conditions where bonds soften,
    /// for full searches, proofs and arcs, and for bodies that only bonds hold,
    /// whose resultants are set in g.
    template <int dim>
    bool
    needs_condensed(const Scene<dim>       &scene,
                    const SolverParameters &solver,
                    const std::string      &method)
    {
      const LoadPathParameters &path = scene.parameters().load_path;
      return method == SolverMethod::energy_bundle || solver.prove ||
             scene.law().softens() || solver.search == BondSearchChoice::full ||
             path.arc ||
             (!path.factors.empty() &&
              path.global_branch == GlobalBranch::prove) ||
             !scene.problem().unknowns().held_by_contact().motions.empty();
    }



    /// How many times as many cycles materials take that differ inside the
    /// cells of coarser levels, or in neighbouring cells, where levels are of
    /// aggregates: with inclusions of a few cells 4 to 15 for a modulus that is
    /// a hundred times as large, 10 to 30 for ten thousand times.
    template <int dim>
    double
    more_cycles_by_contrast(const Scene<dim> &scene)
    {
      const ElasticFields<dim>       &fields = scene.problem().fields();
      std::vector<double>             ratios;
      std::vector<dealii::Point<dim>> centres; // of two cells for each ratio
      // Each face inside the body between two materials, seen from the stiffer
      // side, is a candidate.
      for (const auto &cell : owned_cells(fields.unknowns().dof_handler()))
        for (const unsigned int f : cell->face_indices())
          if (!cell->at_boundary(f))
            {
              const auto   neighbor = cell->neighbor(f);
              const double ratio =
                fields.material(cell).extreme_moduli()[1] /
                fields.material(neighbor).extreme_moduli()[1];
              if (ratio > 1.)
                {
                  ratios.push_back(ratio);
                  centres.push_back(cell->center());
                  centres.push_back(neighbor->center());
                }
            }

      double contrast = 1.;
      if (!ratios.empty() && !scene.body().has_coarse_levels())
        contrast = *std::max_element(ratios.begin(), ratios.end());
      std::unique_ptr<const Body<dim>> coarser;
      // A contrast hurts only where one coarse cell covers both materials, for
      // its displacements are then too stiff for the soft one. Two centres are
      // in one coarse cell if interpolation to them uses the vertices of one
      // simplex.
      for (const Body<dim> *body = &scene.body(); body != nullptr;
           coarser = body->coarser_level(), body = coarser.get())
        if (const auto levels = body->coarse_levels(centres); !levels.empty())
          {
            const Interpolation &corners = levels[0].to_finer;
            const auto           first   = corners.nodes.begin();
            for (std::size_t k = 0; k < ratios.size(); ++k)
              if (std::set<unsigned int>(first + corners.starts[2 * k],
                                         first + corners.starts[2 * k + 2])
                    .size() <= dim + 1)
                contrast = std::max(contrast, ratios[k]);
          }
      return std::pow(dealii::Utilities::MPI::max(contrast, scene.ranks()),
                      0.4);
    }



    /// Bytes for each unknown, beside mesh and A.
    double
    memory_with_multigrid(const unsigned int dim, const bool has_levels)
    {
      return has_levels ? (dim == 2 ? 300. : 400.) : (dim == 2 ? 1200. : 3000.);
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
        refuse("Factors", "needs another Solver/Method than " + choice.method);
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
  memory_of_factorisation(const unsigned int dim, const double n)
  {
    // The fill of minimum degree orderings is about n log n in 2D, n^(4/3) in
    // 3D.
    return dim == 2 ?
             (900. + 29. * std::log2(n)) * n :
             bytes_of_mesh_and_matrix * n + 125. * std::pow(n, 4. / 3.);
  }



  double
  least_memory(const MethodChoice &wanted,
               const unsigned int  dim,
               const double        n)
  {
    const double with_multigrid =
      (bytes_of_mesh_and_matrix + memory_with_multigrid(dim, false)) * n;
    return wanted.linear_solver == LinearSolver::direct ?
             memory_of_factorisation(dim, n) :
           wanted.linear_solver == LinearSolver::multigrid ?
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
    MethodChoice choice = {solver.method, solver.linear_solver, ""};
    if (choice.method == SolverMethod::euclidean_bundle)
      choice.linear_solver = LinearSolver::none;
    // The paper's method needs thousands of iterations where this one needs a
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
      throw BadInput({problem.scene + ": Solver/" +
                      (searches ? "Search" : "Prove") +
                      " needs another method than " + choice.method});
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
    const ProblemParameters    &problem    = scene.parameters();
    const ElasticUnknowns<dim> &unknowns   = scene.problem().unknowns();
    const double                n          = unknowns.n_dofs();
    const double                n_c        = unknowns.contact().size();
    const double                left       = memory_left(solver.memory_limit);
    const bool                  has_levels = scene.body().has_coarse_levels();
    const bool needs_S      = needs_condensed(scene, solver, choice.method);
    double     direct_bytes = 0.;
    // A is known by now, and its symbolic factorisation gives the numbers of
    // entries and operations of the factor, in a small part of the time.
    if (choice.linear_solver == LinearSolver::automatic ||
        choice.linear_solver == LinearSolver::direct)
      {
        const FactorisationCost cost =
          factorisation_cost({scene.problem().matrix(),
                              unknowns.dof_handler().locally_owned_dofs(),
                              scene.ranks()},
                             unknowns.contact().normal_dofs(),
                             dim);
        // The factor, A in it while it is made, S and what is made of it.
        direct_bytes = 8. * cost.entries + 300. * n + 4. * 8. * n_c * n_c;
        if (choice.linear_solver == LinearSolver::automatic)
          {
            const double direct_seconds =
              seconds_with_factorisation(dim, cost, n, n_c);
            // Multigrid pays its cycles for each right-hand side: for each
            // column of S if that is needed, and for each step of a path.
            // Contrasts take a walk over all cells to find, and only matter
            // where a factorisation is slow.
            const double multigrid_seconds =
              seconds_with_multigrid(problem, has_levels, n) *
              (direct_seconds > seconds_that_matter ?
                 more_cycles_by_contrast(scene) :
                 1.) *
              (needs_S ? n_c : 1.) *
              static_cast<double>(
                std::max<std::size_t>(1, problem.load_path.factors.size()));
            std::string reason;
            // CHOLMOD counts in 31 bits, so that a factor beyond some size is
            // refused by it whatever the memory.
            if (direct_bytes > left || 8. * cost.entries > 1e12)
              reason = "a factorisation would take about " +
                       in_gib(direct_bytes) + " more, there are " +
                       in_gib(left);
            else if (direct_seconds > seconds_that_matter &&
                     direct_seconds > factor_that_matters * multigrid_seconds)
              reason = "it takes less time";
            choice.linear_solver =
              reason.empty() ? LinearSolver::direct : LinearSolver::multigrid;
            if (!reason.empty())
              choice.reason += (choice.reason.empty() ? "" : "; ") +
                               ("by multigrid, since " + reason);
            if (std::max(direct_seconds, needs_S ? 0. : multigrid_seconds) >
                seconds_that_matter)
              choice.reason +=
                (choice.reason.empty() ? "" : "; ") +
                ("estimated are " + rounded(direct_seconds) +
                 " s with a factorisation, " + rounded(multigrid_seconds) +
                 " s with multigrid");
          }
      }

    choice.has_levels =
      choice.linear_solver == LinearSolver::multigrid && has_levels;
    // S by multigrid only where something needs it, since each of its columns
    // is a solution.
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
      throw BadInput({problem.scene + ": about " + rounded(n) +
                      " unknowns need about " + in_gib(bytes) +
                      " more of memory with " + choice.method +
                      (choice.linear_solver == LinearSolver::none ?
                         "" :
                         " and the linear solver " + choice.linear_solver) +
                      ", there are " + in_gib(left) + "; try fewer Mesh/Cells" +
                      (choice.linear_solver == LinearSolver::direct ?
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
    // Too little memory for a factorisation leaves the failure of multigrid as
    // the result.
    MethodChoice direct  = choice;
    direct.linear_solver = LinearSolver::direct;
    try
      {
        choose_linear_solver(scene, solver, direct);
      }
    catch (const BadInput &)
      {
        return {};
      }
    return direct;
  }



  template decltype(choose_linear_solver<2>)  choose_linear_solver<2>;
  template decltype(choose_linear_solver<3>)  choose_linear_solver<3>;
  template decltype(factorisation_instead<2>) factorisation_instead<2>;
  template decltype(factorisation_instead<3>) factorisation_instead<3>;
} // namespace Debond
