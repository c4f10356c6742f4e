// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/global/convex_envelope.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    using Piece = BranchMinimum::Piece;

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



    /// Where a line from the point (s, value) touches a parabola above it, to
    /// the right or to the left of s. Infinite for a line.
    long double
    touch(const long double s, const long double value, const Parabola &p)
    {
      const long double above = std::max(0.L, p(s) - value);
      return p.c > 0.L ? std::sqrt(2.L * above / p.c) :
                         std::numeric_limits<long double>::infinity();
    }



    struct CommonTangent
    {
      double first, second; ///< where it touches the parabolas
    };

    /// Of two parabolas, of which @p left is below the other one to the left of
    /// their crossing @p kink, on [lower, upper].
    CommonTangent
    common_tangent(const Parabola   &left,
                   const Parabola   &right,
                   const long double kink,
                   const double      lower,
                   const double      upper)
    {
      const long double jump = (left.c - right.c) * kink + (left.b - right.b);
      const long double root_left  = std::sqrt(left.c);
      const long double root_right = std::sqrt(right.c);
      if (!(jump > 0.L))
        return {static_cast<double>(kink), static_cast<double>(kink)};
      const long double d     = jump / (root_left + root_right);
      long double       first = left.c > 0.L ?
                                  std::max<long double>(lower, kink - d / root_left) :
                                  lower;
      long double       second =
        right.c > 0.L ? std::min<long double>(upper, kink + d / root_right) :
                              upper;
      if (first == lower)
        second =
          std::min<long double>(upper,
                                lower + touch(lower, left(lower), right));
      if (second == upper && left.c > 0.L)
        first = std::max<long double>(lower,
                                      upper - touch(upper, right(upper), left));
      return {static_cast<double>(first), static_cast<double>(second)};
    }



    /// Where @p left gets above @p right as s grows.
    long double
    crossing(const Parabola &left, const Parabola &right)
    {
      const long double A = right.c - left.c, B = right.b - left.b,
                        C    = right.h - left.h;
      const long double root = std::sqrt(std::max(0.L, B * B - 2.L * A * C));
      return A != 0.L && B >= 0.L ? -(B + root) / A : -2.L * C / (B - root);
    }



  } // namespace



  double
  BranchEnergy::value(const double s) const
  {
    unsigned int k = 0;
    while (k + 1 < pieces.size() && s < pieces[k].lower)
      ++k;
    return 0.5 * convexity * s * s + pieces[k].value(s);
  }



  long double
  BranchEnergy::least(const long double  r,
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
    const long double c     = static_cast<long double>(convexity) + p.curvature;
    const long double slope = r + p.slope;
    const long double s     = c > 0.L ?
                                std::min(std::max(-slope / c, left), right) :
                              slope > 0.L ? left :
                                            right;
    if (!std::isfinite(s))
      return -Limits::infinity();
    const long double square = 0.5L * c * s * s;
    return slope * s + square + p.constant -
           16.L * Limits::epsilon() *
             (std::abs(p.constant) + square +
              (std::abs(r) + std::abs(p.slope)) * std::abs(s));
  }



  long double
  BranchEnergy::least(const long double r,
                      const double      lower,
                      const double      upper) const
  {
    long double result = std::numeric_limits<long double>::infinity();
    for (unsigned int k = 0; k < pieces.size(); ++k)
      result = std::min(result, least(r, lower, upper, k));
    return result;
  }



  ConvexEnvelope::ConvexEnvelope(const BranchEnergy &energy,
                                 const double        lower,
                                 const double        upper)
    : f(energy)
  {
    // A parabola on the envelope, from where the line before it touches it.
    struct Arc
    {
      const Piece *piece;
      double       line_from, lower;
    };
    std::vector<Arc> arcs;
    for (auto piece = f.pieces.rbegin(); piece != f.pieces.rend(); ++piece)
      {
        if (piece->upper <= lower && piece + 1 != f.pieces.rend())
          continue;
        if (piece->lower >= upper && !arcs.empty())
          break;
        const Parabola right(*piece, f.convexity);
        Arc            arc = {&*piece, lower, lower};
        while (!arcs.empty())
          {
            // Neighbours meet where the pieces say, to the last digit.
            const Parabola left(*arcs.back().piece, f.convexity);
            const bool     are_neighbours = arcs.back().piece == &*piece + 1;
            const CommonTangent tangent =
              common_tangent(left,
                             right,
                             are_neighbours ? piece->lower :
                                              crossing(left, right),
                             lower,
                             upper);
            arc.line_from = tangent.first;
            arc.lower     = tangent.second;
            // The line before passes below this parabola.
            if (arcs.size() == 1 || tangent.first > arcs.back().lower)
              break;
            arcs.pop_back();
          }
        arcs.push_back(arc);
      }

    for (unsigned int k = 0; k < arcs.size(); ++k)
      {
        const Arc   &arc = arcs[k];
        const double end = k + 1 < arcs.size() ? arcs[k + 1].line_from : upper;
        if (arc.lower > arc.line_from)
          parts.push_back({arc.line_from,
                           arc.lower,
                           (f.value(arc.lower) - f.value(arc.line_from)) /
                             (arc.lower - arc.line_from),
                           0.,
                           true});
        if (end > arc.lower)
          parts.push_back({arc.lower,
                           end,
                           arc.piece->slope,
                           f.convexity + arc.piece->curvature,
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



  RoundedBranches::RoundedBranches(const BranchMinimum &f, const double D)
    : f(f)
  {
    BranchEnergy energy = {D, {}};
    for (unsigned int k = 0; k < f.size(); ++k)
      energy.pieces.push_back(f[k]);
    if (f.size() == 1)
      return;
    // Further down there are no lines: those of the last kink, at s, with a
    // branch of curvature c before it end at s sqrt(1 + c / D).
    const double last_kink = f[f.size() - 1].upper;
    const double lowest = 4. * last_kink * std::sqrt(1. + f[0].curvature / D);
    for (const ConvexEnvelope::Part &part :
         ConvexEnvelope(energy, lowest, 0.).parts)
      if (part.is_line)
        lines.push_back({part.lower, part.upper});
  }



  BranchMinimum
  RoundedBranches::minimum() const
  {
    std::vector<ConvexBranch> branches;
    for (unsigned int k = 0; k < f.size(); ++k)
      branches.push_back({f[k].curvature, f[k].slope, f[k].constant, ""});
    for (const Line &line : lines)
      {
        const BranchMinimum::Piece &near = f[f.index(line.upper)];
        const BranchMinimum::Piece &far  = f[f.index(line.lower)];
        const long double           a = line.upper, b = line.lower;
        const auto value = [](const BranchMinimum::Piece &piece,
                              const long double           s) {
          return piece.constant +
                 s * (piece.slope + 0.5L * piece.curvature * s);
        };
        const long double slope = (value(near, a) - value(far, b)) / (a - b) -
                                  0.5L * far.curvature * (a + b);
        long double constant =
          value(near, a) - a * (slope + 0.5L * far.curvature * a);
        // Branches without slopes have the constant of the near one here.
        const long double rounding = Tolerance::same_constant * value(far, b);
        if (std::abs(constant - near.constant) < rounding)
          constant = near.constant;
        branches.push_back(
          {far.curvature, static_cast<double>(slope), constant, ""});
      }
    return BranchMinimum(branches);
  }



  bool
  RoundedBranches::is_rounded_near(const double s) const
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
  RoundedBranches::exact_piece(const Interval &interval) const
  {
    for (const Line &line : lines)
      if (interval.upper > line.lower && interval.lower < line.upper)
        return {};
    // Kinks are on lines.
    return f.index(interval.upper);
  }
} // namespace Debond
