// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/output/report.h>

namespace Debond
{
  namespace
  {
    using Json = Record::Json;



    /// The next of the bounds 1e-9, 1e-6, ... above a small error: the same on
    /// all machines unless the error is close to one of them.
    std::string
    bound(const double error)
    {
      if (!std::isfinite(error))
        return "not finite";
      double upper = 1e-9;
      while (error >= upper)
        upper *= 1000.;
      return "below " + scientific(upper, 0);
    }



    /// Adds the components of a vector to summary.json at @p pointer and
    /// returns them as the log has them, each one printed behind the
    /// manipulators @p format.
    template <int n, typename... Format>
    std::string
    add_vector(const std::string          &pointer,
               const dealii::Tensor<1, n> &vector,
               Record                     &record,
               const Format &...format)
    {
      // The summary has the numbers with all digits whatever the format of the
      // log is.
      const std::vector<double> numbers(vector.begin_raw(), vector.end_raw());
      std::vector<std::string>  texts;
      for (const double number : numbers)
        texts.push_back(words(format..., number));
      record.add(pointer, numbers);
      return "(" + join(texts, ", ") + ")";
    }



    /// Reports a resultant or a displacement, in the log if it has a label.
    template <int dim>
    void
    report_vector(const std::string            &pointer,
                  const std::string            &label,
                  const dealii::Tensor<1, dim> &vector,
                  Record                       &record)
    {
      const std::string text =
        add_vector(pointer, vector, record, std::scientific);
      if (!label.empty())
        record.line(label, text);
    }



    template <int dim>
    void
    report_status(const RunResult<dim> &result, Record &record)
    {
      // The status is a word that scripts compare. The message says why there
      // is no success; notes do not decide on the status. J is that of the last
      // mesh and of the last factor of a path, and NaN, in the summary null, if
      // the body detaches at once.
      const Solution &solve = result.solution;
      record.heading(result.path.steps.empty() ?
                       "Result" :
                       "Result at the last load factor");
      record.add({{"status", result.status},
                  {"message", result.message},
                  {"notes", result.notes},
                  {"functional", solve.functional}});
      record.line(
        "status", result.is_answer() ? "" : "NOT CONVERGED: ", result.status);
      if (!result.is_success())
        record.line("", result.message);
      for (const std::string &note : result.notes)
        record.line("note", note);
      if (result.has_displacement())
        record.line("J", scientific(solve.functional, 10));
      // The key is there if a search or a proof could have found a lower state,
      // so that a study sees whether one was looked for. The line is for a
      // state that was replaced; the last row of history.csv then belongs to
      // the lower one.
      if (solve.functional_from_start)
        record.add("/functional_from_start", *solve.functional_from_start);
      if (solve.is_replaced)
        record.line(
          "J from start",
          scientific(*solve.functional_from_start, 10),
          ", of the state where the method ended; the lower one above was "
          "found beside it");
    }



    template <int dim>
    void
    report_coming_off(const ComingOff<dim> &off, Record &record)
    {
      // The motion is scaled so that the largest opening is 1, and the work of
      // the loads is for that. In 2D the rotation is one number. What goes
      // towards the foundation is rounding, and shows how far the motion can be
      // trusted.
      const auto add = [&](const std::string &name, const auto &vector) {
        return add_vector("/comes_off/" + name,
                          vector,
                          record,
                          std::setprecision(3));
      };
      const std::string centre = add("centre", off.motion.centre);
      const std::string translation =
        add("translation", off.motion.translation);
      const std::string rotation = add("rotation", off.motion.rotation);
      record.add("/comes_off",
                 {{"work", off.work},
                  {"towards_foundation", off.towards_foundation}});
      record.line("comes off by",
                  "translation ",
                  translation,
                  " of ",
                  centre,
                  " and rotation ",
                  rotation,
                  " for a largest opening of 1");
      record.line("work of the loads",
                  std::setprecision(3),
                  off.work,
                  " for that");
    }



