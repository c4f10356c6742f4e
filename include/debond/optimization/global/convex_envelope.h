// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_convex_envelope_h
#define debond_optimization_global_convex_envelope_h

namespace Debond
{
  /// f(s) = c/2 s^2 + k/2 min(s^2, M^2), c, k >= 0.
  struct BondEnergy
  {
    double convexity; ///< c
    double stiffness; ///< k
    double threshold; ///< M

    double
    value(const double s) const;

    long double
    energy_if_broken() const;

    /// The least value of r s + f(s) on [lower, upper] where the bond is
    /// bonded (s >= -M) and where it is broken (s <= -M); infinite if there
    /// is no such s.
    long double
    least_bonded(const long double r,
                 const double      lower,
                 const double      upper) const;

    long double
    least_broken(const long double r,
                 const double      lower,
                 const double      upper) const;

    /// The lower one, less what rounding can do to the energy of the broken
    /// bond.
    long double
    least(const long double r, const double lower, const double upper) const;
  };



  /**
   * The convex envelope of a BondEnergy on [lower, upper], upper <= 0: the
   * broken parabola up to `first`, a line, and the bonded parabola from
   * `second` on. Where the bond cannot break or cannot hold, one of the
   * parabolas is all of it.
   */
  class ConvexEnvelope
  {
  public:
    ConvexEnvelope(const BondEnergy &f, const double lower, const double upper);

    double
    value(const double s) const;

    /// (s - first)(second - s) on the line, zero elsewhere: twice the
    /// derivative of the envelope less c/2 s^2 with respect to c.
    double
    spread(const double s) const;

    /// The envelope's derivative is slope + curvature s on each piece.
    struct Piece
    {
      double lower, upper;
      double slope, curvature;
    };

    /// Broken, line, bonded; some may be empty.
    Piece pieces[3];

  private:
    BondEnergy f;
  };
} // namespace Debond

#endif
