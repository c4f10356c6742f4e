// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_piecewise_energy_h
#define debond_optimization_piecewise_energy_h

#include <debond/optimization/interval.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace Debond
{
  /// The end of a last piece.
  constexpr double no_end = -infinity;

  /// A piece of a function of s <= 0 whose derivative is curvature s + slope,
  /// or, with a decay (1 / length), slope exp(decay (s - upper)), down to its
  /// end, which is no_end for the last one.
  struct EnergyPiece
  {
    double      curvature, slope;
    double      end;
    std::string name;
    double      decay = 0.;
  };



  /**
   * f(s) at s <= 0, with f >= f(0) = 0: a list of pieces in the order in which
   * they follow each other from 0 downwards, continuous, with a derivative
   * that may jump up but not down as s falls. So f is the least of convex
   * quadratics that touch it, one at each s: where it is the least of its
   * pieces, these; elsewhere pieces may be concave. At the kink between two
   * pieces the one on the side of 0 is the one that holds, here and wherever a
   * piece is chosen.
   *
   * What has been at s = reached need not return to what it has left: then f is
   * a parabola about 0 down to there, the secant of the derivative, f(0) is not
   * 0 any more but what was taken up for good, and below reached nothing has
   * changed.
   */
  class PiecewiseEnergy
  {
  public:
    struct Piece
    {
      double       curvature, slope;
      long double  constant;     ///< with a decay, the value at begin
      double       lower, upper; ///< where it holds
      unsigned int number;       ///< in the list
      double       decay = 0.;   ///< EnergyPiece::decay
      double       begin = 0.;   ///< with a decay, the piece's own upper end

      /// True if its parabola is nowhere below f.
      bool is_above = true;

      double
      value(const double s) const
      {
        if (decay > 0.)
          return static_cast<double>(constant) +
                 slope / decay * std::expm1(decay * (s - begin));
        return curvature * s * s / 2. + slope * s +
               static_cast<double>(constant);
      }

      double
      derivative(const double s) const
      {
        return decay > 0. ? slope * std::exp(decay * (s - begin)) :
                            curvature * s + slope;
      }

      double
      second_derivative(const double s) const
      {
        return decay > 0. ? decay * derivative(s) : curvature;
      }

      /// How far it is from @p s along @p ds to its end, as a multiple of ds:
      /// infinite if there is none before s = 0.
      double
      way_to_end(const double s, const double ds) const
      {
        const double end  = ds < 0. ? lower : upper;
        const bool   ends = ds < 0. ? std::isfinite(end) : ds > 0. && end < 0.;
        return ends ? std::max(0., (end - s) / ds) : infinity;
      }

      /// Returns whether it has the same value everywhere.
      bool
      is_flat() const
      {
        return curvature == 0. && slope == 0.;
      }
    };

    /// Throws std::invalid_argument if the pieces do not follow each other, or
    /// f is negative or has a derivative that jumps down as s falls.
    explicit PiecewiseEnergy(const std::vector<EnergyPiece> &given);

    static PiecewiseEnergy
    zero()
    {
      return PiecewiseEnergy({{0., 0., no_end, ""}});
    }

    /// Returns this function where @p reached has been reached, less what was
    /// taken up for good: piece_at() as a list of pieces. f itself if @p
    /// reached is 0.
    PiecewiseEnergy
    after(const double reached) const;

    /// Returns how many pieces after() has left out, so that piece() + this is
    /// the number that a piece had before.
    unsigned int
    n_left() const
    {
      return left;
    }

    /// Returns whether some piece is not above f.
    bool
    softens() const;

    /// Returns whether no piece decays.
    bool
    is_piecewise_quadratic() const;

    /// The piece that holds at @p s where @p reached has been reached, with its
    /// ends.
    Piece
    piece_at(const double s, const double reached) const;

    /// The curvature of the flattest quadratic that touches f at s, and is
    /// nowhere below it, where @p reached has been reached.
    double
    majorant_curvature(const double s, const double reached = 0.) const;

    /// The convexity c with which f + c/2 s^2 is nowhere below its tangent at
    /// s.
    double
    needed_convexity(const double s) const;

    /// Returns whether the derivative jumps at the lower end of a piece.
    bool
    has_drop(const unsigned int piece) const;

    /// energy f(s / length); the single piece zero without energy.
    PiecewiseEnergy
    scaled(const double energy, const double length = 1.) const;

    unsigned int
    size() const
    {
      return static_cast<unsigned int>(pieces.size());
    }

    const Piece &
    operator[](const unsigned int piece) const
    {
      return pieces[piece];
    }

    /// The piece that holds at @p s; the first one for s > 0.
    unsigned int
    index(const double s) const;

    double
    value(const double s) const
    {
      return pieces[index(s)].value(s);
    }

    /// The largest value, infinite if there is none.
    double
    largest_value() const;

    /// A point inside a piece, on the last one at twice its kink, or where it
    /// has decayed.
    double
    point_inside(const unsigned int piece) const;

  private:
    PiecewiseEnergy() = default;

    /// Returns whether a piece through 0 is all that holds above @p reached.
    bool
    returns_on_a_piece(const double reached) const
    {
      return pieces[index(reached)].slope == 0.;
    }

    /// Constants for which the function is continuous at the kinks as they are
    /// in doubles.
    void
    connect();

    std::vector<Piece> pieces;
    unsigned int       left = 0; ///< n_left()
  };
} // namespace Debond

#endif
