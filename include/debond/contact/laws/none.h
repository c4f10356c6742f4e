// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_none_h
#define debond_contact_laws_none_h

#include <debond/contact/law.h>

namespace Debond
{
  /// No adhesion, j_1 = 0: with the unilateral constraint, Signorini's law.
  class NoAdhesion : public AdhesiveLaw
  {
  public:
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

    double
    bond_threshold() const override;

    double
    bond_strength() const override;
  };
} // namespace Debond

#endif
