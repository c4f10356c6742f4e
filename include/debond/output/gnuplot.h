// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_gnuplot_h
#define debond_output_gnuplot_h

#include <string>
#include <utility>
#include <vector>

namespace Debond
{
  /// One curve, or points.
  struct Curve
  {
    std::string                            title;
    std::vector<std::pair<double, double>> points;
    std::string                            style = "lines"; ///< gnuplot's

    /// Drawn with dashes in the colour of the curve before it.
    bool belongs_to_previous = false;
  };



  struct Plot
  {
    std::string        name; ///< of its files
    std::string        caption;
    std::string        x_label;
    std::string        y_label;
    bool               log_x  = false;
    bool               log_y  = false;
    std::vector<Curve> curves = {};
  };

  /// Whether there is something to draw: gnuplot fails if there is not.
  bool
  has_points(const Plot &plot);

  /// The files that plots of these names can have: data, script, pictures, and
  /// the words of gnuplot if it failed.
  std::vector<std::string>
  plot_files(const std::vector<std::string> &names);

  /// Writes NAME.dat and NAME.gp into the directory. Throws std::runtime_error
  /// naming the file that cannot be written.
  void
  write_gnuplot(const Plot &plot, const std::string &directory);

  /// Draws NAME.png and NAME.svg with gnuplot. Returns what went wrong, or
  /// nothing.
  std::string
  run_gnuplot(const Plot &plot, const std::string &directory);
} // namespace Debond

#endif
