// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_largest_force_h
#define debond_solve_path_largest_force_h

#include <debond/solve/answer.h>

namespace Debond
{
  /**
   * Looks for the largest force inside of the steps of a path that moves
   * supports. The force F is the derivative of J by their factor d.
   *
   * Without other loads and without gaps everything but the bonds is
   * homogeneous: bonds that keep what they have make F proportional to d, and
   * those that lose some of it make it less. (Bonds that do not heal have no
   * tractions that rise more than in proportion to the opening.) So on the way
   * from d_0 to d the force is at most F_0 d / d_0, and a step is halved until
   * this bound of each part is no more than the largest force that was found by
   * more than `Load path/Resolve`. From d = 0 a small part of the way tells F_0
   * / d_0.
   *
   * With other loads, gaps or friction, bonds that heal, and energies that
   * depend on the mode this is no bound, and tells only where to look; with the
   * first three only steps in which bonds break are halved, and without
   * friction those in which F falls.
   */
  template <int dim>
  class LargestForce
  {
  public:
    /// The state at these factors on the way from an earlier one, or nothing if
    /// none was found.
    using GoTo = std::function<std::optional<PathEnd<dim>>(const PathEnd<dim> &,
                                                           const LoadFactors)>;

    /// Keeps a reference to @p scene.
    LargestForce(const Scene<dim> &scene, const GoTo &go_to);

    /// Adds to @p peak what happens from @p begun to the factors @p last. The
    /// path's own step there is @p step, null if there is no state.
    void
    look_into(const PathEnd<dim>               &begun,
              const LoadFactors                 last,
              const LoadPathStep<dim> *const    step,
              std::optional<LoadPathPeak<dim>> &peak) const;

  private:
    using Peak = LoadPathPeak<dim>;

    /// Where a part of a step begins.
    struct Start
    {
      PathEnd<dim> state;
      double       slope; ///< of the force by the factor of displacements
    };

    /// On the way to @p last.
    Start
    start(const PathEnd<dim> &state, const LoadFactors last, Peak &peak) const;

    /// Returns what the force may become on the way to @p last.
    static double
    bound(const Start &start, const LoadFactors last);

    bool
    is_resolved(const double bound, const Peak &peak) const;

    /// Goes to @p last in steps that are halved at most @p halvings times, and
    /// returns the state there.
    std::optional<PathEnd<dim>>
    walk(const Start       &start,
         const LoadFactors  last,
         const unsigned int halvings,
         Peak              &peak) const;

    std::optional<PathEnd<dim>>
    walk_halves(const Start       &start,
                const LoadFactors  last,
                const unsigned int halvings,
                Peak              &peak) const;

    const Scene<dim> &scene;
    const GoTo        go_to;
    const bool        is_homogeneous;
    const bool        is_bounded; ///< by the slopes of its states

    /// The work of forces that are rounding, as when all has come off.
    const double noise;
  };

  /// The largest force of steps between which nothing is known.
  template <int dim>
  LoadPathPeak<dim>
  peak_of_steps(const std::vector<LoadPathStep<dim>> &steps);
} // namespace Debond

#endif
