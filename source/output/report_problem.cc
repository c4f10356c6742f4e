// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/base/version.h>
#include <debond/output/report.h>

namespace Debond
{
  namespace
  {
    void
    report_program(Record &record)
    {
      // Revision, version and build type are in the summary in any case, so
      // that a result can be made again. The log has them only with details:
      // logs without details are compared between machines and revisions.
      record.add({{"revision", version.revision},
                  {"deal_ii_version", version.deal_ii},
                  {"build_type", version.build_type}});
      record.heading("Debond " + version.program +
                     (record.has_details() ?
                        ", revision " + version.revision + ", deal.II " +
                          version.deal_ii + ", " + version.build_type :
                        ""));
    }



    /// The strength in shear that follows from stiffness and energy, for the
    /// log. A law scaled by a factor in its stiffness and another one in its
    /// energy has the root of their product in its strength. An entry that is
    /// empty, or an expression that is no number, has the factor 1.
    std::string
    strength_in_shear(const ProblemParameters &problem)
    {
      const AdhesiveLaw law(problem.law.pieces);
      double            ratio = 1., energy = 1.;
      if (read_number(problem.shear.stiffness.everywhere, ratio))
        ratio /= law.second_derivative(0.);
      if (read_number(problem.shear.energy.everywhere, energy))
        energy /= law.pieces().largest_value();
      return words(", strength ",
                   law.bond_strength() * std::sqrt(ratio * energy));
    }



    /// The numbers of a material as the log has them.
    std::string
    text_of(const Material &material)
    {
      using Three      = std::array<double, 3>;
      const auto three = [](const Three &of) {
        return words(of[0], ", ", of[1], ", ", of[2]);
      };
      // An orthotropic material has nine numbers in place of two. Expansion and
      // angle are mentioned if they are not zero, and an expansion that is the
      // same along all axes as one number.
      const Orthotropy own     = material.orthotropy.value_or(Orthotropy());
      const Three     &alpha   = material.thermal_expansions;
      const bool       is_even = alpha[0] == alpha[1] && alpha[0] == alpha[2];
      return words(
        material.orthotropy ?
          "E = " + three(own.young_moduli) + ", nu = " +
            three(own.poisson_ratios) + ", G = " + three(own.shear_moduli) :
          words(
            "E = ", material.young_modulus, ", nu = ", material.poisson_ratio),
        alpha == Three() ? "" :
        is_even          ? words(", alpha = ", alpha[0]) :
                           ", alpha = " + three(alpha),
        material.axis_angle == 0. ?
          "" :
          words(", axis 1 at ", material.axis_angle, " degrees"));
    }



    void
    report_data(const ProblemParameters &problem,
                const unsigned int       n_contact_nodes,
                Record                  &record)
    {
      // The log repeats what the scene says, in the order of its sections and
      // with the texts that it has, so that a look at it tells whether the
      // scene is the one that was meant. An entry that is empty has no line,
      // but for supports and contact: that a body is clamped nowhere is worth a
      // line.
      const auto list = [](const std::set<std::string> &names) {
        return join({names.begin(), names.end()}, ", ");
      };
      const auto line = [&record](const std::string &label,
                                  const std::string &text) {
        if (!text.empty())
          record.line(label, text);
      };
      const auto lines =
        [&line](const std::string                        &label,
                const std::map<std::string, std::string> &texts) {
          for (const auto &[side, text] : texts)
            line(label + ' ' + side, text);
        };
      // The hypothesis is that of the whole body, whatever the materials of
      // regions are.
      const Material &material = problem.materials.everywhere;
      record.line("material",
                  text_of(material),
                  problem.dimension == 3 ? "" :
                  problem.symmetry == Symmetry::axis ?
                                           ", around the axis x = 0" :
                  material.hypothesis == Material::Hypothesis::plane_stress ?
                                           ", plane stress" :
                                           ", plane strain");
      for (const auto &[region, own] : problem.materials.of_regions())
        record.line("material " + region, text_of(own));
      record.line("clamped", list(problem.clamped_boundaries));
      line("roller", list(problem.supports.rollers));
      lines("displacement", problem.supports.displacements);
      line("foundation normal", problem.supports.normal);
      lines("foundation normal", problem.supports.normals);
      line("initial gap", problem.supports.gap);
      lines("initial gap", problem.supports.gaps);
      line("body force", problem.loads.body_force);
      lines("traction", problem.loads.tractions);
      lines("pressure", problem.loads.pressures);
      lines("force", problem.loads.forces);
      line("temperature change", problem.loads.temperature_change);
      record.line("contact",
                  list(problem.contact_boundaries),
                  ", ",
                  n_contact_nodes,
                  " nodes");
      // The quadrature belongs to the discrete law and stands with its numbers;
      // without adhesion there are neither.
      record.line("contact law",
                  problem.law.name,
                  problem.law.data.empty() ?
                    "" :
                    ", " + problem.law.data + ", " + problem.quadrature_name +
                      " quadrature");
      // Bonds that a boundary has for itself, in place of those above.
      for (const auto &[side, bonds] : problem.law.boundaries)
        record.line("bonds " + side,
                    "a = ",
                    bonds.stiffness,
                    ", M = ",
                    bonds.threshold,
                    bonds.energy.empty() ? "" :
                                           ", fracture energy " + bonds.energy);
      lines("tangential", problem.tangential_displacements);
      line("friction bound", problem.friction.bound.everywhere);
      lines("friction bound", problem.friction.bound.boundaries);
      line("friction", problem.friction.coefficient.everywhere);
      lines("friction", problem.friction.coefficient.boundaries);
      lines("shear stiffness", problem.shear.stiffness.boundaries);
      lines("shear strength", problem.shear.strength.boundaries);
      lines("shear energy", problem.shear.energy.boundaries);
      // The strength in shear can be said only of a law with several pieces
      // whose numbers hold everywhere: one piece never breaks, and bonds that
      // vary have another strength at each point.
      if (problem.shear.is_somewhere)
        record.line("bonds in shear",
                    problem.shear.stiffness.everywhere.empty() ?
                      "stiffness as along the normal" :
                      "stiffness " + problem.shear.stiffness.everywhere,
                    !problem.shear.strength.everywhere.empty() ?
                      ", strength " + problem.shear.strength.everywhere :
                    problem.law.has_field() || problem.law.pieces.size() == 1 ?
                      "" :
                      strength_in_shear(problem),
                    problem.shear.breaks_separately ?
                      ", breaking separately, energy " +
                        problem.shear.energy.everywhere :
                    problem.shear.energy.empty() ?
                      "" :
                      ", energy " + problem.shear.energy.everywhere + ", " +
                        problem.shear.mixed_mode_text);
    }
  } // namespace



