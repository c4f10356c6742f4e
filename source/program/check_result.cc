// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/append.h>
#include <debond/base/instantiate.h>
#include <debond/input/bad_input.h>
#include <debond/program/check_result.h>

namespace Debond
{
  namespace
  {
    /// Beyond it an estimate tells little but that the mesh is too coarse.
    constexpr double largest_mesh_error = 0.2;

    /// Larger factors of an estimate that two meshes alone have measured are
    /// wrong more often than right, see doc/notes/accuracy.md.
    constexpr double reliable_factor = 1.5;



    template <int dim>
    std::optional<DisplacementError>
    error_of(const std::string &exact_displacement,
             const Scene<dim>  &scene,
             const DofVector   &u)
    {
      // An expression may be finite at some points and not at others. What is
      // thrown at a quadrature point of the mesh names the entry, since the
      // scene is to be corrected there.
      if (exact_displacement.empty())
        return {};
      try
        {
          return displacement_error(
            scene.problem(),
            u,
            *make_function<dim>(exact_displacement,
                                scene.parameters().loads.constants));
        }
      catch (const std::invalid_argument &error)
        {
          throw BadInput(
            {scene.parameters().scene +
             ": Verification/Exact displacement: " + error.what()});
        }
    }



    /// Returns what the verification has against the result, or against the
    /// first step of a load path that it has something against; empty if
    /// nothing.
    template <int dim>
    std::string
    verification_message(const double tolerance, const RunResult<dim> &result)
    {
      // Of a load path the first step with a message counts, since all later
      // steps started from it. Comparisons are written so that NaN fails them.
      // The argument of failure() says whether a smaller stop tolerance can
      // help, which the message then recommends: only if the method iterates.
      for (const LoadPathStep<dim> &step : result.path.steps)
        if (!step.message.empty())
          return step.message;
      if (!(result.verification.error() <= tolerance))
        return result.verification.failure(
          tolerance,
          result.solution.linear_iterations > 0 ||
            !result.solution.bundle_history.empty());
      // The paper's stop tolerance is an energy that the user has chosen. If it
      // is too large for the scene, v_k shows how much J may still fall.
      if (const std::optional<double> &descent =
            result.solution.relative_descent;
          descent && !(*descent <= Tolerance::descent))
        {
          std::ostringstream text;
          text.precision(3);
          text << "verification: the predicted descent v_k is " << *descent
               << " of the strain energy, required is at most "
               << Tolerance::descent << ". Try a smaller stop tolerance.";
          return text.str();
        }
      return "";
    }



    /// Sets status and message of the result by what solver, verification and
    /// refinement say of it.
    template <int dim>
    void
    judge(const std::string &failure, RunResult<dim> &result)
    {
      Solution          &solve     = result.solution;
      const std::string &shortfall = result.meshes.shortfall;
      // A solver that stopped at rounding cannot tell what its point is worth,
      // but the verification can, from forces of stresses that share nothing
      // with the solver.
      if (solve.status == SolverStatus::stagnated && failure.empty())
        {
          solve.status = SolverStatus::success;
          result.notes.push_back(solve.message);
          solve.message.clear();
        }
      else if (solve.status == SolverStatus::stagnated)
        solve.message += " " + failure;

      result.status  = to_string(solve.status);
      result.message = solve.message;
      // The solver is content, but its result is not what it says.
      if (result.is_answer() && !failure.empty())
        {
          result.status  = "not verified";
          result.message = failure;
        }
      else if (solve.status == SolverStatus::success && !shortfall.empty())
        {
          result.status  = "not accurate enough";
          result.message = shortfall;
        }
    }



    /// Returns whether nodes of the contact boundary have other normals than
    /// their sides.
    template <int dim>
    bool
    is_curved(const ContactBoundary<dim> &boundary)
    {
      for (const auto &face : boundary.faces)
        for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
          if (!face.is_held(k) &&
              (boundary.nodes[face.node(k)].normal - face.normal).norm() >
                Tolerance::same_normal)
            return true;
      return false;
    }



