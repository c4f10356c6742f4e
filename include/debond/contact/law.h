// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_law_h
#define debond_contact_law_h

#include <debond/optimization/piecewise_energy.h>

#include <functional>
#include <map>

namespace Debond
{
  class ParameterTable;



  /**
   * An adhesive law: the superpotential j_1 of the normal displacement s =
   * u_nu (Section 3 of the paper, eq. (10)), a function of pieces for s <= 0
   * and zero for s > 0. The unilateral constraint s <= 0 is not part of it.
   *
   * Bonds that do not return to what they have left have @p reached, the least
   * s that they have been at, as their memory; 0 is none.
   *
   * Units: s in length, j_1 in energy per area, its derivatives accordingly.
   */
  class AdhesiveLaw
  {
  public:
    /// @p pieces from s = 0 downwards, with the names of bonds on them. Throws
    /// std::invalid_argument as PiecewiseEnergy does, and for a piece that
    /// pushes.
    explicit AdhesiveLaw(const std::vector<EnergyPiece> &pieces);

    /// The law with @p factor times the opening at each traction beyond the
    /// first piece, as far as it exceeds that of its end: of bonds that soften
    /// one of the same form with the same stiffness and strength.
    AdhesiveLaw
    with_tail(const double factor) const;

    /// The displacement at which bonds have the damage that bonds of @p other,
    /// a law with another tail, have at @p reached.
    double
    reached_as(const AdhesiveLaw &other, const double reached) const;

    /// j_1(s).
    double
    value(const double s, const double reached = 0.) const;

    /// The Clarke subdifferential of j_1 at s: a point away from the kinks.
    Interval
    clarke_interval(const double s, const double reached = 0.) const;

    /// The first derivative (at a kink: of the piece on the side of 0).
    double
    derivative(const double s, const double reached = 0.) const;

    /// The derivative at s over s, at 0 its limit, of a law that has one.
    double
    secant(const double s, const double reached = 0.) const
    {
      return s == 0. ? second_derivative(s, reached) :
                       derivative(s, reached) / s;
    }

    /// Returns the curvature of the flattest quadratic that touches j_1 at s,
    /// with this derivative, and is nowhere below it.
    double
    curvature(const double s, const double reached = 0.) const;

    /// The second derivative, of the piece as derivative() has it.
    double
    second_derivative(const double s, const double reached = 0.) const;

    /// The union of the Clarke intervals over [s - delta, s + delta]
    /// (Goldstein's subdifferential), its hull as an interval.
    Interval
    goldstein_interval(const double s,
                       const double delta,
                       const double reached = 0.) const;

    /// The damage() from which on bonds of a traction that decays are broken.
    static constexpr double broken_damage = 0.99;

    /// The part of their stiffness that bonds which have been at @p reached
    /// have lost for good, of their traction where that is no spring at first.
    double
    damage(const double reached) const;

    /// Returns whether somewhere the traction falls while bonds open.
    bool
    softens() const
    {
      return energy_pieces.softens();
    }

    /// Returns the places where j_1 is not twice differentiable, in ascending
    /// order.
    std::vector<double>
    kinks() const;

    /// j_1 on s <= 0, without a memory.
    const PiecewiseEnergy &
    pieces() const
    {
      return energy_pieces;
    }

    /// The name of bonds on a piece of pieces().
    const std::string &
    name(const unsigned int piece) const
    {
      return names[piece];
    }

    /// Returns whether bonds on a piece of pieces() do not pull at all.
    bool
    is_loose(const unsigned int piece) const
    {
      return energy_pieces[piece].is_flat();
    }

    /// The displacement below which bonds are on the last piece, as a positive
    /// length (the paper's M); zero if there is no other.
    double
    bond_threshold() const;

    /// The opening beyond which bonds count as broken: bond_threshold() where
    /// they bear nothing then, the one at which damage() comes to 0.99 where
    /// the traction decays, infinite where bonds hold at any distance.
    double
    broken_beyond() const
    {
      return largest_opening;
    }

    /// The largest adhesive traction before the last kink, in force per area
    /// (the paper's a M); zero if there is no adhesion.
    double
    bond_strength() const;

  private:
    /// Evaluates the piece that holds; 0 for s > 0 without a memory.
    template <typename Number>
    double
    on_piece(const double s, const double reached, const Number &number) const;

    PiecewiseEnergy          energy_pieces;
    std::vector<std::string> names;
    double                   largest_opening; ///< broken_beyond()
  };



  /// A law by the numbers of its pieces.
  struct ContactLawParameters
  {
    std::string              name; ///< one of law_names()
    std::vector<EnergyPiece> pieces;
    std::string              data; ///< in words, empty if there is none

    /// Expressions for bonds whose stiffness, threshold or fracture energy
    /// vary, empty where it does not: `pieces` have others in their place. The
    /// threshold is the end of the first piece, and the energy is for bonds
    /// that soften.
    std::string stiffness = {}, threshold = {}, energy = {};

    /// True if bonds that vary are given by stiffness and threshold themselves;
    /// otherwise `stiffness` is a factor of all pieces.
    bool is_by_stiffness = false;

    /// The entry that `stiffness` is from.
    std::string stiffness_entry = "Contact law/Bond stiffness";

    /// The bonds of one boundary, numbers or expressions.
    struct Bonds
    {
      std::string stiffness, threshold, energy = {};
    };

    /// By the names of the boundaries.
    std::map<std::string, Bonds> boundaries = {};

    /// Returns whether bonds are not the same everywhere.
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

    std::string entries = {}; ///< these, and those that it has of others
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
