// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_stationary_path_h
#define debond_optimization_stationary_path_h

#include <debond/base/tolerances.h>
#include <debond/base/views.h>
#include <debond/linear_algebra/cholesky.h>
#include <debond/optimization/piecewise_energy.h>

#include <Eigen/LU>

#include <optional>

namespace Debond
{
  /**
   * The stationary points, in Clarke's sense, of
   *
   *     1/2 s'S s - g(t)'s + sum_i w_i f(s_i / l_i),  s <= 0,
   *
   * g being affine in t, and f a PiecewiseEnergy of quadratic pieces. Each s_i
   * together with its force r_i, r = g - S s, is on a curve of straight
   * segments: contact (s_i = 0), a piece of f, if the derivative of f jumps at
   * its end the kink there, at which s_i stays and r_i goes from the derivative
   * of one piece to that of the next, and so on. So the stationary points form
   * a curve in (s, t) that is straight between breakpoints, at which one s_i
   * comes to its next segment; t may turn there, and only there. It goes on
   * beyond the end of a minimum: points with an s_i at a kink are no minima, as
   * f is concave there, nor are those where the free part of S with the
   * curvatures of the pieces is not positive definite.
   *
   * See Eaves, "On solving equations with piecewise linear functions", in:
   * Math. Oper. Res. 1 (1976).
   */
  class StationaryPath
  {
  public:
    struct Bond
    {
      double       energy;    ///< w_i
      double       length;    ///< l_i
      unsigned int least = 0; ///< pieces of f before this one do not return
    };

    /// The functional whose stationary points are followed, with g(t) = load +
    /// (t - t_0) slope, t_0 being the first t; S and f are references.
    struct Problem
    {
      MatrixView             S;
      Eigen::VectorXd        load;
      Eigen::VectorXd        slope;
      const PiecewiseEnergy &f;
      std::vector<Bond>      bonds; ///< of each s_i
      bool returns;                 ///< whether s_i comes back to a piece of f
    };

    /// Starts at a minimum @p s for @p t, in the direction of rising t.
    StationaryPath(const Problem &problem, const VectorView &s, const double t);

    enum class Event
    {
      change,       ///< some s_i came to its next segment
      end,          ///< of the interval
      no_stiffness, ///< the curve goes to infinity
      degenerate    ///< the curve branches, or rounding hides where it goes on
    };

    /// Goes on to the next breakpoint, or to where t leaves [lower, upper].
    Event
    advance(const double lower, const double upper);

    double
    t() const
    {
      return parameter;
    }

    const Eigen::VectorXd &
    point() const
    {
      return s;
    }

    /// Returns whether the points between the last two are no minima.
    bool
    was_unstable() const
    {
      return is_unstable;
    }

    /// The point with each s_i that is at a kink inside the piece that it
    /// has not left.
    Eigen::VectorXd
    point_before_kinks() const;

  private:
    /// 0 is contact, 2 k + 1 the k-th piece, 2 k + 2 the kink after it.
    using Segment = unsigned int;

    /// An s_i that has come to an end of its segment.
    struct Change
    {
      unsigned int i;
      bool         opens; ///< whether the way to greater segments
      Segment      from;
      unsigned int least; ///< of its bond
    };

    bool
    is_free(const unsigned int i) const
    {
      return segments[i] % 2 == 1;
    }

    double
    derivative(const unsigned int i, const unsigned int piece) const;

    /// How fast s_i goes to greater segments as t rises. Far from what moves,
    /// displacements and forces decay to rounding, whose signs are no changes.
    double
    opening(const unsigned int i) const
    {
      const double speed   = segments[i] == 0 || is_free(i) ? -1. : 1.;
      const double by_t    = is_free(i) ? ds(i) : dr(i);
      const double fastest = is_free(i) ? largest_ds : largest_dr;
      return std::abs(by_t) > Tolerance::no_speed * fastest ? speed * by_t : 0.;
    }

    /// Returns the rest of the segment of s_i on the way to greater ones or
    /// back, in terms of s_i or its force.
    double
    distance(const unsigned int i, const bool opens) const;

    /// Puts s_i where its segment holds it, if it does.
    void
    hold(const unsigned int i);

    /// Puts s_i on its next segment.
    void
    change(const Change &change);

    /// The free part of S with its pieces. Returns whether it is regular
    /// enough.
    bool
    factorise();

    /// By what has changed in it, if that is little and it stays positive
    /// definite; otherwise false.
    bool
    update_factor();

    /// Anew.
    void
    make_factor();

    /// b <- its inverse times b.
    void
    solve_free(Eigen::VectorXd &b) const;

    /// The diagonal entry of a free s_i in it.
    double
    stiffness(const unsigned int i) const;

    /// s, r and their velocities.
    void
    solve();

    const MatrixView       S;
    const Eigen::VectorXd  load, slope;
    const double           first_t;
    const PiecewiseEnergy &f;
    std::vector<Bond>      bonds;
    const bool             returns;

    double               parameter;
    Eigen::VectorXd      s;
    Eigen::VectorXd      r;
    std::vector<Segment> segments;
    std::vector<Change>  changes;          ///< at the point
    double               direction   = 1.; ///< of t
    bool                 is_unstable = false;
    Eigen::VectorXd      ds, dr; ///< by t
    double               largest_ds = 0.;
    double               largest_dr = 0.; ///< of the terms of dr

    // The factor of the free part, the s_i in its order, and for each s_i the
    // piece that it has there, 0 if none.
    UpdatableCholesky         factor;
    std::vector<unsigned int> free;
    std::vector<Segment>      in_factor;

    /// The factor where the free part is not positive definite.
    std::optional<Eigen::PartialPivLU<Eigen::MatrixXd>> indefinite;
  };
} // namespace Debond

#endif