    void
    report_estimate(const ErrorEstimate &estimate, Record &record)
    {
      // The error is relative. If J is near zero, what it is relative to would
      // say nothing, and the energy of the stresses takes its place; the second
      // key says which. The factor is null for a single mesh, of which nobody
      // knows how much more than the residuals say a finer one would gain.
      record.add(
        {{"estimated_error", estimate.relative()},
         {"estimated_error_of", estimate.is_of_J ? "J" : "stress energy"},
         {"error_factor", Record::json_of(estimate.factor)}});
      record.line("error of the mesh",
                  "about ",
                  scientific(estimate.relative(), 1),
                  estimate.is_of_J ?
                    " of J" :
                    " of the energy of the stresses, as J is near zero",
                  estimate.factor ?
                    " (" + fixed_point(*estimate.factor, 1) +
                      " times the residual estimate, as J fell from mesh "
                      "to mesh)" :
                    ", not checked by a finer mesh");
    }



    /// @p n_nodes: all contact nodes.
    void
    report_minimum(const WhichMinimum &minimum,
                   const bool          is_success,
                   const unsigned int  n_nodes,
                   Record             &record)
    {
      // The kind of the minimum is a statement about the result and is empty
      // without a success. The numbers of a search are there all the same: its
      // trials, those that found a lower state, and those without a result. It
      // may have been on a coarser mesh, whose contact nodes are fewer than
      // n_nodes.
      const bool        details = record.has_details();
      const std::string kind    = is_success ? to_string(minimum.kind) : "";
      record.add("/minimum",
                 {{"state", kind},
                  {"search_trials", minimum.search_trials},
                  {"search_improvements", minimum.search_improvements},
                  {"search_failures", minimum.search_failures},
                  {"search_nodes", minimum.search_nodes}});
      if (is_success)
        {
          std::string text = kind;
          if (details && minimum.search_trials > 0)
            text +=
              words(", ", minimum.search_trials, " states searched") +
              (minimum.search_nodes < n_nodes ?
                 words(" on ", minimum.search_nodes, " of the contact nodes") :
                 "");
          if (minimum.search_failures > 0)
            text += words(", ",
                          minimum.search_failures,
                          " of them led to no minimum");
          record.line("minimum", text);
        }

      if (!minimum.proof_attempted)
        return;
      // In the log the figures of a proof are rounded to the safe side: the
      // lower bound is not above its value and the gap not below. The gap is
      // relative to what the bonds can change in J, not to J.
      const std::string status = to_string(minimum.proof_status);
      record.add("/proof",
                 {{"status", status},
                  {"nodes", minimum.proof_nodes},
                  {"lower_bound", minimum.lower_bound},
                  {"relative_gap", minimum.relative_gap}});
      record.line("proof",
                  status,
                  details ? words(" after ",
                                  minimum.proof_nodes,
                                  " nodes, gap ",
                                  scientific_above(minimum.relative_gap, 1),
                                  " of what the bonds can change in J, J >= ",
                                  scientific_below(minimum.lower_bound, 10)) :
                            "");
    }



    void
    report_iterations(const Solution    &result,
                      const SolverMethod method,
                      Record            &record)
    {
      // A load path has many histories, which are added up.
      const bool is_bundle = method != SolverMethod::majorise_minimise &&
                             result.majorise_history.empty();
      // Long, short and null steps are those of bundle methods and zero for the
      // others. The criterion is v_k of a bundle method, which is negative, or
      // the relative residual of majorise-minimise. It is that of the method,
      // before a refinement in extended precision; of such a refinement only
      // the fact is known here. What a method does not have is null or 0.
      record.add("/iterations",
                 {{"total", result.iterations},
                  {"long", result.long_steps},
                  {"short", result.short_steps},
                  {"null", result.null_steps}});
      record.add(
        {{"stop_criterion", result.criterion},
         {"relative_descent", Record::json_of(result.relative_descent)},
         {"refined", result.is_refined},
         {"largest_qp_residual", result.largest_qp_residual},
         {"linear_iterations", result.linear_iterations},
         {"condition_estimate", Record::json_of(result.condition_estimate)}});
      if (!record.has_details())
        return;
      record.line("iterations",
                  result.iterations,
                  is_bundle ? words(" (long ",
                                    result.long_steps,
                                    ", short ",
                                    result.short_steps,
                                    ", null ",
                                    result.null_steps,
                                    ")") :
                              "");
      record.line(is_bundle ? "last v_k" : "optimality residual",
                  scientific(result.criterion, 3),
                  result.relative_descent ?
                    ", " + scientific(*result.relative_descent, 1) +
                      " of the strain energy" :
                    "",
                  result.is_refined ?
                    ", before the refinement in extended precision" :
                    "");
    }