  template <int dim>
  unsigned int
  report_sizes(const Answer<dim> &answer, Record &record)
  {
    const Scene<dim>        &scene   = *answer.scene;
    const ProblemParameters &problem = scene.parameters();
    const unsigned int       n_nodes =
      static_cast<unsigned int>(scene.contact_boundary().nodes.size());
    // The paper counts the tangential displacements of the contact nodes,
    // although they are fixed: 710 on its mesh 40x4.
    const bool is_fixed =
      problem.tangential_displacement == TangentialDisplacement::fixed &&
      problem.tangential_displacements.empty() &&
      !problem.friction.is_somewhere();
    const unsigned int n_dofs_paper =
      scene.n_unknowns() + (is_fixed ? (dim - 1) * n_nodes : 0);
    record.add({{"cells", scene.n_cells()},
                {"degrees_of_freedom", scene.n_unknowns()},
                {"degrees_of_freedom_paper", n_dofs_paper},
                {"contact_nodes", n_nodes},
                {"linear_solver", to_string(answer.choice.linear_solver)}});
    return n_dofs_paper;
  }



  template <int dim>
  void
  report_problem(const Answer<dim> &begun,
                 const double       bundle_weight,
                 Record            &record)
  {
    // All ranks come here, since extents of the mesh are found by all of them
    // together. The stream of the others takes nothing.
    const Scene<dim>        &scene   = *begun.scene;
    const MethodChoice      &choice  = begun.choice;
    const ProblemParameters &problem = scene.parameters();
    report_program(record);
    record.heading("Problem");
    const unsigned int n_dofs = scene.n_unknowns();
    const unsigned int n_nodes =
      static_cast<unsigned int>(scene.contact_boundary().nodes.size());
    // These are keys of summary.json for studies. With refined meshes what
    // report_sizes() adds is that of the last mesh in the end.
    const unsigned int n_dofs_paper = report_sizes(begun, record);
    record.add(
      {{"scene", problem.scene},
       {"dimension", dim},
       {"symmetry", problem.symmetry == Symmetry::axis ? "axis" : "none"},
       {"degree", problem.degree},
       {"method", to_string(choice.method)}});
    if (record.has_details())
      record.line("scene", problem.scene);
    // The extents show a scale or a unit that is wrong. A rank knows the
    // vertices of its own part of the mesh, so that the extremes are taken over
    // all ranks; each of them asks for the same numbers in the same order.
    const dealii::BoundingBox<dim> box(scene.problem()
                                         .unknowns()
                                         .dof_handler()
                                         .get_triangulation()
                                         .get_vertices());
    std::string                    size;
    for (unsigned int d = 0; d < dim; ++d)
      size +=
        words(d == 0 ? ", " : " x ",
              dealii::Utilities::MPI::max(box.upper_bound(d), scene.ranks()) -
                dealii::Utilities::MPI::min(box.lower_bound(d), scene.ranks()));
    record.line("mesh",
                scene.n_cells(),
                dim == 2 ? " triangles" : " tetrahedra",
                size,
                problem.degree == 2 ? ", quadratic displacements" : "");
    record.line("unknowns",
                n_dofs,
                n_dofs_paper != n_dofs ?
                  words(", with fixed tangential ones ", n_dofs_paper) :
                  "");
    report_data(problem, n_nodes, record);
    // A gap of bodies apart is that of the mesh, which the scene does not say.
    if (scene.problem().unknowns().has_gap() &&
        !scene.body().interfaces.empty())
      {
        double least = infinity, largest = -infinity;
        for (const auto &node : scene.contact_boundary().nodes)
          {
            least   = std::min(least, node.gap);
            largest = std::max(largest, node.gap);
          }
        record.line("gap", "from ", least, " to ", largest);
      }
    // No support holds these rigid motions, so that A is singular and the body
    // can detach. Their names tell of a support that was forgotten.
    if (const auto &motions =
          scene.problem().unknowns().held_by_contact().names;
        !motions.empty())
      record.line("held by contact",
                  join(motions, ", "),
                  ", by bonds and the foundation alone");
    // A choice of the program is said with its reason, one that the scene has
    // made has none.
    std::vector<std::string> reasons;
    if (!choice.reason.empty())
      reasons.push_back(choice.reason);
    if (!choice.reason_for_multigrid.empty())
      reasons.push_back("by multigrid, since " + choice.reason_for_multigrid);
    record.line("method",
                to_string(choice.method),
                choice.linear_solver != LinearSolver::none ?
                  ", " + to_string(choice.linear_solver) + " linear solver" :
                  "",
                choice.method == SolverMethod::euclidean_bundle ?
                  words(", u_k = ", bundle_weight) :
                  "",
                reasons.empty() ? "" : ", chosen since " + join(reasons, "; "));
  }



