// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/bond_field.h>
#include <debond/contact/field_value.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    double
    bond_value(const std::shared_ptr<const dealii::Function<dim>> &field,
               const double                                        everywhere,
               const dealii::Point<dim>                           &point,
               const bool                                          is_threshold)
    {
      if (!field)
        return everywhere;
      try
        {
          const double value = nonnegative_value(*field, point);
          if (is_threshold && value == 0.)
            throw std::invalid_argument("it is 0 at " + point_text(point));
          return value;
        }
      catch (const std::invalid_argument &error)
        {
          throw BondFieldError(is_threshold, error.what());
        }
    }
  } // namespace



  template <int dim>
  BondField<dim>::BondField(const double a,
                            const double M,
                            const Field &stiffness,
                            const Field &threshold)
    : a(a)
    , M(M)
    , stiffness(stiffness)
    , threshold(threshold)
  {}



  template <int dim>
  BondScale
  BondField<dim>::at(const dealii::Point<dim> &point) const
  {
    const double a_here = bond_value(stiffness, a, point, false);
    // What has no bonds breaks nowhere.
    if (a_here == 0.)
      return {0., 1.};
    const double stretch = bond_value(threshold, M, point, true) / M;
    return {a_here / a * stretch * stretch, stretch};
  }



  template class BondField<2>;
  template class BondField<3>;
} // namespace Debond