    template <int dim>
    void
    report_state(const Verification<dim> &verification,
                 const LargestValues     &largest,
                 Record                  &record)
    {
      // Each state that the law has is a key, with 0 if no node is in it, so
      // that studies find all of them. Held vertices are no contact nodes and
      // have no number. The log names the states that occur.
      Json                     states = Json::object();
      std::vector<std::string> texts;
      for (unsigned int k = 0; k < verification.state_names.size(); ++k)
        {
          const BondState    state = state_at(k);
          const unsigned int count = verification.count(state);
          if (state != BondState::held)
            states[verification.name(state)] = count;
          if (count > 0)
            texts.push_back(words(verification.name(state), " ", count));
        }
      // Lengths and areas are in units of the scene. The opening is positive;
      // the broken zone is a part of the contact boundary by its length or
      // area, interpolated between the nodes, and not a number of nodes.
      record.add({{"bond_states", states},
                  {"largest_opening", verification.largest_opening},
                  {"broken_zone", verification.broken_zone},
                  {"without_bonds", verification.without_bonds},
                  {"largest_displacement", largest.displacement},
                  {"largest_displacement_gradient", largest.gradient},
                  {"largest_von_mises", largest.von_mises}});
      // With bonds that break separately a state is that along the normal.
      // Nodes whose bonds are broken in shear are counted besides.
      if (const auto n = std::count_if(verification.nodes.begin(),
                                       verification.nodes.end(),
                                       [](const ContactNodeState &node) {
                                         return node.shear_damage == 1.;
                                       });
          n > 0)
        texts.push_back(words("in shear broken ", n));
      record.line("contact nodes",
                  texts.empty() ? "all held" : join(texts, ", "));
      if (verification.has_friction)
        {
          const auto slides = [&](const bool wanted) {
            return std::count_if(verification.nodes.begin(),
                                 verification.nodes.end(),
                                 [wanted](const ContactNodeState &node) {
                                   return node.slides == wanted;
                                 });
          };
          record.line(
            "friction", "sticks ", slides(false), ", slides ", slides(true));
          record.add({{"friction",
                       {{"sticks", slides(false)}, {"slides", slides(true)}}}});
        }
      record.line("opening",
                  "largest ",
                  scientific(verification.largest_opening, 3),
                  ", broken zone ",
                  scientific(verification.broken_zone, 3));
      record.line("largest",
                  "displacement ",
                  scientific(largest.displacement, 3),
                  ", its gradient ",
                  scientific(largest.gradient, 1),
                  ", von Mises stress ",
                  scientific(largest.von_mises, 3));
    }



    /// Reports what the scene wants to know, and the means over all named
    /// pieces.
    template <int dim>
    void
    report_probes(const RunResult<dim> &result, Record &record)
    {
      // The objects are there even if they are empty, so that a script need not
      // ask. Probes are in the log, which the scene has asked for; means over
      // all pieces with a name would be too many lines.
      record.add("/probes", Json::object());
      for (const auto &[name, vector] : result.probes)
        report_vector("/probes/" + name, "probe " + name, vector, record);
      record.add("/mean_displacements", Json::object());
      for (const auto &[name, vector] : result.means)
        report_vector("/mean_displacements/" + name, "", vector, record);
      if (!result.path.steps.empty())
        record.add("/dissipated_energy",
                   result.path.steps.back().state.dissipated_energy);
    }