    /// Returns whether anything acts on the body. Bonds that reach over a gap
    /// are a load as well, if they move the body by more than the rounding of
    /// the gap.
    template <int dim>
    bool
    has_load(const Scene<dim> &scene, const double largest_displacement)
    {
      // Without a load the body stays at rest and its displacement is zero but
      // for rounding. Neither an estimate nor an error relative to J means
      // anything then.
      const ElasticProblem<dim> &problem = scene.problem();
      const double               largest_force =
        problem.fields().applied_nodal_forces().linfty_norm();
      return problem.unknowns().has_prescribed_displacements() ||
             largest_force > 0. ||
             (problem.unknowns().has_gap() &&
              largest_displacement >
                std::numeric_limits<double>::epsilon() *
                  problem.unknowns().lifting().linfty_norm());
    }



    /// Estimates the error of the mesh, with bonds as the load path has left
    /// them.
    template <int dim>
    void
    estimate(RunResult<dim> &result)
    {
      // The estimate evaluates loads and bonds at points of the faces at which
      // the solution did not need them. An expression without a value there
      // takes away the estimate and not the result, therefore it becomes a
      // note.
      const Scene<dim> &scene = *result.scene;
      try
        {
          result.estimate =
            estimate_error(scene.estimated(result.bonds()),
                           result.solution.u,
                           result.solution.functional,
                           result.solution.load_factor,
                           result.meshes.levels.empty() ?
                             std::nullopt :
                             result.meshes.levels.back().error_factor);
          if (result.estimate->relative() > largest_mesh_error)
            result.notes.push_back(
              "the mesh is too coarse for J: see error of the mesh");
          const double factor = result.estimate->factor.value_or(1.);
          // If the mesh before has no factor, that of the last mesh is the
          // first one that was measured, by two meshes alone.
          if (factor > reliable_factor &&
              !result.meshes.levels.rbegin()[1].error_factor)
            {
              std::ostringstream note;
              note << "two meshes alone have measured the error, so that it "
                      "may be up to "
                   << std::setprecision(2) << factor
                   << " times too high: a third mesh, by a larger "
                      "Accuracy/Maximum unknowns, tells more";
              result.notes.push_back(note.str());
            }
          // On a single mesh with linear displacements all contact nodes are
          // vertices of the first mesh. Refinement and quadratic displacements
          // add nodes on the flat sides, which have the normals of these.
          if ((result.meshes.levels.size() > 1 ||
               scene.problem().unknowns().degree() == 2) &&
              is_curved(scene.contact_boundary()))
            result.notes.push_back(
              "the contact boundary is curved: vertices of the first mesh have "
              "the mean normal of their sides, other nodes that of their side. "
              "What that changes in J is no part of what residuals tell; it "
              "falls with the square of the sides' length");
        }
      catch (const std::invalid_argument &error)
        {
          result.notes.push_back(
            std::string(
              "the error of the mesh is not known: a load or a bond "
              "is none between the points that the solution needs, ") +
            error.what());
        }
    }



    /// Looks for a rigid motion that shows that a body detaches. Returns what
    /// is wrong if there is none.
    template <int dim>
    std::string
    check_coming_off(RunResult<dim> &result)
    {
      const Scene<dim> &scene = *result.scene;
      if (result.solution.status != SolverStatus::comes_off)
        return "";
      // The solver's word alone does not count: a rigid motion away from the
      // foundation along which the loads do work is the proof that J has no
      // minimum.
      result.coming_off =
        coming_off(scene.problem(),
                   scene.adhesion(),
                   result.solution.comes_off_at.value_or(1.).loads);
      return result.coming_off ?
               "" :
               "the solver says that the body comes off, but no rigid motion "
               "away from the foundation is found along which the loads do more "
               "work than rounding. Hold the body by a support, or change the "
               "loads.";
    }



