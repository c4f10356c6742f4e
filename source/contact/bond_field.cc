// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/contact/bond_field.h>
#include <debond/mesh/field_value.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    double
    bond_value(const typename BondField<dim>::Bonds &bonds,
               const double                          everywhere,
               const dealii::Point<dim>             &point,
               const bool                            is_threshold)
    {
      // An expression can only be checked where it is evaluated. Therefore each
      // evaluation checks its value, and the error names the boundary and the
      // place.
      const auto &field = is_threshold ? bonds.threshold : bonds.stiffness;
      if (!field)
        return everywhere;
      try
        {
          // That of a stiffness that ends at zero.
          const double rounding =
            is_threshold ? 0. : Tolerance::rounding_of_data * everywhere;
          const double value = nonnegative_value(*field, point, rounding);
          if (is_threshold && value == 0.)
            throw std::invalid_argument("it is 0 at " + point_text(point));
          return value;
        }
      catch (const std::invalid_argument &error)
        {
          throw BondFieldError(is_threshold, bonds.boundary, error.what());
        }
    }
  } // namespace



  template <int dim>
  BondScale
  BondField<dim>::at(const dealii::Point<dim>        &point,
                     const dealii::types::boundary_id id) const
  {
    // A boundary without bonds of its own has those of all others.
    const auto   entry  = boundaries.find(id);
    const Bonds &bonds  = entry == boundaries.end() ? others : entry->second;
    const double a_here = bond_value<dim>(bonds, a, point, false);
    // What has no bonds breaks nowhere.
    if (a_here == 0.)
      return {0., 1.};
    // j of stiffness a and threshold M becomes energy j(s / length) of
    // stiffness energy a / length^2 and threshold length M.
    const double length = bond_value<dim>(bonds, M, point, true) / M;
    const double scale  = a_here / a;
    BondScale    result = {scale * length * length, length};
    if (shear.boundaries.count(id) > 0)
      {
        // BondScale::shear is relative to the stiffness along the normal here,
        // a_here.
        const double of_shear = shear.is_relative ? scale : 1.;
        result.shear =
          shear.stiffness ? *shear.stiffness * of_shear / scale : 1.;
        result.shear_energy = shear.energy * of_shear;
      }
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(BondField);
} // namespace Debond
