// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_load_path_plots_h
#define debond_output_load_path_plots_h

#include <debond/output/gnuplot.h>
#include <debond/solve/load_path_steps.h>

#include <string>
#include <vector>

namespace Debond
{
  /// Of the files.
  std::vector<std::string>
  load_path_plot_names();

  /// Broken part, J and normal force over the factor and the factor over
  /// <f, u>, or if prescribed displacements alone have one, their forces over
  /// it: a curve for each time that the factor rises or falls, one for
  /// the global branch and one for the arc. There has to be one step at least.
  template <int dim>
  std::vector<Plot>
  load_path_plots(const std::vector<LoadPathStep<dim>> &steps,
                  const std::vector<LoadPathStep<dim>> &arc);
} // namespace Debond

#endif
