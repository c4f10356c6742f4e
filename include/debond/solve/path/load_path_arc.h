// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_load_path_arc_h
#define debond_solve_path_load_path_arc_h

#include <debond/solve/minimum/condensed_scene.h>
#include <debond/solve/path/load_path_steps.h>

namespace Debond
{
  template <int dim>
  struct LoadPathArc
  {
    std::vector<LoadPathStep<dim>> steps;
    std::string                    note; ///< why it ends early, if it does
    bool                           interrupted = false;
  };

  /// The curve of stationary states on which that of the first factor of the
  /// scene's load path is, with normal displacements @p s: a step for each
  /// breakpoint (StationaryPath), until the factor leaves the interval of those
  /// of the path. The status is "stable" if the states between the last
  /// breakpoint and this one are minima, else "unstable". It ends at a state
  /// whose verification is worse than @p tolerance, and when @p interruption is
  /// requested. To be called by all ranks.
  template <int dim>
  LoadPathArc<dim>
  follow_arc(const CondensedScene<dim> &scene,
             const Eigen::VectorXd     &s,
             const double               tolerance,
             const Interruption        &interruption);
} // namespace Debond

#endif
