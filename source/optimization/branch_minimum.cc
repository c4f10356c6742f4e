// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/branch_minimum.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();



    /// Where @p next falls below @p current as s falls; minus infinity if
    /// nowhere.
    long double
    crossing(const ConvexBranch &current, const ConvexBranch &next)
    {
      const long double A =
        static_cast<long double>(next.curvature) - current.curvature;
      const long double B =
        static_cast<long double>(next.slope) - current.slope;
      const long double C = next.constant - current.constant;
      // Of A/2 s^2 + B s + C the root with a positive derivative.
      const long double discriminant = B * B - 2.L * A * C;
      if (!(discriminant > 0.L))
        return -infinity;
      const long double root = std::sqrt(discriminant);
      if (B > 0.L)
        return -2.L * C / (B + root);
      return A != 0.L ? (root - B) / A : -infinity;
    }



    long double
    derivative(const ConvexBranch &branch, const long double s)
    {
      return branch.slope + branch.curvature * s;
    }



    /// Which of two branches that meet at s is lower below it.
    bool
    is_lower_below(const ConvexBranch &a,
                   const ConvexBranch &b,
                   const long double   s)
    {
      const long double of_a = derivative(a, s), of_b = derivative(b, s);
      return of_a != of_b ? of_a > of_b : a.curvature < b.curvature;
    }



    struct Successor
    {
      const ConvexBranch *branch;
      long double         end;
    };

    /// The branch that is the least below @p current, of those that meet there
    /// the lowest one, and where it begins.
    Successor
    successor(const std::vector<ConvexBranch> &branches,
              const Successor                 &current)
    {
      Successor result = {nullptr, -infinity};
      for (const ConvexBranch &branch : branches)
        {
          long double s = crossing(*current.branch, branch);
          if (s >= current.end)
            {
              // Three branches meet, at one point but for rounding.
              if (s > (1.L - Tolerance::same_crossing) * current.end ||
                  !is_lower_below(branch, *current.branch, current.end))
                continue;
              s = current.end;
            }
          if (s > result.end || (s == result.end && result.branch != nullptr &&
                                 is_lower_below(branch, *result.branch, s)))
            result = {&branch, s};
        }
      return result;
    }



    void
    require(const bool          condition,
            const ConvexBranch &branch,
            const std::string  &reason)
    {
      if (condition)
        return;
      std::ostringstream message;
      message << "The branch \"" << branch.name << "\", " << branch.constant
              << " + " << branch.slope << " s + " << branch.curvature
              << "/2 s^2, " << reason;
      throw std::invalid_argument(message.str());
    }
  } // namespace



  BranchMinimum::BranchMinimum(const std::vector<ConvexBranch> &branches)
  {
    if (branches.empty())
      throw std::invalid_argument("A minimum of branches needs a branch");
    for (const ConvexBranch &branch : branches)
      {
        require(std::isfinite(branch.curvature) &&
                  std::isfinite(branch.slope) && std::isfinite(branch.constant),
                branch,
                "is not finite");
        require(branch.curvature >= 0., branch, "is concave");
      }

    Successor current = {&branches[0], 0.L};
    for (const ConvexBranch &branch : branches)
      if (branch.constant < current.branch->constant ||
          (branch.constant == current.branch->constant &&
           is_lower_below(branch, *current.branch, 0.L)))
        current.branch = &branch;
    long double largest = 0.L;
    while (current.branch != nullptr)
      {
        const Successor next  = successor(branches, current);
        const double    lower = static_cast<double>(next.end),
                     upper    = static_cast<double>(current.end);
        if (lower < upper)
          {
            pieces.push_back(
              {current.branch->curvature,
               current.branch->slope,
               current.branch->constant,
               lower,
               upper,
               static_cast<unsigned int>(current.branch - branches.data())});
            largest = std::max(largest, current.branch->constant);
          }
        current = next;
      }

    require(pieces[0].constant == 0.L,
            branches[pieces[0].branch],
            "is the least at s = 0 and has to be zero there");
    connect();
    for (const Piece &piece : pieces)
      {
        // The least value, which rounding may take below zero.
        const double s =
          piece.curvature > 0. ?
            std::min(std::max(-piece.slope / piece.curvature, piece.lower),
                     piece.upper) :
            (piece.slope > 0. ? piece.lower : piece.upper);
        require(std::isfinite(s) &&
                  piece.value(s) >=
                    -Tolerance::negative_branch * static_cast<double>(largest),
                branches[piece.branch],
                "is negative where it is the least");
      }
  }



  BranchMinimum
  BranchMinimum::with_first_curvature(const double curvature,
                                      const double stretch) const
  {
    if (curvature == 0.)
      return BranchMinimum({{0., 0., 0.L, ""}});
    BranchMinimum result;
    result.pieces      = pieces;
    const double first = pieces[0].curvature;
    for (Piece &piece : result.pieces)
      {
        piece.curvature = piece.curvature / first * curvature;
        piece.slope     = piece.slope / first * curvature * stretch;
        piece.lower *= stretch;
        piece.upper *= stretch;
      }
    result.connect();
    return result;
  }



  unsigned int
  BranchMinimum::index(const double s) const
  {
    unsigned int k = 0;
    while (k + 1 < pieces.size() && s < pieces[k].lower)
      ++k;
    return k;
  }



  double
  BranchMinimum::largest_value() const
  {
    // The last piece rises as s falls, or it is flat.
    const Piece &last = pieces.back();
    if (last.curvature != 0. || last.slope != 0.)
      return infinity;
    double largest = 0.;
    for (const Piece &piece : pieces)
      largest = std::max(largest, piece.value(piece.upper));
    return largest;
  }



  double
  BranchMinimum::point_inside(const unsigned int piece) const
  {
    const Piece &p = pieces[piece];
    return std::isfinite(p.lower) ? (p.lower + p.upper) / 2. : 2. * p.upper;
  }



  void
  BranchMinimum::connect()
  {
    for (unsigned int k = 1; k < pieces.size(); ++k)
      {
        const Piece      &last = pieces[k - 1];
        const long double s    = last.lower;
        pieces[k].constant =
          last.constant +
          (static_cast<long double>(last.slope) - pieces[k].slope) * s +
          0.5L *
            (static_cast<long double>(last.curvature) - pieces[k].curvature) *
            s * s;
      }
  }
} // namespace Debond