    template <int dim>
    void
    report_verification(const ProblemParameters &problem,
                        const bool               has_interfaces,
                        const RunResult<dim>    &result,
                        Record                  &record)
    {
      const bool               details      = record.has_details();
      const Verification<dim> &verification = result.verification;
      const auto               error        = [details](const double value) {
        return details ? scientific(value, 2) : bound(value);
      };
      // Errors are numbers without a unit, each of them relative to what its
      // line says; the penetration is a length, the largest normal displacement
      // beyond the gap. Without details errors are only bounded, as their
      // digits are rounding and differ between machines.
      record.heading("Verification, from A u - f");
      record.add({{"law_violation", verification.law_violation},
                  {"penetration", verification.penetration},
                  {"equilibrium_residual", verification.equilibrium_residual},
                  {"force_imbalance", verification.force_imbalance}});
      record.line("law violation",
                  error(verification.law_violation),
                  problem.law.name == "none" ?
                    ", relative to the contact forces" :
                    ", relative to what bonds bear and to the contact forces");
      record.line("penetration", scientific(verification.penetration, 2));
      record.line("residual",
                  error(verification.equilibrium_residual),
                  ", relative to the reactions");
      record.line("force imbalance",
                  error(verification.force_imbalance),
                  ", relative to the forces");

      if (const auto &distance = result.displacement_error; distance)
        {
          record.add("/displacement_error",
                     {{"l2", distance->l2},
                      {"h1", distance->h1},
                      {"energy_norm", distance->energy_norm},
                      {"exact_energy", distance->exact_energy}});
          record.line("displacement error",
                      scientific(distance->l2, 2),
                      " in L2, ",
                      scientific(distance->h1, 2),
                      " in H1, ",
                      scientific(distance->energy_norm, 2),
                      " in the energy norm, relative to the exact one");
        }

      // Forces have the components x, y and z, in 2D per thickness, and act on
      // the body. They are in the summary in any case. The log without details
      // has the applied force alone, which follows from the scene.
      const auto report = [&](const std::string            &name,
                              const std::string            &label,
                              const dealii::Tensor<1, dim> &force,
                              const bool                    is_logged) {
        report_vector("/" + name, is_logged ? label : "", force, record);
      };
      report("applied_force",
             "applied force",
             verification.applied_force,
             true);
      report("clamped_reaction",
             "force of supports",
             verification.clamped_reaction,
             details);
      record.add("/reactions", Json::object());
      for (const auto &[name, force] : verification.reactions)
        report("reactions/" + name, "  of " + name, force, details);
      report("contact_reaction",
             has_interfaces ? "force between bodies" : "force of foundation",
             verification.contact_reaction,
             details);
      report("tangential_reaction",
             "  tangential part",
             verification.tangential_reaction,
             // A body that may slide has no force along the boundary.
             details && (problem.tangential_displacement !=
                           TangentialDisplacement::free ||
                         !problem.tangential_displacements.empty() ||
                         problem.friction.is_somewhere()));
    }



    void
    report_change(const std::string               &name,
                  const std::string               &label,
                  const bool                       has_bonds,
                  const std::optional<BondChange> &change,
                  const LoadPathParameters        &load_path,
                  Record                          &record)
    {
      // The key is null if the broken part never grew or shrank, and a step
      // otherwise: the factors with which the step was solved, and the broken
      // part before and after. Without bonds what is open counts as broken,
      // which the words of the log take into account.
      const std::string pointer = "/load_path/" + name;
      if (!change)
        {
          record.add(pointer, nullptr);
          return;
        }
      record.add(pointer,
                 {{"step", change->step},
                  {"factor", change->factor},
                  {"displacement_factor", change->displacement_factor},
                  {"broken_before", change->broken_before},
                  {"broken_after", change->broken_after}});
      record.line(label,
                  "at ",
                  load_path.name({change->factor, change->displacement_factor}),
                  ", step ",
                  change->step,
                  has_bonds ? ", broken part " : ", open part ",
                  change->broken_before,
                  " to ",
                  change->broken_after);
    }



