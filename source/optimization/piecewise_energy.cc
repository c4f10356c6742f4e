// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/piecewise_energy.h>

#include <stdexcept>

namespace Debond
{
  namespace
  {

    /// Where nothing is left of what decays, in terms of the length in which it
    /// does so by e.
    constexpr double far_behind = 20.;



    using Piece = PiecewiseEnergy::Piece;

    /// The curvatures of quadratics that touch @p own at @p s and meet @p other
    /// where it holds: with more than the largest they are nowhere below.
    Interval
    curvatures_that_meet(const Piece &own, const double s, const Piece &other)
    {
      // It is below its tangent, which what comes before it has taken care of.
      if (other.decay > 0.)
        return {0., 0.};
      // The tangent of own at s is force x + at_zero. Other less this tangent
      // is h + b x + c/2 x^2: about 0, as brittle bonds are next to 0, seen
      // from far.
      const long double force =
        own.decay > 0. ?
          static_cast<long double>(own.derivative(s)) :
          own.slope + own.curvature * static_cast<long double>(s);
      const long double at_zero = own.decay > 0. ?
                                    own.value(s) - force * s :
                                    own.constant - 0.5L * own.curvature * s * s;
      const long double h = other.constant - at_zero, b = other.slope - force,
                        c   = other.curvature;
      const auto difference = [&](const long double x) {
        return h + x * (b + 0.5L * c * x);
      };
      // A quadratic that touches own at s with the curvature k is the tangent
      // and k/2 (x - s)^2. It meets other at x if k = 2 difference(x) / (x -
      // s)^2, so that the largest and the least k are at the ends of other or
      // where this is stationary.
      Interval   result = {infinity, -infinity};
      const auto meet   = [&](const long double curvature) {
        result = hull(result,
                      {static_cast<double>(curvature),
                       static_cast<double>(curvature)});
      };
      // At an end that both have it is that of own.
      for (const double end : {other.lower, other.upper})
        if (std::isinf(end))
          meet(c);
        else if (end != own.lower && end != own.upper)
          {
            const long double distance = static_cast<long double>(end) - s;
            meet(2.L * difference(end) / (distance * distance));
          }
      // Written about s the difference is at_s + slope y + c/2 y^2, and 2
      // difference / y^2 is stationary at y = -2 at_s / slope, with the value c
      // - slope^2 / (2 at_s).
      const long double at_s = difference(s), slope = b + c * s;
      const long double extreme  = s - 2.L * at_s / slope;
      const long double rounding = 4.L * Tolerance::epsilon * std::abs(s);
      if (slope != 0.L && at_s != 0.L && extreme >= other.lower - rounding &&
          extreme <= other.upper + rounding)
        meet((2.L * c * h - b * b) / (2.L * at_s));
      return result;
    }



    /// Whether the parabola of @p own is nowhere below @p other, where that
    /// holds, but for rounding.
    bool
    is_nowhere_below(const Piece &own, const Piece &other)
    {
      if (other.decay > 0.)
        return own.curvature > 0. || own.is_flat();
      // Of own less other, from the upper end of other.
      const long double s = other.upper,
                        A = static_cast<long double>(own.curvature) -
                            other.curvature,
                        B = static_cast<long double>(own.slope) - other.slope +
                            A * s,
                        C = own.constant - other.constant +
                            s * (static_cast<long double>(own.slope) -
                                 other.slope + 0.5L * A * s);
      const long double rounding =
        Tolerance::rounding_of_data *
        (std::abs(own.value(other.upper)) + std::abs(other.value(other.upper)));
      const auto is_above = [&](const long double distance) {
        return C + distance * (B + 0.5L * A * distance) >= -rounding;
      };
      if (std::isinf(other.lower))
        {
          if (A < 0.L || (A == 0.L && B > 0.L))
            return false;
        }
      else if (!is_above(static_cast<long double>(other.lower) - s))
        return false;
      // The least value between the ends.
      const long double stationary = A > 0.L ? -B / A : 0.L;
      return is_above(0.L) &&
             (!(stationary < 0.L && s + stationary > other.lower) ||
              is_above(stationary));
    }
  } // namespace



