// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/output/proof_plots.h>

#include <cmath>

namespace Debond
{
  std::vector<std::string>
  proof_plot_names()
  {
    return {"proof_time", "proof_nodes"};
  }



  std::vector<Plot>
  proof_plots(const std::vector<ProofProgress> &history)
  {
    if (history.empty() || history.back().nodes <= 1)
      return {};
    const std::vector<std::string> names = proof_plot_names();
    Plot  time  = {names[0], "", "s", "gap relative to J", false, true};
    Plot  nodes = {names[1], "", "nodes", "gap relative to J", true, true};
    Curve against_time, against_nodes;
    against_time.title = against_nodes.title = "gap";
    for (const ProofProgress &step : history)
      {
        const double gap = (step.upper - step.lower) / std::abs(step.upper);
        against_time.points.emplace_back(step.seconds, gap);
        against_nodes.points.emplace_back(step.nodes, gap);
      }
    time.curves.push_back(against_time);
    nodes.curves.push_back(against_nodes);
    if (!has_points(time))
      return {};
    return {time, nodes};
  }
} // namespace Debond