    /// The curve of stationary states and the longest way on which its factor
    /// goes back.
    template <int dim>
    void
    report_arc(const std::vector<LoadPathStep<dim>> &arc,
               const LoadPathParameters             &load_path,
               Record                               &record)
    {
      if (!load_path.arc || arc.size() < 2)
        {
          record.add("/load_path/arc", nullptr);
          return;
        }
      // The curve is followed in the direction of its first step, which sign
      // makes the positive one. `start` is the state after the last step in
      // which the factor advanced; the states behind it belong to a way back.
      // The longest such way is kept in `from` and `to`.
      const auto factor = [&](const std::size_t k) {
        return load_path.varying(arc[k].factors());
      };
      const double sign     = factor(1) >= factor(0) ? 1. : -1.;
      std::size_t  unstable = 0, start = 0, from = 0, to = 0;
      for (std::size_t k = 1; k < arc.size(); ++k)
        {
          unstable += arc[k].status == "unstable" ? 1 : 0;
          if (sign * (factor(k) - factor(k - 1)) > 0.)
            start = k;
          else if (sign * (factor(start) - factor(k)) >
                   sign * (factor(from) - factor(to)))
            {
              from = start;
              to   = k;
            }
        }
      const bool goes_back = from != to;
      record.add("/load_path/arc",
                 {{"states", arc.size()},
                  {"unstable", unstable},
                  {"back_from", goes_back ? Json(factor(from)) : Json()},
                  {"back_to", goes_back ? Json(factor(to)) : Json()}});
      record.line("arc",
                  arc.size(),
                  " states, ",
                  unstable,
                  " unstable",
                  goes_back ?
                    words(", the longest way back from ",
                          load_path.moves_only() ? "displacement factor " :
                                                   "factor ",
                          std::setprecision(10),
                          factor(from),
                          " to ",
                          factor(to)) :
                    "");
    }



    /// The steps at which most bonds break and close, and how far the path is
    /// from the global branch.
    void
    report_totals(const LoadPathTotals             &path,
                  const bool                        has_bonds,
                  const std::optional<LoadFactors> &comes_off_at,
                  const LoadPathParameters         &load_path,
                  Record                           &record)
    {
      // Steps are fewer than factors if the path has ended early. The factor
      // named is the one that varies: of the loads, or of the prescribed
      // displacements if only these do. That at which the body detaches is null
      // if it does not.
      record.heading("Load path");
      record.add("/load_path",
                 {{"factors", path.factors},
                  {"steps", path.steps},
                  {"last_factor", load_path.varying(path.last)},
                  {"comes_off_at",
                   comes_off_at ? Json(load_path.varying(*comes_off_at)) :
                                  Json()}});
      record.line("factors",
                  path.steps,
                  " of ",
                  path.factors,
                  ", to ",
                  load_path.name(path.last));
      if (comes_off_at)
        record.line("comes off", "at ", load_path.name(*comes_off_at));
      report_change("largest_break",
                    has_bonds ? "most bonds break" : "most nodes open",
                    has_bonds,
                    path.largest_break,
                    load_path,
                    record);
      // Of bonds that are broken for good only the gap closes.
      const bool bonds_close = has_bonds && load_path.bonds_heal;
      report_change("largest_closing",
                    bonds_close ? "most bonds close" : "most nodes close",
                    bonds_close,
                    path.largest_closing,
                    load_path,
                    record);

      // The numbers say at how many factors a global branch was computed, at
      // how many of these the path is above it by more than rounding, and by
      // how much of |J| at most.
      record.add("/load_path",
                 {{"compared_with_global_branch", path.compared},
                  {"above_global_branch", path.above_global},
                  {"largest_excess", path.largest_excess}});
      if (path.compared > 0)
        record.line(
          load_path.bonds_heal ? "above global branch" : "above energetic path",
          "at ",
          path.above_global,
          " of ",
          path.compared,
          " factors",
          path.above_global > 0 ?
            words(", by ", 100. * path.largest_excess, " % of |J| at most") :
            "");
    }