  PiecewiseEnergy::PiecewiseEnergy(const std::vector<EnergyPiece> &given)
  {
    const auto require_of = [](const bool         holds,
                               const EnergyPiece &piece,
                               const std::string &reason) {
      if (!holds)
        throw std::invalid_argument("The piece \"" + piece.name + "\" " +
                                    reason);
    };
    if (given.empty())
      throw std::invalid_argument("A law needs a piece");
    double upper = 0., last_rounding = 0.;
    for (const EnergyPiece &piece : given)
      {
        // The pieces have to follow each other from 0 downwards without a gap.
        const bool is_last = &piece == &given.back();
        require_of(std::isfinite(piece.curvature) &&
                     std::isfinite(piece.slope) && piece.decay >= 0. &&
                     std::isfinite(piece.decay),
                   piece,
                   "is not finite");
        require_of(piece.end < upper && (is_last ? piece.end == -infinity :
                                                   std::isfinite(piece.end)),
                   piece,
                   "does not end below its beginning, the last one at minus "
                   "infinity");
        pieces.push_back({piece.curvature,
                          piece.slope,
                          0.L,
                          piece.end,
                          upper,
                          static_cast<unsigned int>(pieces.size()),
                          piece.decay,
                          upper});
        const Piece &here = pieces.back();
        // Of steep pieces far from 0 the terms of the derivative cancel.
        const double rounding =
          Tolerance::rounding_of_data *
          (std::abs(piece.slope) +
           std::abs(piece.curvature * (is_last ? upper : piece.end)));
        // A derivative that jumped down as s falls would be a convex kink: no
        // quadratic from above touches there.
        require_of(pieces.size() == 1 ||
                     here.derivative(upper) >=
                       pieces[pieces.size() - 2].derivative(upper) -
                         (rounding + last_rounding),
                   piece,
                   "pulls more where it begins than the one before");
        upper         = piece.end;
        last_rounding = rounding;
      }
    connect();
    double rounding = 0.;
    for (Piece &own : pieces)
      {
        // The least value, which rounding may take below zero.
        rounding =
          std::max(rounding, Tolerance::negative_energy * own.value(own.upper));
        const double stationary =
          own.curvature > 0. ? -own.slope / own.curvature : own.upper;
        const double least =
          own.value(std::clamp(stationary, own.lower, own.upper));
        const bool rises =
          std::isfinite(own.lower) ?
            own.value(own.lower) < -rounding :
            own.curvature < 0. || (own.curvature == 0. && own.slope > 0.);
        require_of(!rises && least >= -rounding,
                   given[own.number],
                   "is negative");
        // A convex parabola that is nowhere below the other pieces is its own
        // majorant.
        for (const Piece &other : pieces)
          own.is_above = own.is_above && own.curvature >= 0. &&
                         own.decay == 0. && is_nowhere_below(own, other);
      }
  }



  PiecewiseEnergy
  PiecewiseEnergy::after(const double reached) const
  {
    if (reached == 0.)
      return *this;
    std::vector<EnergyPiece> rest;
    const unsigned int       m = index(reached);
    // A secant is a piece more, unless the piece that it cuts ends there.
    const bool has_secant = !returns_on_a_piece(reached);
    if (has_secant)
      rest.push_back({piece_at(0., reached).curvature, 0., reached, ""});
    for (unsigned int k = m; k < size(); ++k)
      if (!has_secant || pieces[k].lower < reached)
        {
          const Piece &piece = pieces[k];
          // What decays is told by the slope with which it begins.
          const double upper = std::min(piece.upper, reached);
          rest.push_back(
            {piece.curvature,
             piece.decay > 0. ? piece.derivative(upper) : piece.slope,
             piece.lower,
             "",
             piece.decay});
        }
    PiecewiseEnergy result(rest);
    // Of the same pieces the last ones are left, so that the secant has the
    // number of the piece before, if there is one.
    result.left = left + std::max(size(), result.size()) - result.size();
    return result;
  }



  bool
  PiecewiseEnergy::softens() const
  {
    return !std::all_of(pieces.begin(), pieces.end(), [](const Piece &piece) {
      return piece.is_above;
    });
  }



  bool
  PiecewiseEnergy::is_piecewise_quadratic() const
  {
    return std::all_of(pieces.begin(), pieces.end(), [](const Piece &piece) {
      return piece.decay == 0.;
    });
  }



  PiecewiseEnergy::Piece
  PiecewiseEnergy::piece_at(const double s, const double reached) const
  {
    // Bonds come back along the piece they are on if that goes through zero
    // with its derivative, as a spring does; else along the secant from where
    // they have been.
    const unsigned int m     = index(reached);
    const unsigned int k     = index(s);
    Piece              piece = pieces[std::max(k, m)];
    if (returns_on_a_piece(reached))
      {
        if (k <= m)
          piece.upper = 0.;
        return piece;
      }
    if (s <= reached)
      {
        piece.upper = std::min(piece.upper, reached);
        return piece;
      }
    // The parabola about 0 with this derivative at reached, and the value of f
    // there.
    const double force = pieces[m].derivative(reached);
    const auto   taken = static_cast<long double>(pieces[m].value(reached)) -
                       0.5L * force * reached;
    return {force / reached, 0., taken, reached, 0., m};
  }