  void
  report_level(const unsigned int   number,
               const AdaptiveLevel &level,
               Record              &record)
  {
    // The levels are an array, to which the pointer with the next number
    // appends an entry. The error is relative to J or to the scale of the
    // estimate, the gap is GoalOnMesh::width and 0 without a goal, and seconds
    // are those of mesh, assembly and solve.
    if (number == 0)
      record.heading("Meshes");
    record.add("/levels/" + std::to_string(number),
               {{"cells", level.cells},
                {"unknowns", level.unknowns},
                {"contact_nodes", level.contact_nodes},
                {"iterations", level.iterations},
                {"functional", level.functional},
                {"estimated_error", level.estimated_error()},
                {"error_factor", Record::json_of(level.error_factor)},
                {"gap", level.gap},
                {"seconds", level.seconds}});
    record.line(words("mesh ", number),
                level.unknowns,
                " unknowns, ",
                level.contact_nodes,
                " contact nodes, J ",
                scientific(level.functional, 10),
                ", error about ",
                scientific(level.estimated_error(), 1),
                level.gap > 0. ? ", gap " + scientific_above(level.gap, 1) : "",
                record.has_details() ?
                  ", " + fixed_point(level.seconds, 2) + " s" :
                  "");
  }



  template <int dim>
  void
  report_cost(const RunResult<dim> &result,
              const double          peak_memory,
              Record               &record)
  {
    // Times and memory differ from run to run. They are always in the summary,
    // and in the log only with details.
    const auto log = [&record](const std::string &label, const double seconds) {
      if (record.has_details())
        record.line(label, fixed_point(seconds, 4));
    };
    if (record.has_details())
      record.heading("Wall time in s");
    const auto &solve_parts = result.solution.parts;
    for (const auto &[part, seconds] : result.times)
      {
        record.add("/timings_s/" + part, seconds);
        log(part, seconds);
        // Parts of the solve are indented below it; they need not add up to it.
        if (part == "solve")
          for (const auto &[name, seconds_of_it] : solve_parts)
            log("  " + name, seconds_of_it);
      }
    // The key is there in any case, as an empty object if the method has no
    // parts. The estimate is the one by which the linear solver was chosen, and
    // the peak the largest of all ranks.
    record.add("/timings_s/solve_parts",
               solve_parts.empty() ? Record::Json::object() :
                                     Record::Json(solve_parts));
    record.add({{"memory_estimate_bytes", result.choice.memory},
                {"peak_memory_bytes", peak_memory}});
    if (record.has_details())
      {
        record.heading("Memory in MB");
        record.line("peak",
                    fixed_point(peak_memory / 1e6, 0),
                    ", estimated ",
                    fixed_point(result.choice.memory / 1e6, 0));
      }
  }



  void
  report_files(const std::vector<std::string> &files, Record &record)
  {
    // Paths depend on where the program is run.
    if (!record.has_details())
      return;
    record.heading("Written");
    for (const std::string &file : files)
      record.heading("  " + file);
  }



  DEBOND_INSTANTIATE(report_sizes);
  DEBOND_INSTANTIATE(report_problem);
  DEBOND_INSTANTIATE(report_cost);
} // namespace Debond
