// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_law_h
#define debond_contact_law_h

#include <debond/optimization/branch_minimum.h>
#include <debond/optimization/interval.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace Debond
{
  class ParameterTable;



  /**
   * An adhesive law: the superpotential j_1 of the normal displacement s =
   * u_nu (Section 3 of the paper, eq. (10)), which is the least of convex
   * branches for s <= 0 and zero for s > 0. The unilateral constraint s <= 0
   * is not part of it.
   *
   * Units: s in length, j_1 in energy per area, its derivatives accordingly.
   */
  class AdhesiveLaw
  {
  public:
    /// @p branches in any order, with the names of bonds on them. Throws
    /// std::invalid_argument as BranchMinimum does.
    explicit AdhesiveLaw(const std::vector<ConvexBranch> &branches);

    /// j_1(s).
    double
    value(const double s) const;

    /// The Clarke subdifferential of j_1 at s: a point away from the kinks.
    Interval
    clarke_interval(const double s) const;

    /// The first and the second derivative of the branch that holds at s (at a
    /// kink: of the one on the side of 0).
    double
    derivative(const double s) const;

    double
    curvature(const double s) const;

    /// The union of the Clarke intervals over [s - delta, s + delta]
    /// (Goldstein's subdifferential), its hull as an interval.
    Interval
    goldstein_interval(const double s, const double delta) const;

    /// The same for a bond that has left the pieces before @p least for good:
    /// that piece holds towards 0 as well.
    double
    value(const double s, const unsigned int least) const;

    double
    derivative(const double s, const unsigned int least) const;

    double
    curvature(const double s, const unsigned int least) const;

    Interval
    goldstein_interval(const double       s,
                       const double       delta,
                       const unsigned int least) const;

    /// Where j_1 is not twice differentiable, in ascending order.
    std::vector<double>
    kinks() const;

    /// j_1 on s <= 0.
    const BranchMinimum &
    branches() const;

    /// The name of bonds on a piece of branches().
    const std::string &
    name(const unsigned int piece) const;

    /// Whether bonds on a piece of branches() do not pull at all.
    bool
    is_loose(const unsigned int piece) const;

    /// The displacement below which bonds are on the last branch, as a positive
    /// length (the paper's M); zero if there is no other.
    double
    bond_threshold() const;

    /// The largest adhesive traction before the last kink, in force per area
    /// (the paper's a M); zero if there is no adhesion.
    double
    bond_strength() const;

  private:
    /// Whether such a bond is on the piece @p least at s.
    bool
    is_before(const double s, const unsigned int least) const;

    Interval
    clarke_interval(const double s, const unsigned int least) const;

    BranchMinimum            minimum;
    std::vector<std::string> names;
  };



  /// A law by the numbers of its branches.
  struct ContactLawParameters
  {
    std::string               name; ///< one of law_names()
    std::vector<ConvexBranch> branches;
    std::string               data; ///< in words, empty if there is none

    /// Expressions for bonds whose stiffness or threshold vary, empty where it
    /// does not: `branches` have 1 in their place.
    std::string stiffness = {}, threshold = {};

    /// Where `stiffness` is from. Of laws that are not winkler_law() it is a
    /// factor of all their branches.
    std::string stiffness_entry = "Contact law/Bond stiffness";

    /// Of the bonds of one boundary, numbers or expressions.
    struct Bonds
    {
      std::string stiffness, threshold;
    };

    /// By the names of the boundaries.
    std::map<std::string, Bonds> boundaries = {};

    /// Whether bonds are not the same everywhere.
    bool
    has_field() const
    {
      return !stiffness.empty() || !threshold.empty() || !boundaries.empty();
    }
  };

  /// Makes a law of entries that have been read. What is wrong with them is
  /// added to the table's errors, and then the result does not matter.
  using LawMaker = std::function<ContactLawParameters(ParameterTable &)>;

  /// A kind of law that scenes can have: one for each file in laws/.
  struct LawKind
  {
    std::string name;
    std::string description; ///< a part of a sentence, the name in front of it

    /// Binds its own entries to variables of the maker.
    LawMaker (*bind)(ParameterTable &table);

    std::string entries = {}; ///< these: paths, or a section, "A/B/"
  };

  /// The names of all kinds, for messages.
  std::vector<std::string>
  law_names();



  /// The entry Contact law/Law of a scene and those of all kinds.
  class LawSection
  {
  public:
    LawSection();

    void
    bind(ParameterTable &table);

    /// After table.parse().
    ContactLawParameters
    make_law(ParameterTable &table) const;

  private:
    std::string                     name;
    std::map<std::string, LawMaker> makers; ///< by name
  };
} // namespace Debond

#endif
