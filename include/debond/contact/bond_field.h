// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_bond_field_h
#define debond_contact_bond_field_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <debond/base/entry_error.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace Debond
{
  /// The bonds of a point: j_1(s) = energy j(s / length), j being a law that
  /// holds everywhere.
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

    /// The bonds in shear of those that break by themselves.
    BondScale
    in_shear() const
    {
      return {shear_energy,
              length * std::sqrt(shear_energy / (shear * energy)),
              1.};
    }

    /// Gives bonds this many times the energy, with the stiffness they have.
    void
    toughen(const double factor)
    {
      energy *= factor;
      length *= std::sqrt(factor);
    }
  };



  /// How bonds bear shear.
  struct ShearBonds
  {
    /// The boundaries whose bonds do.
    std::set<dealii::types::boundary_id> boundaries = {};

    /// Over the stiffness of the law itself; none: as along the normal.
    std::optional<double> stiffness = {};

    /// BondScale::shear_energy.
    double energy = 0.;

    /// Both are multiplied by what the bonds of a point have of the law's
    /// stiffness.
    bool is_relative = false;

    /// The fracture energy over that of opening, by the part of shear in what a
    /// bond has stored and by BondScale::energy; empty if it is always the
    /// same.
    std::function<double(double, double)> toughness = {};
  };



  /// A stiffness or a threshold that is none somewhere.
  class BondFieldError : public EntryError
  {
  public:
    BondFieldError(const bool         is_threshold,
                   const std::string &boundary,
                   const std::string &message)
      : EntryError(is_threshold ? "Contact law/Bond threshold" :
                                  "Contact law/Bond stiffness",
                   message)
      , is_threshold(is_threshold)
      , boundary(boundary)
    {}

    const bool        is_threshold; ///< or a stiffness
    const std::string boundary;     ///< Bonds::boundary
  };



  /// Bonds of the law of winkler_law() whose stiffness a and threshold M vary
  /// over Gamma_C.
  template <int dim>
  class BondField
  {
  public:
    using Field = std::shared_ptr<const dealii::Function<dim>>;

    /// The bonds of a boundary. A null field stands for the a or M of
    /// BondField().
    struct Bonds
    {
      std::string boundary; ///< its name; empty for those of all others
      Field       stiffness;
      Field       threshold;
    };

    /// Relative to bonds of stiffness @p a and threshold @p M.
    BondField(const double                                       a,
              const double                                       M,
              const Bonds                                       &others,
              const std::map<dealii::types::boundary_id, Bonds> &boundaries,
              const ShearBonds                                  &shear = {})
      : a(a)
      , M(M)
      , others(others)
      , boundaries(boundaries)
      , shear(shear)
    {}

    /// At a point of the boundary @p id. Throws BondFieldError with the place
    /// if the stiffness is negative or not finite, or the threshold of bonds
    /// not positive.
    BondScale
    at(const dealii::Point<dim>        &point,
       const dealii::types::boundary_id id) const;

    const ShearBonds &
    shear_bonds() const
    {
      return shear;
    }

  private:
    double                                      a, M;
    Bonds                                       others;
    std::map<dealii::types::boundary_id, Bonds> boundaries;
    ShearBonds                                  shear;
  };
} // namespace Debond

#endif
