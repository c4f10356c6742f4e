// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/broken_zone.h>

#include <algorithm>
#include <array>

namespace Debond
{
  namespace
  {
    /// The part of a simplex where a linear function with these values at the
    /// vertices is positive.
    template <std::size_t n>
    double
    positive_part(std::array<double, n> values)
    {
      std::sort(values.begin(), values.end());
      if (values.back() <= 0.)
        return 0.;
      if (values.front() >= 0.)
        return 1.;
      // The corner on the one side of zero that has only one vertex.
      const bool   one_is_positive = values[n - 2] <= 0.;
      const double corner = one_is_positive ? values.back() : values.front();
      double       part   = 1.;
      for (const double value : values)
        if (value != corner)
          part *= corner / (corner - value);
      return one_is_positive ? part : 1. - part;
    }
  } // namespace



  template <int dim>
  double
  broken_zone(const ContactBoundary<dim>   &boundary,
              const AdhesiveLaw            &law,
              const AdhesionIntegral<dim>  &adhesion,
              const dealii::Vector<double> &s)
  {
    const unsigned int last = law.branches().size() - 1;
    // Bonds that hold at any distance are never broken.
    if (last == 0 && !law.is_loose(0))
      return 0.;

    double sum = 0.;
    for (const auto &face : boundary.faces)
      {
        std::array<double, dim> beyond;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const BondScale bonds = adhesion.bonds_at(face, k);
            const bool      is_loose =
              bonds.energy == 0. || adhesion.least_piece_at(face, k) == last;
            beyond[k] = -adhesion.trace_at(face, k, s) -
                        (is_loose ? 0. : law.bond_threshold() * bonds.stretch);
          }
        // Closed cracks are not open.
        sum += face.measure * positive_part(beyond);
      }
    return sum;
  }



  template double
  broken_zone(const ContactBoundary<2> &,
              const AdhesiveLaw &,
              const AdhesionIntegral<2> &,
              const dealii::Vector<double> &);
  template double
  broken_zone(const ContactBoundary<3> &,
              const AdhesiveLaw &,
              const AdhesionIntegral<3> &,
              const dealii::Vector<double> &);
} // namespace Debond