    /// The largest force of the path and the reactions there; null without one.
    template <int dim>
    void
    report_peak(const PathProgress<dim> &path,
                const bool               comes_off,
                Record                  &record)
    {
      const std::optional<LoadPathPeak<dim>> &peak = path.peak;
      if (!peak || peak->force() == 0.)
        {
          record.add("/load_path/peak", nullptr);
          return;
        }
      const LoadPathState<dim> &state = peak->step.state;
      std::optional<double>     known_to;
      if (peak->bound)
        known_to = *peak->bound / peak->force() - 1.;
      // Where the path ends with its largest force, that of the joint may be
      // larger. What comes off has none beyond.
      const bool is_at_end =
        !comes_off && peak->step.factors() == path.steps.back().factors();
      // The work of the supports for a unit of the factor is their force if
      // they prescribe a displacement of 1 at the factor 1.
      record.add("/load_path/peak",
                 {{"unit_displacement_work", state.unit_displacement_work},
                  {"factor", peak->step.factor},
                  {"displacement_factor", peak->step.displacement_factor},
                  {"known_to", Record::json_of(known_to)},
                  {"at_end", is_at_end},
                  {"reactions", Json::object()}});
      record.line(
        "largest force",
        scientific(state.unit_displacement_work, 4),
        " as work for a unit of the displacement factor, at ",
        peak->step.displacement_factor,
        known_to ?
          words(", known to ", std::setprecision(2), 100. * *known_to, " %") :
          ", of the states that were found",
        is_at_end ? ", where the path ends: beyond, it may be larger" : "");
      const std::string prefix = "reaction_";
      for (const auto &[name, force] : state.vectors)
        if (name.rfind(prefix, 0) == 0)
          {
            const std::string support = name.substr(prefix.size());
            report_vector("/load_path/peak/reactions/" + support,
                          "  of " + support,
                          force,
                          record);
          }
    }



    /// Reports what became of the factors of a load path, and its curve of
    /// stationary states.
    template <int dim>
    void
    report_load_path(const LoadPathParameters &load_path,
                     const RunResult<dim>     &result,
                     Record                   &record)
    {
      // A law without adhesion, or a scene whose bonds are nowhere, has only
      // free nodes; then the words are about nodes that open and close. The
      // branch counts and not the state, which of a node in contact does not
      // say whether it has bonds.
      const std::vector<ContactNodeState> &nodes = result.verification.nodes;
      report_totals(load_path_totals(result.path.steps,
                                     static_cast<unsigned int>(
                                       load_path.factors.size())),
                    std::any_of(nodes.begin(),
                                nodes.end(),
                                [](const ContactNodeState &node) {
                                  return node.branch != BondState::free;
                                }),
                    result.solution.comes_off_at,
                    load_path,
                    record);
      report_peak(result.path,
                  result.solution.comes_off_at.has_value(),
                  record);
      report_arc(result.arc, load_path, record);

      // The mesh has to be fine enough for the worst step of the path.
      double size = 0.;
      for (const LoadPathStep<dim> &step : result.path.steps)
        size = std::max(size, step.state.cell_size_at_edge);
      record.add("/load_path/cell_size_at_edge", size);
    }
  } // namespace



  template <int dim>
  void
  report_result(const RunResult<dim> &result, Record &record)
  {
    // The load path comes first, as what follows is about its last factor. Next
    // is whether there is a result and how good it is, then what the result is,
    // and at the end its verification. A body that detaches at once has no
    // displacement, and neither states nor forces.
    const Scene<dim> &scene = *result.scene;
    if (!result.path.steps.empty())
      report_load_path(scene.parameters().load_path, result, record);
    // With refined meshes the sizes so far are those of the first one.
    report_sizes(result, record);
    report_status(result, record);
    if (result.coming_off)
      report_coming_off(*result.coming_off, record);
    if (result.estimate)
      report_estimate(*result.estimate, record);
    report_minimum(result.solution.minimum,
                   result.is_success(),
                   static_cast<unsigned int>(
                     scene.contact_boundary().nodes.size()),
                   record);
    report_iterations(result.solution, result.choice.method, record);
    if (!result.has_displacement())
      return;
    report_state(result.verification, result.largest, record);
    report_probes(result, record);
    report_verification(scene.parameters(),
                        scene.problem().unknowns().has_interfaces(),
                        result,
                        record);
  }



  DEBOND_INSTANTIATE(report_result);
} // namespace Debond
