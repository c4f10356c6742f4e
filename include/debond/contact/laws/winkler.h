// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_winkler_h
#define debond_contact_laws_winkler_h

#include <debond/contact/law.h>

namespace Debond
{
  /**
   * The paper's law, eq. (10): bonds are linear springs of stiffness a (force
   * per volume) that break at the displacement -M (length),
   *
   *     j_1(s) = a M^2 / 2  for s < -M,
   *              a s^2 / 2  for s in [-M, 0],
   *              0          for s > 0.
   *
   * The kink at -M is concave; at 0 only the second derivative jumps.
   */
  class WinklerLaw : public AdhesiveLaw
  {
  public:
    /// Throws std::invalid_argument unless a >= 0 and M > 0, both finite.
    WinklerLaw(const double bond_stiffness, const double bond_threshold);

    double
    value(const double s) const override;

    Interval
    clarke_interval(const double s) const override;

    double
    curvature(const double s) const override;

    LawShape
    shape() const override;

    std::vector<double>
    kinks() const override;

    /// M, or zero if a is zero.
    double
    bond_threshold() const override;

    double
    bond_strength() const override;

  private:
    const double a;
    const double M;
  };
} // namespace Debond

#endif
