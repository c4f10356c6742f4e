// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/contact/bond_field.h>
#include <debond/mesh/field_value.h>

namespace Debond
{
  namespace
  {
    /// The value of @p field, or @p otherwise without one. Throws
    /// BondFieldError with the place, the name of the entry and that of the
    /// boundary if it is negative, or 0 and has to be more.
    template <int dim>
    double
    bond_value(const typename BondField<dim>::Field      &field,
               const double                               otherwise,
               const dealii::Point<dim>                  &point,
               const std::pair<std::string, std::string> &entry,
               const bool                                 may_be_zero)
    {
      // An expression can only be checked where it is evaluated. Therefore each
      // evaluation checks its value, and the error names the boundary and the
      // place.
      if (!field)
        return otherwise;
      try
        {
          // That of a stiffness that ends at zero.
          const double rounding =
            may_be_zero ? Tolerance::rounding_of_data * otherwise : 0.;
          const double value = nonnegative_value(*field, point, rounding);
          if (!may_be_zero && value == 0.)
            throw std::invalid_argument("it is 0 at " + point_text(point));
          return value;
        }
      catch (const std::invalid_argument &error)
        {
          throw BondFieldError(entry.first, entry.second, error.what());
        }
    }
  } // namespace



  template <int dim>
  BondField<dim>::BondField(
    const AdhesiveLaw                                 &law,
    const Bonds                                       &others,
    const std::map<dealii::types::boundary_id, Bonds> &boundaries,
    const ShearBonds                                  &shear)
    : law(law)
    , a(shear.is_relative ? 1. : law.curvature(0.))
    , M(law.pieces().size() > 1 ? -law.pieces()[0].lower : 0.)
    , stored(law.pieces().size() > 1 ? law.value(-M) : 0.)
    , taken(law.pieces().largest_value() - stored)
    , others(others)
    , boundaries(boundaries)
    , shear(shear)
  {}



  template <int dim>
  BondScale
  BondField<dim>::at(const dealii::Point<dim>        &point,
                     const dealii::types::boundary_id id) const
  {
    // A boundary without bonds of its own has those of all others.
    const auto   entry = boundaries.find(id);
    const Bonds &bonds = entry == boundaries.end() ? others : entry->second;
    const auto   value = [&](const Field       &field,
                           const double       otherwise,
                           const std::string &name,
                           const bool         may_be_zero = false) {
      return bond_value<dim>(
        field, otherwise, point, {name, bonds.boundary}, may_be_zero);
    };
    const double a_here = value(bonds.stiffness, a, "Bond stiffness", true);
    // What has no bonds breaks nowhere.
    if (a_here == 0.)
      return {0., 1.};
    // j of stiffness a and threshold M becomes energy j(s / length) of
    // stiffness energy a / length^2 and threshold length M.
    const double length =
      bonds.threshold ? value(bonds.threshold, M, "Bond threshold") / M : 1.;
    const double scale  = a_here / a;
    BondScale    result = {scale * length * length, length};
    const auto   refuse = [&](const std::string &name,
                            const std::string &boundary,
                            const double       least) {
      throw BondFieldError(
        name,
        boundary,
        words("it has to exceed strength^2 / (2 stiffness) = ",
              least,
              " at ",
              point_text(point),
              ", which a bond gives back when it breaks"));
    };
    if (bonds.energy)
      {
        const double whole = value(bonds.energy, 0., "Fracture energy");
        if (!(whole > (1. + Tolerance::brittle) * result.energy * stored))
          refuse("Fracture energy", bonds.boundary, result.energy * stored);
        result.tail = (whole / result.energy - stored) / taken;
      }
    const auto in_shear = shear.boundaries.find(id);
    if (in_shear == shear.boundaries.end())
      return result;
    // BondScale::shear is relative to the stiffness along the normal here,
    // a_here; energies and strengths that are numbers of their own are to what
    // these bonds have.
    const ShearNumbers &numbers  = in_shear->second;
    const double        of_shear = shear.is_relative ? scale : 1.;
    const double        whole = result.energy * (stored + result.tail * taken);
    result.shear = numbers.stiffness ? *numbers.stiffness * of_shear /
                                         (scale * law.second_derivative(0.)) :
                                       1.;
    if (!numbers.energy)
      return result;
    if (shear.are_separate)
      result.shear_energy =
        *numbers.energy * of_shear / law.pieces().largest_value();
    else
      result.energy_ratio = *numbers.energy * of_shear / whole;
    if (!numbers.strength)
      return result;
    result.strength_ratio = *numbers.strength * of_shear * result.length /
                            (law.bond_strength() * result.energy);
    // Without stiffness in shear there is only one mode. The others are tried
    // one by one, with that at which both tractions come to their strengths:
    // there the strength has a corner.
    constexpr unsigned int n_modes = 128;
    const double           corner =
      1. /
      (1. + result.shear / (result.strength_ratio * result.strength_ratio));
    for (unsigned int k = 0; k <= n_modes + 1 && result.shear > 0.; ++k)
      {
        const double m     = k > n_modes ? corner : double(k) / n_modes;
        const double n     = strength_at(result, m);
        const double least = n * n * result.energy * stored;
        if (!(energy_at(result, m) * whole > (1. + Tolerance::brittle) * least))
          refuse("Shear fracture energy", numbers.boundary, least);
      }
    return result;
  }



  template <int dim>
  double
  BondField<dim>::energy_at(const BondScale &bonds, const double m) const
  {
    // G(m) / G_I is 1 + (G_II / G_I - 1) m^eta by Benzeggagh and Kenane, and by
    // the power law ((1 - m)^eta + (m G_I / G_II)^eta)^(-1 / eta).
    const double power = shear.exponent;
    return shear.mixed_mode == MixedMode::benzeggagh_kenane ?
             1. + (bonds.energy_ratio - 1.) * std::pow(m, power) :
             std::pow(std::pow(1. - m, power) +
                        std::pow(m / bonds.energy_ratio, power),
                      -1. / power);
  }



  template <int dim>
  double
  BondField<dim>::strength_at(const BondScale &bonds, const double m) const
  {
    // At the opening l the traction along the normal is a l sqrt(1 - m), that
    // in shear a l sqrt(r m), r being the ratio of the stiffnesses. The
    // strength is the a l at which the criterion holds.
    const double opening = 1. - m;
    const double slip =
      bonds.shear * m / (bonds.strength_ratio * bonds.strength_ratio);
    return 1. / std::sqrt(shear.criterion == FailureCriterion::quadratic ?
                            opening + slip :
                            std::max(opening, slip));
  }



  template <int dim>
  BondScale
  BondField<dim>::at_mode(const BondScale &bonds, const double m) const
  {
    // With the stiffness that they have, bonds of n times the strength have n
    // times the length and n^2 times the energy on their first piece. Of a
    // strength that follows from the energies n^2 is their ratio; otherwise the
    // tail takes what remains of the energy.
    const double energy = energy_at(bonds, m);
    const double n =
      bonds.strength_ratio == 0. ? std::sqrt(energy) : strength_at(bonds, m);
    BondScale result = bonds;
    result.energy *= n * n;
    result.length *= n;
    // Between the modes that at() has tried it may be a little short of what
    // bonds have stored.
    if (bonds.strength_ratio > 0.)
      result.tail =
        std::max(Tolerance::brittle,
                 (energy * (stored + bonds.tail * taken) / (n * n) - stored) /
                   taken);
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(BondField);
} // namespace Debond
