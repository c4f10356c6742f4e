// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/output/report.h>

#include <string>
#include <vector>

namespace Debond
{
  void
  report_level(const unsigned int   number,
               const AdaptiveLevel &level,
               Record              &record)
  {
    if (number == 0)
      record.heading("Meshes");
    record.add("/levels/" + std::to_string(number),
               {{"cells", level.cells},
                {"unknowns", level.unknowns},
                {"contact_nodes", level.contact_nodes},
                {"iterations", level.iterations},
                {"functional", level.functional},
                {"estimated_error", level.estimated_error},
                {"gap", level.gap},
                {"seconds", level.seconds}});
    record.line(
      words("mesh ", number),
      words(level.unknowns,
            " unknowns, ",
            level.contact_nodes,
            " contact nodes, J ",
            scientific(level.functional, 10),
            ", error about ",
            scientific(level.estimated_error, 1),
            level.gap > 0. ? ", gap " + scientific_above(level.gap, 1) : "") +
        (record.has_details() ? ", " + fixed_point(level.seconds, 2) + " s" :
                                ""));
  }



  template <int dim>
  void
  report_cost(const RunResult<dim> &result,
              const MethodChoice   &choice,
              const double          peak_memory,
              Record               &record)
  {
    const auto log = [&record](const std::string &label, const double seconds) {
      if (record.has_details())
        record.line(label, fixed_point(seconds, 4));
    };
    if (record.has_details())
      record.heading("Wall time in s");
    const auto &solve_parts = result.solve.parts;
    for (const auto &[part, seconds] : result.times)
      {
        record.add("/timings_s/" + part, seconds);
        log(part, seconds);
        if (part == "solve")
          for (const auto &[name, seconds_of_it] : solve_parts)
            log("  " + name, seconds_of_it);
      }
    record.add("/timings_s/solve_parts",
               solve_parts.empty() ? Record::Json::object() :
                                     Record::Json(solve_parts));

    record.add("/memory_estimate_bytes", choice.memory);
    record.add("/peak_memory_bytes", peak_memory);
    if (record.has_details())
      {
        record.heading("Memory in MB");
        record.line("peak",
                    fixed_point(peak_memory / 1e6, 0) + ", estimated " +
                      fixed_point(choice.memory / 1e6, 0));
      }
  }



  void
  report_files(const std::vector<std::string> &files, Record &record)
  {
    if (!record.has_details())
      return;
    record.heading("Written");
    for (const std::string &file : files)
      record.heading("  " + file);
  }



  template decltype(report_cost<2>) report_cost<2>;
  template decltype(report_cost<3>) report_cost<3>;
} // namespace Debond
