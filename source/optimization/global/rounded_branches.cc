// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/global/rounded_branches.h>

#include <cmath>

namespace Debond
{
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
        const long double rounding = 1e-12L * value(far, b);
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
