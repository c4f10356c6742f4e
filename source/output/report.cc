// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/base/version.h>
#include <debond/output/report.h>
#include <debond/solve/method_choice.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace Debond
{
  namespace
  {
    constexpr int label_width = 22;



    std::ostream &
    line(std::ostream &out, const std::string &label)
    {
      return out << "  " << std::left << std::setw(label_width) << label
                 << std::right;
    }



    std::string
    scientific(const double value, const int digits)
    {
      std::ostringstream text;
      text << std::scientific << std::setprecision(digits) << value;
      return text.str();
    }



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



    template <int dim>
    std::string
    vector_text(const dealii::Tensor<1, dim> &vector)
    {
      std::string text = "(";
      for (unsigned int d = 0; d < dim; ++d)
        text += (d == 0 ? "" : ", ") + scientific(vector[d], 6);
      return text + ")";
    }



    void
    report_timings(const Summary &summary, std::ostream &out)
    {
      out << "Wall time in s\n" << std::fixed << std::setprecision(4);
      for (const std::string part :
           {"mesh", "assembly", "solve", "verification", "output", "total"})
        {
          const auto time = summary.timings_s.find(part);
          if (time == summary.timings_s.end())
            continue;
          line(out, part) << time->second << '\n';
          const std::string prefix = part + "/";
          for (const auto &[name, seconds] : summary.timings_s)
            if (name.compare(0, prefix.size(), prefix) == 0)
              line(out, "  " + name.substr(prefix.size())) << seconds << '\n';
        }
      out << std::defaultfloat;
    }
  } // namespace



  void
  report_problem(const Parameters  &parameters,
                 const Summary     &summary,
                 const std::string &reason,
                 std::ostream      &out)
  {
    const bool details = parameters.output.machine_details;

    out << "Debond " << program_version();
    if (details)
      out << ", revision " << summary.revision << ", deal.II "
          << summary.deal_ii_version << ", " << summary.build_type;
    out << "\nProblem\n";
    if (details)
      line(out, "scene") << parameters.scene << '\n';
    line(out, "mesh") << summary.cells
                      << (summary.dimension == 2 ? " triangles\n" :
                                                   " tetrahedra\n");
    line(out, "unknowns") << summary.degrees_of_freedom
                          << (parameters.tangential_displacement_fixed ?
                                ", with fixed tangential ones " +
                                  std::to_string(
                                    summary.degrees_of_freedom_paper) :
                                "")
                          << '\n';
    line(out, "material") << "E = " << parameters.material.young_modulus
                          << ", nu = " << parameters.material.poisson_ratio
                          << (summary.dimension == 3 ? "" :
                              parameters.material.hypothesis ==
                                  Material::Hypothesis::plane_stress ?
                                                       ", plane stress" :
                                                       ", plane strain")
                          << '\n';
    const auto list = [](const std::set<std::string> &names) {
      return join(std::vector<std::string>(names.begin(), names.end()), ", ");
    };
    line(out, "clamped") << list(parameters.clamped_boundaries) << '\n';
    if (!parameters.loads.body_force.empty())
      line(out, "body force") << parameters.loads.body_force << '\n';
    for (const auto &[side, traction] : parameters.loads.tractions)
      line(out, "traction " + side) << traction << '\n';
    line(out, "contact") << list(parameters.contact_boundaries) << ", "
                         << summary.contact_nodes << " nodes\n";
    line(out, "contact law") << parameters.law.name;
    if (!parameters.law.data.empty())
      out << ", " << parameters.law.data << ", " << parameters.quadrature_name
          << " quadrature";
    out << '\n';
    line(out, "method") << summary.method;
    if (summary.linear_solver != LinearSolver::none)
      out << ", " << summary.linear_solver << " linear solver";
    if (summary.method == SolverMethod::euclidean_bundle)
      out << ", u_k = " << parameters.bundle.u;
    if (!reason.empty())
      out << ", chosen since " << reason;
    out << '\n' << std::flush;
  }



  template <int dim>
  void
  report_result(const Parameters        &parameters,
                const Summary           &summary,
                const Verification<dim> &verification,
                std::ostream            &out)
  {
    const bool details = parameters.output.machine_details;
    const auto error   = [details](const double value) {
      return details ? scientific(value, 2) : bound(value);
    };

    if (summary.load_path)
      report_load_path(*summary.load_path, out);
    out << "Result" << (summary.load_path ? " at the last load factor" : "")
        << '\n';
    const bool success = summary.status == to_string(SolverStatus::success);
    line(out, "status") << (success ? "" : "NOT CONVERGED: ") << summary.status
                        << '\n';
    if (!success)
      line(out, "") << summary.message << '\n';
    for (const std::string &note : summary.notes)
      line(out, "note") << note << '\n';
    line(out, "J") << scientific(summary.functional, 10) << '\n';
    if (summary.is_replaced)
      line(out, "J from start")
        << scientific(*summary.functional_from_start, 10)
        << ", of the state that loading leads to; the lower one above was found"
           " beside it\n";
    if (!summary.minimum.empty())
      {
        line(out, "minimum") << summary.minimum;
        if (details && summary.search_trials > 0)
          out << ", " << summary.search_trials << " states searched"
              << (summary.search_nodes < summary.contact_nodes ?
                    " on " + std::to_string(summary.search_nodes) +
                      " of the contact nodes" :
                    "");
        if (details && summary.closed_nodes > 0)
          out << ", the minimum on " << summary.closed_nodes
              << " coarser ones leads here";
        if (summary.search_failures > 0)
          out << ", " << summary.search_failures
              << " of them led to no minimum";
        out << '\n';
      }
    if (!summary.proof.empty())
      {
        line(out, "proof") << summary.proof;
        if (details)
          out << " after " << summary.proof_nodes << " nodes, gap "
              << scientific(summary.relative_gap, 1)
              << " of what the bonds can change in J, J >= "
              << scientific(summary.lower_bound, 10);
        out << '\n';
      }
    if (details)
      {
        line(out, "iterations") << summary.total_iterations;
        if (summary.method == SolverMethod::majorise_minimise)
          out << "\n";
        else
          out << " (long " << summary.long_steps << ", short "
              << summary.short_steps << ", null " << summary.null_steps
              << ")\n";
        line(out,
             summary.method == SolverMethod::majorise_minimise ?
               "optimality residual" :
               "last v_k")
          << scientific(summary.stop_criterion, 3) << '\n';
      }

    std::string states;
    for (unsigned int k = 0; k < verification.state_names.size(); ++k)
      if (const unsigned int count =
            verification.count(static_cast<BondState>(k));
          count > 0)
        states += (states.empty() ? "" : ", ") + verification.state_names[k] +
                  " " + std::to_string(count);
    line(out, "contact nodes") << states << '\n';
    line(out, "largest") << "displacement "
                         << scientific(summary.largest.displacement, 3)
                         << ", its gradient "
                         << scientific(summary.largest.gradient, 1)
                         << ", von Mises stress "
                         << scientific(summary.largest.von_mises, 3) << '\n';

    out << "Verification, from A u - f\n";
    line(out, "law violation")
      << error(summary.law_violation)
      << (parameters.law.name == "none" ?
            ", relative to the contact forces\n" :
            ", relative to what bonds bear and to the contact forces\n");
    line(out, "penetration") << scientific(summary.penetration, 2) << '\n';
    line(out, "residual") << error(summary.equilibrium_residual)
                          << ", relative to the reactions\n";
    line(out, "force imbalance")
      << error(summary.force_imbalance) << ", relative to the forces\n";
    if (summary.displacement_error)
      line(out, "displacement error")
        << scientific(summary.displacement_error->l2, 2) << " in L2, "
        << scientific(summary.displacement_error->h1, 2) << " in H1, "
        << scientific(summary.displacement_error->energy_norm, 2)
        << " in the energy norm, relative to the exact one\n";
    line(out, "applied force")
      << vector_text<dim>(verification.applied_force) << '\n';
    if (details)
      {
        line(out, "force of clamps")
          << vector_text<dim>(verification.clamped_reaction) << '\n';
        line(out, "force of foundation")
          << vector_text<dim>(verification.contact_reaction) << '\n';
        if (parameters.tangential_displacement_fixed)
          line(out, "  tangential part")
            << vector_text<dim>(verification.tangential_reaction) << '\n';
        report_timings(summary, out);
        out << "Memory in MB\n" << std::fixed << std::setprecision(0);
        line(out, "peak") << summary.peak_memory / 1e6 << ", estimated "
                          << summary.memory_estimate / 1e6 << '\n'
                          << std::defaultfloat;
      }
    out << std::flush;
  }



  void
  report_load_path(const LoadPathTotals &path, std::ostream &out)
  {
    out << "Load path\n";
    line(out, "factors") << path.steps << " of " << path.factors
                         << ", the last one " << path.last_factor << '\n';
    const auto report_change = [&out](const std::string               &label,
                                      const std::optional<BondChange> &change) {
      if (!change)
        return;
      line(out, label) << "at factor " << change->factor << ", step "
                       << change->step << ", broken part "
                       << change->broken_before << " to "
                       << change->broken_after;
      if (change->change_factor)
        out << ", from " << std::setprecision(10) << *change->change_factor
            << std::setprecision(6) << " on";
      out << '\n';
    };
    report_change("most bonds break", path.largest_break);
    report_change("most bonds close", path.largest_closing);
    if (path.compared > 0)
      {
        line(out, "above global branch") << "at " << path.above_global << " of "
                                         << path.compared << " factors";
        if (path.above_global > 0)
          out << ", by " << 100. * path.largest_excess << " % of |J| at most";
        out << '\n';
      }
  }



  void
  report_files(const std::vector<std::string> &files, std::ostream &out)
  {
    out << "Written\n";
    for (const std::string &file : files)
      out << "  " << file << '\n';
    out << std::flush;
  }



  template void
  report_result<2>(const Parameters &,
                   const Summary &,
                   const Verification<2> &,
                   std::ostream &);
  template void
  report_result<3>(const Parameters &,
                   const Summary &,
                   const Verification<3> &,
                   std::ostream &);
} // namespace Debond
