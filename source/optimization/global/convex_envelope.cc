// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/global/convex_envelope.h>

#include <array>

namespace Debond
{
  namespace
  {
    using Piece = PiecewiseEnergy::Piece;

    /// c/2 s^2 + b s + h.
    struct Parabola
    {
      long double c, b, h;

      Parabola(const Piece &piece, const double convexity)
        : c(static_cast<long double>(piece.curvature) + convexity)
        , b(piece.slope)
        , h(piece.constant)
      {}

      long double
      operator()(const long double s) const
      {
        return h + s * (b + 0.5L * c * s);
      }
    };



    /// A convex piece of f from one point to another, which may be the same.
    struct Arc
    {
      Parabola    f;
      long double lower, upper;

      /// Where m s - f(s) is largest.
      long double
      contact(const long double m) const
      {
        if (lower == upper)
          return lower;
        return f.c > 0.L ? std::min(std::max((m - f.b) / f.c, lower), upper) :
               m < f.b   ? lower :
                           upper;
      }

      /// Slopes with which lines begin to leave each end.
      long double
      slope_at(const long double s) const
      {
        return f.b + f.c * s;
      }
    };



    /// The line that is below two arcs, @p left and @p right of it, and meets
    /// both.
    struct Bridge
    {
      double first, second; ///< where
    };

    Bridge
    bridge(const Arc &left, const Arc &right)
    {
      // Where they meet without a concave kink there is no line.
      if (left.upper == right.lower)
        {
          const long double before = left.slope_at(left.upper),
                            behind = right.slope_at(right.lower);
          if (left.lower == left.upper || right.lower == right.upper ||
              before <= behind + Tolerance::rounding_of_data * std::abs(before))
            return {static_cast<double>(left.upper),
                    static_cast<double>(left.upper)};
        }
      // At q, where a line with slope m touches the right arc, the one that
      // touches the left arc is above it by this excess, which is zero for the
      // line that touches both. For each arc the touching point moves with m,
      // until it is at an end of the arc.
      const auto excess = [&](const long double m) {
        const long double p = left.contact(m), q = right.contact(m);
        return m * (q - p) - (right.f(q) - left.f(p));
      };
      // The excess grows with m, by a parabola between the slopes at which a
      // touching point comes to an end of its arc or leaves it.
      std::array<long double, 4> slopes = {{left.slope_at(left.lower),
                                            left.slope_at(left.upper),
                                            right.slope_at(right.lower),
                                            right.slope_at(right.upper)}};
      std::sort(slopes.begin(), slopes.end());
      unsigned int k = 0;
      while (k < 4 && excess(slopes[k]) < 0.L)
        ++k;
      // From where on it is a parabola or, beyond the last slope, a line.
      const long double from    = slopes[k == 0 ? 0 : k - 1];
      const long double to      = k == 0 ? from - 1.L :
                                  k == 4 ? from + 1.L :
                                           slopes[k];
      const long double at_from = excess(from), middle = (from + to) / 2.L;
      const long double at_to = excess(to), width = to - from;
      long double       m = from;
      if (width != 0.L && at_to != at_from)
        {
          // a x + b x^2 through the three values, x from 0 to 1.
          const long double half = excess(middle) - at_from;
          const long double b    = 2.L * (at_to - at_from) - 4.L * half;
          const long double a    = (at_to - at_from) - b;
          const long double root =
            std::sqrt(std::max(0.L, a * a - 4.L * b * at_from));
          // This form of the root has no difference of nearly equal numbers.
          const long double sum = a + std::copysign(root, a);
          m = from + width * (sum == 0.L ? 0.L : -2.L * at_from / sum);
        }
      return {static_cast<double>(left.contact(m)),
              static_cast<double>(right.contact(m))};
    }
  } // namespace



