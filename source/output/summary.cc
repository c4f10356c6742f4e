// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/output/summary.h>

#include <nlohmann/json.hpp>

namespace Debond
{
  namespace
  {
    using Json = nlohmann::ordered_json;



    /// The times in the order in which a run spends them.
    Json
    timings_as_json(const std::map<std::string, double> &timings)
    {
      const std::string parts_prefix = "solve/";

      Json result = Json::object();
      for (const char *name : {"mesh", "assembly", "solve", "output", "total"})
        if (const auto timing = timings.find(name); timing != timings.end())
          result[name] = timing->second;

      Json parts = Json::object();
      for (const auto &[name, seconds] : timings)
        if (name.compare(0, parts_prefix.size(), parts_prefix) == 0)
          parts[name.substr(parts_prefix.size())] = seconds;
        else
          result[name] = seconds;
      result["solve_parts"] = parts;
      return result;
    }



    Json
    change_as_json(const std::optional<BondChange> &change)
    {
      if (!change)
        return nullptr;
      Json result = {{"step", change->step}, {"factor", change->factor}};
      result["change_factor"] =
        change->change_factor ? Json(*change->change_factor) : Json(nullptr);
      result["broken_before"] = change->broken_before;
      result["broken_after"]  = change->broken_after;
      return result;
    }



    Json
    load_path_as_json(const LoadPathTotals &path)
    {
      return {{"factors", path.factors},
              {"steps", path.steps},
              {"last_factor", path.last_factor},
              {"largest_break", change_as_json(path.largest_break)},
              {"largest_closing", change_as_json(path.largest_closing)},
              {"compared_with_global_branch", path.compared},
              {"above_global_branch", path.above_global},
              {"largest_excess", path.largest_excess}};
    }
  } // namespace



  void
  write_summary(const Summary &summary, const std::string &file_name)
  {
    Json json;
    json["scene"]         = summary.scene;
    json["method"]        = summary.method;
    json["linear_solver"] = summary.linear_solver;
    json["status"]        = summary.status;
    json["message"]       = summary.message;
    json["notes"]         = summary.notes;
    json["dimension"]     = summary.dimension;
    json["functional"]    = summary.functional;
    if (summary.functional_from_start)
      json["functional_from_start"] = *summary.functional_from_start;
    json["minimum"] = {{"state", summary.minimum},
                       {"search_trials", summary.search_trials},
                       {"search_improvements", summary.search_improvements},
                       {"search_failures", summary.search_failures},
                       {"search_nodes", summary.search_nodes},
                       {"closed_nodes", summary.closed_nodes}};
    if (!summary.proof.empty())
      json["proof"] = {{"status", summary.proof},
                       {"nodes", summary.proof_nodes},
                       {"lower_bound", summary.lower_bound},
                       {"relative_gap", summary.relative_gap}};
    json["iterations"]          = {{"total", summary.total_iterations},
                                   {"long", summary.long_steps},
                                   {"short", summary.short_steps},
                                   {"null", summary.null_steps}};
    json["stop_criterion"]      = summary.stop_criterion;
    json["largest_qp_residual"] = summary.largest_qp_residual;
    json["linear_iterations"]   = summary.linear_iterations;
    if (summary.condition_estimate)
      json["condition_estimate"] = *summary.condition_estimate;
    json["memory_estimate_bytes"]         = summary.memory_estimate;
    json["peak_memory_bytes"]             = summary.peak_memory;
    json["cells"]                         = summary.cells;
    json["degrees_of_freedom"]            = summary.degrees_of_freedom;
    json["degrees_of_freedom_paper"]      = summary.degrees_of_freedom_paper;
    json["contact_nodes"]                 = summary.contact_nodes;
    json["law_violation"]                 = summary.law_violation;
    json["penetration"]                   = summary.penetration;
    json["equilibrium_residual"]          = summary.equilibrium_residual;
    json["force_imbalance"]               = summary.force_imbalance;
    json["largest_displacement"]          = summary.largest.displacement;
    json["largest_displacement_gradient"] = summary.largest.gradient;
    json["largest_von_mises"]             = summary.largest.von_mises;
    if (const auto &error = summary.displacement_error; error)
      json["displacement_error"] = {{"l2", error->l2},
                                    {"h1", error->h1},
                                    {"energy_norm", error->energy_norm},
                                    {"exact_energy", error->exact_energy}};
    json["applied_force"]       = summary.applied_force;
    json["clamped_reaction"]    = summary.clamped_reaction;
    json["contact_reaction"]    = summary.contact_reaction;
    json["tangential_reaction"] = summary.tangential_reaction;
    json["bond_states"]         = summary.bond_states;
    if (summary.load_path)
      json["load_path"] = load_path_as_json(*summary.load_path);
    json["timings_s"]       = timings_as_json(summary.timings_s);
    json["revision"]        = summary.revision;
    json["deal_ii_version"] = summary.deal_ii_version;
    json["build_type"]      = summary.build_type;

    // A path need not be valid UTF-8; that is no reason to lose the summary.
    const std::string text =
      json.dump(2, ' ', false, Json::error_handler_t::replace);
    write_atomically(file_name,
                     [&](std::ostream &out) { out << text << '\n'; });
  }
} // namespace Debond
