// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/solve/minimum/refine_result.h>

namespace Debond
{
  template <int dim>
  RefinedResult
  refine_result(const Scene<dim>   &scene,
                CorrectionSolver   &solver,
                const Interruption &interruption,
                Solution           &result)
  {
    // On very slender bodies rounding in double precision keeps a solver from
    // its end. The point at which it has stopped is near enough to the minimum
    // for extended precision to continue from there.
    const bool has_failed = result.status == SolverStatus::quadratic_program ||
                            result.status == SolverStatus::no_descent;
    if (!can_be_verified(result.status) && !has_failed)
      return {};
    const dealii::Timer   timer;
    const Eigen::VectorXd before =
      scene.problem().unknowns().contact().trace(result.u);
    // This replaces u only if the refinement converges.
    const Refined refined = refine_where_needed(
      scene, scene.adhesion(), 1., solver, interruption, result.u);
    result.is_refined       = refined.is_refined;
    const std::string &note = refined.note;
    if (!note.empty())
      result.notes.push_back(note);
    if (has_failed && refined.is_refined)
      {
        result.status = SolverStatus::success;
        result.message.clear();
        result.notes.push_back(
          "rounding in double precision kept the linear solver from its "
          "tolerance; the result is that of the refinement in extended "
          "precision from where it ended.");
      }
    const Eigen::VectorXd after =
      scene.problem().unknowns().contact().trace(result.u);
    // If the second derivative of Phi has changed by more than rounding, bonds
    // have come to other pieces of the law. Then what was said about the kind
    // of minimum was about another state.
    const auto curvature = [&](const Eigen::VectorXd &s) {
      return scene.adhesion().second_derivative(s);
    };
    result.parts["refinement"] = timer.wall_time();
    return {!note.empty(),
            after.size() > 0 &&
              (has_failed ||
               (curvature(after) - curvature(before)).norm() >
                 Tolerance::same_curvature * curvature(after).norm())};
  }



  DEBOND_INSTANTIATE(refine_result);
} // namespace Debond