  double
  ShiftedEnergy::value(const double s) const
  {
    unsigned int k = 0;
    while (k + 1 < pieces.size() && s < pieces[k].lower)
      ++k;
    return 0.5 * convexity * s * s + pieces[k].value(s);
  }



  long double
  ShiftedEnergy::least(const long double  r,
                       const double       lower,
                       const double       upper,
                       const unsigned int piece) const
  {
    using Limits = std::numeric_limits<long double>;

    const Piece      &p     = pieces[piece];
    const long double left  = std::max(lower, p.lower);
    const long double right = std::min(upper, p.upper);
    if (left > right)
      return Limits::infinity();
    // r s + f(s) on the piece is h + slope s + c/2 s^2.
    const long double c     = static_cast<long double>(convexity) + p.curvature;
    const long double slope = r + p.slope;
    // Of a concave piece one of the ends.
    const bool is_left_lower =
      c < 0.L ? slope + 0.5L * c * (left + right) > 0.L : slope > 0.L;
    const long double s = c > 0.L ?
                            std::min(std::max(-slope / c, left), right) :
                          is_left_lower ? left :
                                          right;
    // What falls towards minus infinity has no least value, and the bound is
    // useless but true.
    if (!std::isfinite(s))
      return -Limits::infinity();
    const long double square = 0.5L * c * s * s;
    // The value is a bound only if rounding cannot have raised it: each term is
    // off by a few units of its last digit, whatever their sum is.
    return slope * s + square + p.constant -
           16.L * Limits::epsilon() *
             (std::abs(p.constant) + std::abs(square) +
              (std::abs(r) + std::abs(p.slope)) * std::abs(s));
  }



  long double
  ShiftedEnergy::least(const long double r,
                       const double      lower,
                       const double      upper) const
  {
    long double result = std::numeric_limits<long double>::infinity();
    for (unsigned int k = 0; k < pieces.size(); ++k)
      result = std::min(result, least(r, lower, upper, k));
    return result;
  }



  ConvexEnvelope::ConvexEnvelope(const ShiftedEnergy &energy,
                                 const double         lower,
                                 const double         upper)
    : f(energy)
  {
    // Convex pieces on the envelope, each with the line to it; of concave ones
    // the ends.
    struct Step
    {
      Arc          arc;
      const Piece *piece;
      double       line_from, begin;
    };
    // As for the convex hull of points, from left to right: each arc that is
    // added takes with it those that the line to it passes below.
    std::vector<Step> steps;
    const auto        add = [&](const Arc &arc, const Piece &piece) {
      Step step = {arc,
                   &piece,
                   static_cast<double>(arc.lower),
                   static_cast<double>(arc.lower)};
      while (!steps.empty())
        {
          Step &last        = steps.back();
          Arc   left        = last.arc;
          left.lower        = last.begin;
          const Bridge line = bridge(left, arc);
          step.line_from    = line.first;
          step.begin        = line.second;
          // The line before passes below what is left of that piece.
          if (steps.size() == 1 || line.first > last.begin)
            break;
          steps.pop_back();
        }
      steps.push_back(step);
    };
    for (auto piece = f.pieces.rbegin(); piece != f.pieces.rend(); ++piece)
      {
        const double from = std::max(lower, piece->lower),
                     to   = std::min(upper, piece->upper);
        // A piece that meets the interval in one point has it in common with
        // its neighbour, which stands for it.
        if (from > to || (from == to && upper > lower))
          continue;
        const Parabola parabola(*piece, f.convexity);
        if (parabola.c >= 0.L)
          add({parabola, from, to}, *piece);
        else
          {
            add({parabola, from, from}, *piece);
            if (to > from)
              add({parabola, to, to}, *piece);
          }
      }

    // From the arcs that are left to parts: a line to each, and the arc as far
    // as to where the next line leaves it.
    for (unsigned int k = 0; k < steps.size(); ++k)
      {
        const Step  &step = steps[k];
        const double end  = k + 1 < steps.size() ?
                              steps[k + 1].line_from :
                              static_cast<double>(step.arc.upper);
        if (step.begin > step.line_from)
          parts.push_back({step.line_from,
                           step.begin,
                           (f.value(step.begin) - f.value(step.line_from)) /
                             (step.begin - step.line_from),
                           0.,
                           true});
        if (end > step.begin)
          parts.push_back({step.begin,
                           end,
                           step.piece->slope,
                           f.convexity + step.piece->curvature,
                           false});
      }
  }



