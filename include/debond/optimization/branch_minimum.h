// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_branch_minimum_h
#define debond_optimization_branch_minimum_h

#include <limits>
#include <string>
#include <vector>

namespace Debond
{
  /// constant + slope s + curvature/2 s^2, s <= 0. The constant has more digits
  /// than a double, so that the kinks between branches are where they are meant
  /// to be.
  struct ConvexBranch
  {
    double      curvature;
    double      slope;
    long double constant;
    std::string name;
  };



  /**
   * f(s) = the least of convex branches at s <= 0, with f >= f(0) = 0: a list
   * of pieces in the order in which they follow each other from 0 downwards. At
   * the kink between two pieces the one on the side of 0 is the one that holds,
   * here and wherever a branch is chosen.
   */
  class BranchMinimum
  {
  public:
    struct Piece
    {
      double       curvature, slope;
      long double  constant;
      double       lower, upper; ///< where it is the least
      unsigned int branch;       ///< its number in the given list

      double
      value(const double s) const
      {
        return curvature * s * s / 2. + slope * s +
               static_cast<double>(constant);
      }

      double
      derivative(const double s) const
      {
        return curvature * s + slope;
      }
    };

    /// Pieces from kink to kink; branches that are nowhere the least have
    /// none. Throws std::invalid_argument if a branch is concave or not finite,
    /// or if not f >= f(0) = 0.
    explicit BranchMinimum(const std::vector<ConvexBranch> &branches);

    /// c f(s / stretch) with the c for which the first piece, which has to have
    /// a curvature here, has the given one; the single piece zero if that is
    /// zero.
    BranchMinimum
    with_first_curvature(const double curvature,
                         const double stretch = 1.) const;

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

    /// A point inside a piece, on the last one at twice its kink.
    double
    point_inside(const unsigned int piece) const;

  private:
    BranchMinimum() = default;

    /// Constants for which the function is continuous at the kinks as they are
    /// in doubles.
    void
    connect();

    std::vector<Piece> pieces;
  };
} // namespace Debond

#endif
