// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_bond_field_h
#define debond_contact_bond_field_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <debond/base/entry_error.h>
#include <debond/contact/law.h>

#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace Debond
{
  /// How what it takes to break bonds in all directions at once depends on the
  /// mode.
  enum class MixedMode
  {
    none,
    benzeggagh_kenane,
    power_law
  };

  /// Which tractions break bonds or begin to soften them: with a square sum of
  /// 1, as parts of the strengths, or one of them.
  enum class FailureCriterion
  {
    quadratic,
    largest
  };



  /// The bonds of a point: j_1(s) = energy j(s / length), j being the law that
  /// holds everywhere, with a tail of its own.
  struct BondScale
  {
    double energy = 1.;
    double length = 1.;

    /// The stiffness in shear over that along the normal: bonds have the
    /// opening sqrt(p^2 + shear |t|^2), with p that along the normal and t the
    /// displacement along the boundary.
    double shear = 0.;

    /// Unless it is 0, bonds in shear break by themselves, with this energy.
    double shear_energy = 0.;

    /// The factor of openings beyond the first piece, see
    /// AdhesiveLaw::with_tail().
    double tail = 1.;

    /// Where what bonds take depends on the mode: the fracture energy in shear
    /// over that of opening, and the strength in shear over that of opening,
    /// which is 0 if it follows from the energies.
    double energy_ratio = 1., strength_ratio = 0.;

    /// j, which ContactPoints sets.
    std::shared_ptr<const AdhesiveLaw> law = {};

    /// The bonds in shear of those that break by themselves.
    BondScale
    in_shear() const
    {
      BondScale result = *this;
      result.energy    = shear_energy;
      result.length *= std::sqrt(shear_energy / (shear * energy));
      result.shear        = 1.;
      result.shear_energy = 0.;
      return result;
    }

    /// Gives bonds this many times the energy, with the stiffness they have.
    void
    toughen(const double factor)
    {
      energy *= factor;
      length *= std::sqrt(factor);
    }
  };



  /// The bonds of a boundary in shear, in units of force and length.
  struct ShearNumbers
  {
    std::string boundary = {}; ///< with an energy of its own, its name
    std::optional<double> stiffness = {}; ///< none: as along the normal
    std::optional<double> strength  = {}; ///< none: follows from the energies
    std::optional<double> energy    = {}; ///< none if nothing needs it
  };



  /// How bonds bear shear.
  struct ShearBonds
  {
    /// The boundaries whose bonds do.
    std::map<dealii::types::boundary_id, ShearNumbers> boundaries = {};

    /// The numbers are multiplied by what the bonds of a point have of the
    /// law's stiffness.
    bool is_relative = false;

    /// Bonds in shear break by themselves.
    bool are_separate = false;

    /// How energy and strength depend on the part m of shear in what a bond has
    /// stored, between those of opening and those in shear; the exponent is
    /// that of the formula.
    MixedMode        mixed_mode = MixedMode::none;
    double           exponent   = 1.;
    FailureCriterion criterion  = FailureCriterion::quadratic;
  };



  /// A number of bonds that is none somewhere.
  class BondFieldError : public EntryError
  {
  public:
    /// @p entry: its name in the section Contact law.
    BondFieldError(const std::string &entry,
                   const std::string &boundary,
                   const std::string &message)
      : EntryError("Contact law/" + entry, message)
      , boundary(boundary)
    {}

    const std::string boundary; ///< Bonds::boundary
  };



  /**
   * Bonds that vary over Gamma_C, or that bear shear. Of a law of springs that
   * break or soften at a threshold, stiffness and threshold vary, which scale
   * it, and what it takes once it softens, which is its tail.
   */
  template <int dim>
  class BondField
  {
  public:
    using Field = std::shared_ptr<const dealii::Function<dim>>;

    /// The bonds of a boundary. A null field stands for what the law has.
    struct Bonds
    {
      std::string boundary; ///< its name; empty for those of all others
      Field       stiffness;
      Field       threshold; ///< the end of the first piece
      Field       energy;    ///< fracture energy
    };

    /// Keeps a reference to @p law. Stiffnesses are factors of it if those of
    /// @p shear are_relative.
    BondField(const AdhesiveLaw                                 &law,
              const Bonds                                       &others,
              const std::map<dealii::types::boundary_id, Bonds> &boundaries,
              const ShearBonds                                  &shear = {});

    /// At a point of the boundary @p id. Throws BondFieldError with the place
    /// if the stiffness is negative or not finite, the threshold of bonds not
    /// positive, or their energy less than what they have stored at their
    /// strength, in some mode.
    BondScale
    at(const dealii::Point<dim>        &point,
       const dealii::types::boundary_id id) const;

    /// Returns whether what bonds take depends on the mode.
    bool
    depends_on_mode() const
    {
      return shear.mixed_mode != MixedMode::none;
    }

    /// The bonds that have energy and strength of the part @p m of shear, with
    /// the stiffness of @p bonds, those of opening.
    BondScale
    at_mode(const BondScale &bonds, const double m) const;

  private:
    /// Returns the fracture energy with the part @p m of shear over that of
    /// opening, and below the strength over that of opening.
    double
    energy_at(const BondScale &bonds, const double m) const;

    double
    strength_at(const BondScale &bonds, const double m) const;

    const AdhesiveLaw &law;
    double             a, M;          ///< stiffness and threshold of the law
    double             stored, taken; ///< by the law on its first piece, later
    Bonds              others;
    std::map<dealii::types::boundary_id, Bonds> boundaries;
    ShearBonds                                  shear;
  };
} // namespace Debond

#endif
