// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/output/report.h>

#include <algorithm>
#include <iomanip>
#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  namespace
  {
    void
    report_change(const std::string               &name,
                  const std::string               &label,
                  const bool                       has_bonds,
                  const std::optional<BondChange> &change,
                  const LoadPathParameters        &load_path,
                  Record                          &record)
    {
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
                  {"change_factor", Record::json_of(change->change_factor)},
                  {"broken_before", change->broken_before},
                  {"broken_after", change->broken_after}});
      record.line(label,
                  words("at ",
                        load_path.name(
                          {change->factor, change->displacement_factor}),
                        ", step ",
                        change->step,
                        has_bonds ? ", broken part " : ", open part ",
                        change->broken_before,
                        " to ",
                        change->broken_after) +
                    (change->change_factor ? words(", from ",
                                                   std::setprecision(10),
                                                   *change->change_factor,
                                                   " on") :
                                             ""));
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
      record.add(
        "/load_path/arc",
        {{"states", arc.size()},
         {"unstable", unstable},
         {"back_from",
          from == to ? Record::Json(nullptr) : Record::Json(factor(from))},
         {"back_to",
          from == to ? Record::Json(nullptr) : Record::Json(factor(to))}});
      record.line("arc",
                  words(arc.size(), " states, ", unstable, " unstable") +
                    (from == to ?
                       "" :
                       words(", the longest way back from ",
                             load_path.moves_only() ? "displacement factor " :
                                                      "factor ",
                             std::setprecision(10),
                             factor(from),
                             " to ",
                             factor(to))));
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
      record.heading("Load path");
      record.add("/load_path/factors", path.factors);
      record.add("/load_path/steps", path.steps);
      record.add("/load_path/last_factor", load_path.varying(path.last));
      record.line("factors",
                  words(path.steps,
                        " of ",
                        path.factors,
                        ", to ",
                        load_path.name(path.last)));
      record.add("/load_path/comes_off_at",
                 comes_off_at ? Record::Json(load_path.varying(*comes_off_at)) :
                                Record::Json(nullptr));
      if (comes_off_at)
        record.line("comes off", "at " + load_path.name(*comes_off_at));
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

      record.add("/load_path/compared_with_global_branch", path.compared);
      record.add("/load_path/above_global_branch", path.above_global);
      record.add("/load_path/largest_excess", path.largest_excess);
      if (path.compared > 0)
        record.line(
          "above global branch",
          words("at ", path.above_global, " of ", path.compared, " factors") +
            (path.above_global > 0 ?
               words(", by ", 100. * path.largest_excess, " % of |J| at most") :
               ""));
    }
  } // namespace



  template <int dim>
  void
  report_load_path(const LoadPathParameters &load_path,
                   const RunResult<dim>     &result,
                   Record                   &record)
  {
    const std::vector<ContactNodeState> &nodes = result.verification.nodes;
    report_totals(load_path_totals(result.path,
                                   static_cast<unsigned int>(
                                     load_path.factors.size())),
                  std::any_of(nodes.begin(),
                              nodes.end(),
                              [](const ContactNodeState &node) {
                                return node.branch != BondState::free;
                              }),
                  result.solve.comes_off_at,
                  load_path,
                  record);
    report_arc(result.arc, load_path, record);
  }



  template decltype(report_load_path<2>) report_load_path<2>;
  template decltype(report_load_path<3>) report_load_path<3>;
} // namespace Debond
