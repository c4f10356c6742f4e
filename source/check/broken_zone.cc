// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/broken_zone.h>

#include <algorithm>
#include <array>
#include <numeric>

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



    /// The part of a face where a function of its barycentric coordinates is
    /// positive: that of the linear interpolant on equal pieces.
    template <int dim, typename Function>
    double
    positive_part_on_pieces(const Function &function)
    {
      constexpr unsigned int n = dim == 2 ? 1024 : 32;
      // A piece with its corner here, its legs along the axes or against them.
      const auto part_of_piece =
        [&](const unsigned int x, const unsigned int y, const double leg) {
          std::array<double, dim> values, coordinates;
          for (unsigned int k = 0; k < dim; ++k)
            {
              coordinates[dim - 1] = (y + (k == 2 ? leg : 0.)) / n;
              coordinates[1]       = (x + (k == 1 ? leg : 0.)) / n;
              coordinates[0]       = 1.;
              for (unsigned int d = 1; d < dim; ++d)
                coordinates[0] -= coordinates[d];
              values[k] = function(coordinates);
            }
          return positive_part(values);
        };
      double sum = 0.;
      for (unsigned int x = 0; x < n; ++x)
        for (unsigned int y = 0; y < (dim == 2 ? 1 : n - x); ++y)
          {
            sum += part_of_piece(x, y, 1.);
            if (dim == 3 && x + y + 1 < n)
              sum += part_of_piece(x + 1, y + 1, -1.);
          }
      return sum / (dim == 2 ? n : n * n);
    }
  } // namespace



  template <int dim>
  double
  broken_zone(const ContactBoundary<dim>  &boundary,
              const AdhesiveLaw           &law,
              const AdhesionIntegral<dim> &adhesion,
              const VectorView            &s)
  {
    const unsigned int last = law.branches().size() - 1;
    // Bonds that hold at any distance are never broken.
    if (last == 0 && !law.is_loose(0))
      return 0.;

    if (adhesion.has_broken_points())
      return adhesion.open_measure(s);

    double sum = 0.;
    for (const auto &face : boundary.faces)
      {
        std::array<double, dim> threshold, beyond;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const BondScale bonds = adhesion.bonds_at(face, k);
            const bool      is_loose =
              bonds.energy == 0. || adhesion.least_piece_at(face, k) == last;
            threshold[k] = is_loose ? 0. : law.bond_threshold() * bonds.stretch;
            beyond[k]    = -adhesion.trace_at(face, k, s) - threshold[k];
          }
        if (boundary.degree == 2)
          {
            const auto [least, largest] =
              range_on_simplex<dim>(adhesion.trace_on(face, s), 2);
            const auto [low, high] =
              std::minmax_element(threshold.begin(), threshold.end());
            if (-largest >= *high)
              sum += face.measure;
            else if (-least > *low)
              sum += face.measure *
                     positive_part_on_pieces<dim>(
                       [&](const std::array<double, dim> &coordinates) {
                         return -adhesion.trace(face, coordinates, s) -
                                std::inner_product(coordinates.begin(),
                                                   coordinates.end(),
                                                   threshold.begin(),
                                                   0.);
                       });
            continue;
          }
        // Closed cracks are not open.
        sum += face.measure * positive_part(beyond);
      }
    return sum;
  }



  template <int dim>
  std::vector<dealii::Point<dim>>
  fronts(const ContactBoundary<dim>  &boundary,
         const AdhesiveLaw           &law,
         const AdhesionIntegral<dim> &adhesion,
         const VectorView            &s)
  {
    std::vector<dealii::Point<dim>> result;
    const unsigned int              last = law.branches().size() - 1;
    if (dim != 2 || last == 0)
      return result;
    for (const auto &face : boundary.faces)
      {
        // How far bonds are from the last kink; below 0 they hold.
        std::array<double, dim> beyond;
        std::array<bool, dim>   are_gone, hold;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const BondScale bonds = adhesion.bonds_at(face, k);
            are_gone[k] =
              bonds.energy == 0. || adhesion.least_piece_at(face, k) == last;
            beyond[k] = -adhesion.trace_at(face, k, s) -
                        law.bond_threshold() * bonds.stretch;
            hold[k] = !are_gone[k] && beyond[k] < 0.;
          }
        if (hold[0] == hold[1])
          continue;
        const double part = are_gone[0] || are_gone[1] ?
                              0.5 :
                              beyond[0] / (beyond[0] - beyond[1]);
        result.push_back(face.vertices[0] +
                         part * (face.vertices[1] - face.vertices[0]));
      }
    return result;
  }



  template decltype(fronts<2>)      fronts<2>;
  template decltype(fronts<3>)      fronts<3>;
  template decltype(broken_zone<2>) broken_zone<2>;
  template decltype(broken_zone<3>) broken_zone<3>;
} // namespace Debond
