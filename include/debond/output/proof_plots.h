// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_proof_plots_h
#define debond_output_proof_plots_h

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/output/gnuplot.h>

#include <vector>

namespace Debond
{
  /// Of the files.
  std::vector<std::string>
  proof_plot_names();

  /// The gap relative to the best value against time and against nodes; nothing
  /// for a proof of one node. The energies are those of the history.
  std::vector<Plot>
  proof_plots(const std::vector<ProofProgress> &history);
} // namespace Debond

#endif
