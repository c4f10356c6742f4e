// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_front_search_h
#define debond_solve_front_search_h

#include <debond/linear_algebra/dof_vector.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/solve/scene.h>

#include <functional>

namespace Debond
{
  struct FrontSearchResult
  {
    unsigned int windows      = 0;
    unsigned int trials       = 0; ///< states minimised
    unsigned int improvements = 0; ///< of these, those that lowered J
    unsigned int failures     = 0; ///< of these, those that led to no minimum

    /// Whether all fronts had their window.
    bool complete = true;
  };

  /**
   * Moves the fronts between the branches of the law where no Schur complement
   * on the whole contact boundary is at hand: in windows of some elements
   * around a front, with all displacements outside held, the problem is
   * condensed and searched as search_branches() does. What that gains in a
   * window J falls by, so that one after the other they lower J (a nonlinear
   * Schwarz method). @p u is the displacement of a scene with a serial matrix,
   * at a minimum; outside of the windows it stays as it is, so that a method on
   * all unknowns has to follow an improvement.
   */
  template <int dim>
  FrontSearchResult
  search_fronts(const Scene<dim>            &scene,
                const MajoriseMinimise      &method,
                const std::function<bool()> &may_go_on,
                DofVector                   &u);
} // namespace Debond

#endif
