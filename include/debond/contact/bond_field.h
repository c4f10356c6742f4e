// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_bond_field_h
#define debond_contact_bond_field_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace Debond
{
  /// The bonds of a point: j_1(s) = energy j(s / stretch), j being a law that
  /// holds everywhere.
  struct BondScale
  {
    double energy  = 1.;
    double stretch = 1.;
  };



  /// A stiffness or a threshold that is none somewhere.
  class BondFieldError : public std::invalid_argument
  {
  public:
    BondFieldError(const bool is_threshold, const std::string &message)
      : std::invalid_argument(message)
      , is_threshold(is_threshold)
    {}

    const bool is_threshold; ///< or a stiffness
  };



  /// Bonds of the law of winkler_law() whose stiffness a and threshold M vary
  /// over Gamma_C.
  template <int dim>
  class BondField
  {
  public:
    using Field = std::shared_ptr<const dealii::Function<dim>>;

    /// Relative to bonds of stiffness @p a and threshold @p M, which hold where
    /// a field is null.
    BondField(const double a,
              const double M,
              const Field &stiffness,
              const Field &threshold);

    /// Throws BondFieldError with the place if the stiffness is negative or not
    /// finite, or the threshold of bonds not positive.
    BondScale
    at(const dealii::Point<dim> &point) const;

  private:
    double a, M;
    Field  stiffness, threshold;
  };
} // namespace Debond

#endif