  double
  PiecewiseEnergy::majorant_curvature(const double s,
                                      const double reached) const
  {
    // Most bonds are springs or broken, and need no search.
    if (const Piece &here = pieces[index(s)];
        reached == 0. && here.is_above && pieces[0].slope == 0.)
      return here.curvature;
    // With a memory f is a secant parabola above `reached` and the law below
    // it, and the majorant at s has to be above both parts.
    const Piece own        = piece_at(s, reached);
    const bool  has_secant = !returns_on_a_piece(reached);
    if (own.is_above && (own.is_flat() || !has_secant))
      return own.curvature;
    // At least as much as f itself has at s, and as much as it takes to stay
    // above each other piece.
    const bool is_on_secant = has_secant && s > reached;
    double     curvature    = std::max(0., own.second_derivative(s));
    const auto stay_above   = [&](const Piece &other) {
      curvature =
        std::max(curvature, curvatures_that_meet(own, s, other).upper);
    };
    if (has_secant && !is_on_secant)
      stay_above(piece_at(0., reached));
    for (Piece other : pieces)
      if (other.lower < reached && (is_on_secant || other.number != own.number))
        {
          if (has_secant)
            other.upper = std::min(other.upper, reached);
          stay_above(other);
        }
    return curvature;
  }



  double
  PiecewiseEnergy::needed_convexity(const double s) const
  {
    // With less than its own concavity the piece itself would be below its
    // tangent at s.
    const Piece own       = piece_at(s, 0.);
    double      convexity = std::max(0., -own.curvature);
    for (const Piece &other : pieces)
      if (other.number != own.number)
        // A quadratic below all of f has at most the least of the curvatures
        // that meet the others.
        convexity =
          std::max(convexity, -curvatures_that_meet(own, s, other).lower);
    return convexity;
  }



  bool
  PiecewiseEnergy::has_drop(const unsigned int piece) const
  {
    if (piece + 1 >= pieces.size())
      return false;
    const double s = pieces[piece].lower;
    // Tractions of both pieces are quotients of what a scene gives, and differ
    // by rounding where the curve is continuous.
    const double pull = -pieces[piece].derivative(s);
    return pull + pieces[piece + 1].derivative(s) >
           Tolerance::rounding_of_data * pull;
  }



  PiecewiseEnergy
  PiecewiseEnergy::scaled(const double energy, const double length) const
  {
    if (energy == 0.)
      return PiecewiseEnergy::zero();
    // Curvatures scale by energy / length^2 and slopes by energy / length;
    // whether a piece is above the others does not change. The constants are
    // made anew, as the function has to be continuous at kinks that have been
    // rounded.
    PiecewiseEnergy result = *this;
    for (Piece &piece : result.pieces)
      {
        piece.curvature *= energy / (length * length);
        piece.slope *= energy / length;
        piece.decay /= length;
        piece.begin *= length;
        piece.lower *= length;
        piece.upper *= length;
      }
    result.connect();
    return result;
  }



  unsigned int
  PiecewiseEnergy::index(const double s) const
  {
    // Laws have few pieces: a search by halves would take longer.
    unsigned int k = 0;
    while (k + 1 < pieces.size() && s < pieces[k].lower)
      ++k;
    return k;
  }



  double
  PiecewiseEnergy::largest_value() const
  {
    // The last piece rises as s falls, for ever unless it decays, or is flat.
    const Piece &last = pieces.back();
    if (last.decay > 0.)
      return last.value(-infinity);
    if (!last.is_flat())
      return infinity;
    double largest = 0.;
    for (const Piece &piece : pieces)
      largest = std::max(largest, piece.value(piece.upper));
    return largest;
  }



  double
  PiecewiseEnergy::point_inside(const unsigned int piece) const
  {
    const Piece &p = pieces[piece];
    if (p.decay > 0.)
      return p.upper - far_behind / p.decay;
    return std::isfinite(p.lower) ? (p.lower + p.upper) / 2. : 2. * p.upper;
  }



  void
  PiecewiseEnergy::connect()
  {
    // f is continuous by its constants: each piece begins with the value at
    // which the one before ends. They are sums of terms that may be far larger
    // than they are, so that they are in extended precision.
    for (unsigned int k = 1; k < pieces.size(); ++k)
      {
        const Piece      &last = pieces[k - 1];
        const long double s    = last.lower;
        // To the last digit, which the bundle method amplifies.
        if (pieces[k].is_flat() || pieces[k].decay > 0.)
          {
            pieces[k].constant = last.value(last.lower);
            continue;
          }
        // The value of the piece before at its end, less what this one has
        // there without a constant.
        pieces[k].constant =
          last.constant +
          (static_cast<long double>(last.slope) - pieces[k].slope) * s +
          0.5L *
            (static_cast<long double>(last.curvature) - pieces[k].curvature) *
            s * s;
      }
  }
} // namespace Debond
