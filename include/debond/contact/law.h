// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_law_h
#define debond_contact_law_h

#include <debond/optimization/interval.h>

#include <memory>
#include <string>
#include <vector>

namespace Debond
{
  /// What search and proof need to know of a law.
  enum class LawShape
  {
    convex,       ///< there is one minimum
    two_branches, ///< a/2 min(s^2, M^2) for s <= 0
    other
  };



  /**
   * An adhesive law: the superpotential j_1 of the normal displacement s =
   * u_nu (Section 3 of the paper, eq. (10)), a function that is quadratic
   * between its kinks. The unilateral constraint s <= 0 is not part of it.
   *
   * Units: s in length, j_1 in energy per area, its derivatives accordingly.
   */
  class AdhesiveLaw
  {
  public:
    virtual ~AdhesiveLaw() = default;

    /// j_1(s).
    virtual double
    value(const double s) const = 0;

    /// The Clarke subdifferential of j_1 at s: a point away from the kinks.
    virtual Interval
    clarke_interval(const double s) const = 0;

    /// The second derivative of the branch that holds s (at a kink: of the
    /// branch on the side of the bonded state).
    virtual double
    curvature(const double s) const = 0;

    /// `other` unless the law says more: nothing is proved of it then.
    virtual LawShape
    shape() const;

    /// Where j_1 is not twice differentiable, in ascending order.
    virtual std::vector<double>
    kinks() const = 0;

    /// The displacement below which all bonds are broken, as a positive
    /// length (the paper's M); zero if there is no adhesion.
    virtual double
    bond_threshold() const = 0;

    /// The largest adhesive traction, in force per area (the paper's a M);
    /// zero if there is no adhesion.
    virtual double
    bond_strength() const = 0;

    /// The union of the Clarke intervals over [s - delta, s + delta]
    /// (Goldstein's subdifferential), its hull as an interval.
    Interval
    goldstein_interval(const double s, const double delta) const;
  };



  /// What a law may be built from, in the user's units.
  struct ContactLawParameters
  {
    std::string name           = "winkler";
    double      bond_stiffness = 69.;   ///< a, force per volume
    double      bond_threshold = 0.002; ///< M, length
  };

  /// The names that make_law() knows, for input patterns and error messages.
  std::vector<std::string>
  law_names();

  /// The law of the given name. Throws std::invalid_argument if the name is
  /// not one of law_names().
  std::unique_ptr<AdhesiveLaw>
  make_law(const ContactLawParameters &parameters);
} // namespace Debond

#endif
