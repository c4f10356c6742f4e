// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_field_value_h
#define debond_mesh_field_value_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

namespace Debond
{
  /// "(0.1, 0)"
  template <int dim>
  std::string
  point_text(const dealii::Point<dim> &point)
  {
    std::ostringstream text;
    for (unsigned int d = 0; d < dim; ++d)
      text << (d == 0 ? "(" : ", ") << point[d];
    text << ")";
    return text.str();
  }



  /// The value. Throws std::invalid_argument with the place if it is not
  /// finite.
  template <int dim>
  double
  finite(const double value, const dealii::Point<dim> &point)
  {
    if (!std::isfinite(value))
      throw std::invalid_argument(std::string("it is not finite, ") +
                                  (std::isnan(value) ? "nan" :
                                   value > 0.        ? "inf" :
                                                       "-inf") +
                                  ", at " + point_text(point));
    return value;
  }



  /// A component of a field. Throws std::invalid_argument with the place if it
  /// is not finite there.
  template <int dim>
  double
  field_value(const dealii::Function<dim> &field,
              const dealii::Point<dim>    &point,
              const unsigned int           component = 0)
  {
    double value = std::numeric_limits<double>::quiet_NaN();
    try
      {
        value = field.value(point, component);
      }
    catch (const std::exception &)
      {
        // muParser's functions throw outside of their domains.
      }
    return finite(value, point);
  }



  /// A field with dim components; throws likewise.
  template <int dim>
  dealii::Tensor<1, dim>
  field_vector(const dealii::Function<dim> &field,
               const dealii::Point<dim>    &point)
  {
    AssertDimension(field.n_components, dim);
    dealii::Tensor<1, dim> result;
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = field_value(field, point, d);
    return result;
  }



  /// A field that must not be negative, but for @p rounding, which stands for
  /// zero. Throws as field_value() does.
  template <int dim>
  double
  nonnegative_value(const dealii::Function<dim> &field,
                    const dealii::Point<dim>    &point,
                    const double                 rounding = 0.)
  {
    const double value = field_value(field, point);
    if (value < -rounding)
      {
        std::ostringstream text;
        text << "it is negative, " << value << ", at " << point_text(point);
        throw std::invalid_argument(text.str());
      }
    return std::max(value, 0.);
  }
} // namespace Debond

#endif
