// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_convex_envelope_h
#define debond_optimization_global_convex_envelope_h

#include <debond/optimization/piecewise_energy.h>

#include <optional>

namespace Debond
{
  /// f(s) = c/2 s^2 + pieces of a PiecewiseEnergy that follow each other, c
  /// >= 0.
  struct ShiftedEnergy
  {
    double                              convexity; ///< c
    std::vector<PiecewiseEnergy::Piece> pieces;    ///< from 0 downwards

    double
    value(const double s) const;

    /// The least value of r s + f(s) on [lower, upper] where the piece holds,
    /// less what rounding can do to it; infinite if there is no such s.
    long double
    least(const long double  r,
          const double       lower,
          const double       upper,
          const unsigned int piece) const;

    /// On all pieces.
    long double
    least(const long double r, const double lower, const double upper) const;
  };



  /**
   * The convex envelope of a ShiftedEnergy on [lower, upper], upper <= 0: parts
   * of its convex pieces, and between them lines that touch these, or meet the
   * ends of concave ones.
   */
  class ConvexEnvelope
  {
  public:
    ConvexEnvelope(const ShiftedEnergy &f,
                   const double         lower,
                   const double         upper);

    double
    value(const double s) const;

    /// (s - a)(b - s) on a line from a to b, zero on the parabolas: twice the
    /// derivative of the envelope less c/2 s^2 with respect to c.
    double
    spread(const double s) const;

    /// The envelope's derivative is slope + curvature s on each part.
    struct Part
    {
      double lower, upper;
      double slope, curvature;
      bool   is_line;
    };

    /// In ascending order, without empty ones.
    std::vector<Part> parts;

    /// The line that has s inside, null if there is none.
    const Part *
    line_at(const double s) const;

  private:
    ShiftedEnergy f;
  };



  /**
   * A function that is at most
   *
   *     conv(f + D/2 s^2) - D/2 s^2,   s <= 0,
   *
   * conv being the convex envelope: by Jensen's inequality the mean of f(s) +
   * D/2 (s - m)^2 over functions s with the mean m is not below that at m.
   *
   * The envelope is f but on lines that touch it on both sides of a kink.
   * There the difference is concave, and not below the parabola with the
   * curvature of f on the far side that meets f where the line touches.
   */
  class RoundedEnergy
  {
  public:
    /// @p D > 0.
    RoundedEnergy(const PiecewiseEnergy &f, const double D);

    /// f with one piece in place of each line.
    PiecewiseEnergy
    minimum() const;

    /// Returns whether s, or what a tenth of a kink's distance from 0 takes it
    /// to, is on a line.
    bool
    is_rounded_near(const double s) const;

    /// The piece of f that is not rounded on all of the interval, and for s > 0
    /// if the interval has such: there
    ///     conv(f + D/2 s^2)(s + w) >= f(s) + D/2 s^2 + (f'(s) + D s) w.
    std::optional<unsigned int>
    exact_piece(const Interval &interval) const;

  private:
    struct Line
    {
      double lower, upper;
    };

    const PiecewiseEnergy &f;
    std::vector<Line>      lines;
  };
} // namespace Debond

#endif