  const ConvexEnvelope::Part *
  ConvexEnvelope::line_at(const double s) const
  {
    for (const Part &part : parts)
      if (part.is_line && s > part.lower && s < part.upper)
        return &part;
    return nullptr;
  }



  double
  ConvexEnvelope::value(const double s) const
  {
    // Off the lines the envelope is f.
    const Part *const line = line_at(s);
    return line == nullptr ?
             f.value(s) :
             f.value(line->lower) + line->slope * (s - line->lower);
  }



  double
  ConvexEnvelope::spread(const double s) const
  {
    const Part *const line = line_at(s);
    return line == nullptr ? 0. : (s - line->lower) * (line->upper - s);
  }



  RoundedEnergy::RoundedEnergy(const PiecewiseEnergy &f, const double D)
    : f(f)
  {
    // The envelope of f + D/2 s^2 differs from it on its lines alone.
    ShiftedEnergy energy = {D, {}};
    for (unsigned int k = 0; k < f.size(); ++k)
      energy.pieces.push_back(f[k]);
    if (f.size() == 1)
      return;
    // Further down there are no lines: those of the last kink, at s, with a
    // piece of curvature c before it end at s sqrt(1 + c / D).
    const double last_kink = f[f.size() - 1].upper;
    const double lowest = 4. * last_kink * std::sqrt(1. + f[0].curvature / D);
    for (const ConvexEnvelope::Part &part :
         ConvexEnvelope(energy, lowest, 0.).parts)
      if (part.is_line)
        lines.push_back({part.lower, part.upper});
  }



  PiecewiseEnergy
  RoundedEnergy::minimum() const
  {
    // In place of each line the parabola with the curvature of f on its far
    // side that meets f at both ends. A parabola c/2 s^2 + slope s through the
    // values at a and b has slope = (f(a) - f(b)) / (a - b) - c/2 (a + b).
    std::vector<EnergyPiece> pieces;
    // From the end of what there is already down to @p end.
    const auto add =
      [&pieces](const double curvature, const double slope, const double end) {
        if (end < (pieces.empty() ? 0. : pieces.back().end))
          pieces.push_back({curvature, slope, end, ""});
      };
    for (unsigned int k = 0; k < f.size(); ++k)
      {
        for (const Line &line : lines)
          if (const double a = line.upper, b = line.lower; f.index(a) == k)
            {
              const PiecewiseEnergy::Piece &far = f[f.index(b)];
              add(f[k].curvature, f[k].slope, a);
              add(far.curvature,
                  (f[k].value(a) - far.value(b)) / (a - b) -
                    0.5 * far.curvature * (a + b),
                  b);
            }
        add(f[k].curvature, f[k].slope, f[k].lower);
      }
    return PiecewiseEnergy(pieces);
  }



  bool
  RoundedEnergy::is_rounded_near(const double s) const
  {
    for (const Line &line : lines)
      {
        // The kink of a law without slopes is the geometric mean.
        const double margin = 0.1 * std::sqrt(line.lower * line.upper);
        if (s > line.lower - margin && s < line.upper + margin)
          return true;
      }
    return false;
  }



  std::optional<unsigned int>
  RoundedEnergy::exact_piece(const Interval &interval) const
  {
    for (const Line &line : lines)
      if (interval.upper > line.lower && interval.lower < line.upper)
        return {};
    // Kinks are on lines.
    return f.index(interval.upper);
  }
} // namespace Debond