    /// What is odd in a scene that has been solved.
    template <int dim>
    void
    add_notes(const bool is_loaded, RunResult<dim> &result)
    {
      // These notes tell of scenes that are solved as they are, but hardly mean
      // what their author wanted. They are no errors, because each of them can
      // be intended.
      const Scene<dim> &scene = *result.scene;
      if (!is_loaded)
        result.notes.push_back("the scene has no load");
      else if (scene.problem()
                   .fields()
                   .applied_nodal_forces(result.solution.load_factor)
                   .linfty_norm() > 0. &&
               scene.problem()
                   .load(result.solution.load_factor)
                   .linfty_norm() == 0.)
        result.notes.push_back(
          "all loads act where the body cannot move: on supports, or along a "
          "contact boundary with Contact law/Tangential displacement = fixed");
      if (scene.parameters().law.name != "none")
        append(bond_notes(
                 scene.problem().unknowns().dof_handler().get_triangulation(),
                 result.verification.nodes),
               result.notes);
      append(sliding_notes(result.bonds(),
                           result.verification,
                           scene.body().has_interfaces(),
                           scene.supports().normals.empty() &&
                             is_curved(scene.contact_boundary())),
             result.notes);
      // The mesh has to be fine enough for the front in each step, so that the
      // largest size of a path counts.
      double cell_size_at_edge = 0.;
      for (const LoadPathStep<dim> &step : result.path.steps)
        cell_size_at_edge =
          std::max(cell_size_at_edge, step.state.cell_size_at_edge);
      append(plausibility_notes(result.largest,
                                faces_in_softening_zone(scene.problem(),
                                                        scene.adhesion()),
                                cell_size_at_edge),
             result.notes);
    }
  } // namespace



  template <int dim>
  void
  check_result(const VerificationParameters   &verification,
               const std::vector<std::string> &notes,
               RunResult<dim>                 &result)
  {
    // The notes come from the method, from the search and the proof, from the
    // reading of the scene and from its making, in this order; those of the
    // functions below follow.
    const Scene<dim>  &scene     = *result.scene;
    const std::string &shortfall = result.meshes.shortfall;
    result.notes                 = result.solution.notes;
    append(result.solution.minimum.notes, result.notes);
    append(notes, result.notes);
    append(scene.notes(), result.notes);
    const std::string not_off = check_coming_off(result);
    // A body that detaches at once has no displacement that could be verified.
    // On a load path the steps before it have one, and what follows is about
    // the last of them.
    if (result.solution.status == SolverStatus::comes_off &&
        result.path.steps.empty())
      {
        judge(not_off, result);
        return;
      }

    if (result.solution.status == SolverStatus::quadratic_program &&
        !scene.problem().unknowns().is_held_by_supports())
      result.solution.message +=
        " Only its contact holds the body: where the bonds are softer than "
        "1e-12 of it, rounding decides. Try stiffer bonds or a support.";

    dealii::Timer timer;
    result.verification        = verify(scene.problem(),
                                 result.bonds(),
                                 result.solution.u,
                                 result.solution.load_factor,
                                 scene.least_force());
    result.verification.breaks = result.path.breaks;
    const auto values          = [&](const Probes<dim> &probes) {
      return probes.values(scene.problem(),
                           result.solution.u,
                           result.solution.load_factor);
    };
    result.probes  = values(scene.probes());
    result.means   = values(scene.means());
    result.largest = largest_values(scene.problem(),
                                    result.solution.u,
                                    result.solution.load_factor);
    result.times.emplace_back("verification", timer.wall_time());
    judge(not_off.empty() ?
            verification_message(verification.tolerance, result) :
            not_off,
          result);

    const bool is_loaded = has_load(scene, result.largest.displacement);

    // An estimate is worth its time for a solution only. One that is not
    // accurate enough is one, and so is that of the mesh before a loop was
    // interrupted.
    const bool is_solution =
      result.is_success() || !shortfall.empty() ||
      (result.solution.status == SolverStatus::interrupted &&
       !result.meshes.levels.empty());
    // At rest all of u is rounding, of which there is no error.
    if (is_solution && is_loaded)
      {
        timer.restart();
        estimate(result);
        result.times.emplace_back("error estimate", timer.wall_time());
      }

    add_notes(is_loaded, result);
    result.displacement_error =
      error_of(verification.exact_displacement, scene, result.solution.u);
  }



  template <int dim>
  void
  check_exact_displacement(const std::string &exact_displacement,
                           const Scene<dim>  &scene)
  {
    // The error is computed for the displacement 0 and thrown away. This
    // evaluates the expression at the same points as after the solve.
    error_of(exact_displacement,
             scene,
             DofVector(scene.problem().unknowns().n_dofs()));
  }



  DEBOND_INSTANTIATE(check_exact_displacement);
  DEBOND_INSTANTIATE(check_result);
} // namespace Debond
