// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_convex_envelope_h
#define debond_optimization_global_convex_envelope_h

#include <debond/optimization/branch_minimum.h>

#include <vector>

namespace Debond
{
  /// f(s) = c/2 s^2 + the least of some pieces of a BranchMinimum, c >= 0.
  struct BranchEnergy
  {
    double                            convexity; ///< c
    std::vector<BranchMinimum::Piece> pieces;    ///< from 0 downwards

    double
    value(const double s) const;

    /// The least value of r s + f(s) on [lower, upper] where the piece holds,
    /// less what rounding can do to its constant and slope; infinite if there
    /// is no such s.
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
   * The convex envelope of a BranchEnergy on [lower, upper], upper <= 0: parts
   * of its parabolas, and between them lines that touch the parabolas on both
   * sides as far as these reach.
   */
  class ConvexEnvelope
  {
  public:
    ConvexEnvelope(const BranchEnergy &f,
                   const double        lower,
                   const double        upper);

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

  private:
    BranchEnergy f;

    /// The line that has s inside, null if there is none.
    const Part *
    line_at(const double s) const;
  };
} // namespace Debond

#endif
