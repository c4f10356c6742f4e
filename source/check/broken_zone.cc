// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/check/broken_zone.h>
#include <debond/contact/adhesion_sums.h>
#include <debond/mesh/simplex_parts.h>

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
      // The corner on the one side of zero that has only one vertex. Of bonds
      // that hold at any distance values are minus infinity.
      const bool   one_is_positive = values[n - 2] <= 0.;
      const double corner = one_is_positive ? values.back() : values.front();
      double       part   = 1.;
      for (const double value : values)
        if (value != corner)
          part /= 1. - value / corner;
      return one_is_positive ? part : 1. - part;
    }



    /// The part of a face where a function of its barycentric coordinates is
    /// positive: that of the linear interpolant on equal pieces, which count
    /// by their @p density.
    template <int dim, typename Function, typename Density>
    double
    positive_part_on_pieces(const Function &function, const Density &density)
    {
      constexpr unsigned int n   = dim == 2 ? 1024 : 32;
      double                 sum = 0.;
      for_each_part<dim - 1>(n, [&](const auto &corners) {
        std::array<double, dim> values, middle = {};
        for (unsigned int k = 0; k < dim; ++k)
          {
            std::array<double, dim> coordinates = {{1.}};
            for (unsigned int d = 1; d < dim; ++d)
              {
                coordinates[d] = corners[k][d - 1];
                coordinates[0] -= coordinates[d];
              }
            values[k] = function(coordinates);
            for (unsigned int d = 0; d < dim; ++d)
              middle[d] += coordinates[d] / dim;
          }
        sum += positive_part(values) * density(middle);
      });
      return sum / (dim == 2 ? n : n * n);
    }



    /// The barycentric coordinates of a point next to a vertex, where bonds of
    /// this face begin or end: those of the vertex itself are those of its
    /// other faces as well.
    template <int dim>
    std::array<double, dim>
    just_inside(const unsigned int vertex)
    {
      std::array<double, dim> coordinates;
      coordinates.fill(Tolerance::beside_vertex);
      coordinates[vertex] = 1. - (dim - 1) * Tolerance::beside_vertex;
      return coordinates;
    }
  } // namespace



  template <int dim>
  double
  zone_without_bonds(const ContactBoundary<dim>  &boundary,
                     const AdhesionIntegral<dim> &adhesion)
  {
    double                  sum = 0.;
    std::array<double, dim> middle;
    middle.fill(1. / dim);
    for (const auto &face : boundary.faces)
      if (adhesion.points().bonds_at(face, middle).energy == 0.)
        sum += face.measure;
    return sum;
  }



  template <int dim>
  double
  broken_zone(const ContactBoundary<dim>  &boundary,
              const AdhesiveLaw           &law,
              const AdhesionIntegral<dim> &adhesion,
              const VectorView            &s)
  {
    const double broken_beyond = law.broken_beyond();
    // Between points nothing is known of what bonds have been at.
    if (!adhesion.memory().empty() && !adhesion.points().is_nodal())
      return open_measure(adhesion, s);

    const bool shears = adhesion.shears(); // looks at all points
    double     sum    = 0.;
    for (const auto &face : boundary.faces)
      {
        const auto threshold = [&](const std::array<double, dim> &coordinates) {
          const BondScale bonds = adhesion.points().bonds_at(face, coordinates);
          return bonds.energy == 0. ||
                     adhesion.reached_at(face, coordinates) < -broken_beyond ?
                   0. :
                   broken_beyond * bonds.length;
        };
        const auto density = [&](const std::array<double, dim> &place) {
          return boundary.density(face, place);
        };
        // In shear what is closed may be broken, and slide.
        const auto gap_beyond =
          [&](const std::array<double, dim> &coordinates) {
            return adhesion.points().opening(face, coordinates, s) -
                   threshold(coordinates);
          };
        std::array<double, dim> middle;
        middle.fill(1. / dim);
        if (shears && adhesion.points().point_at(face, middle).shears())
          {
            sum +=
              face.measure * positive_part_on_pieces<dim>(gap_beyond, density);
            continue;
          }
        const auto              trace = adhesion.points().trace_on(face, s);
        std::array<double, dim> thresholds, beyond;
        unsigned int            n_without = 0;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const auto inside = just_inside<dim>(k);
            n_without += adhesion.points().bonds_at(face, inside).energy == 0.;
            thresholds[k] = threshold(inside);
            beyond[k]     = -trace[k] - thresholds[k];
          }
        const auto [low, high] =
          std::minmax_element(thresholds.begin(), thresholds.end());
        const auto [least, largest] =
          range_on_simplex<dim>(trace, boundary.degree);
        if (-largest >= *high && -least > 0.)
          sum += face.measure;
        else if (-least > *low)
          // Closed cracks are not open.
          sum += face.measure *
                 (boundary.degree == 1 && n_without % dim == 0 &&
                      boundary.symmetry == Symmetry::none ?
                    positive_part(beyond) :
                    positive_part_on_pieces<dim>(gap_beyond, density));
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
    const double                    broken_beyond = law.broken_beyond();
    if (dim != 2 || broken_beyond == 0.)
      return result;
    // Bonds next to a vertex: 0 if there are none, 2 if they hold.
    std::map<double, std::map<double, unsigned int>> grips;
    for (const auto &face : boundary.faces)
      {
        // How far bonds are from the last kink; below 0 they hold.
        std::array<double, dim>       beyond;
        std::array<unsigned int, dim> grip;
        for (unsigned int k = 0; k < dim; ++k)
          {
            const auto      inside = just_inside<dim>(k);
            const BondScale bonds  = adhesion.points().bonds_at(face, inside);
            // On the other side of the vertex bonds may not shear.
            std::array<double, dim> place = inside;
            if (bonds.shear == 0.)
              {
                place    = {};
                place[k] = 1.;
              }
            // What has broken for good stays broken where it closes.
            beyond[k] = std::max(adhesion.points().opening(face, place, s),
                                 -adhesion.reached_at(face, k) * bonds.length) -
                        broken_beyond * bonds.length;
            grip[k] = bonds.energy == 0. ? 0 : beyond[k] < 0. ? 2 : 1;
            const dealii::Point<dim> &vertex = face.vertices[k];
            const auto [other, is_first] =
              grips[vertex[0]].emplace(vertex[1], grip[k]);
            if (!is_first && grip[k] != 1 && grip[k] + other->second == 2)
              result.push_back(vertex);
          }
        if ((grip[0] == 2) == (grip[1] == 2))
          continue;
        const double part =
          grip[0] * grip[1] == 0 ? 0.5 : beyond[0] / (beyond[0] - beyond[1]);
        result.push_back(face.vertices[0] +
                         part * (face.vertices[1] - face.vertices[0]));
      }
    return result;
  }



  DEBOND_INSTANTIATE(fronts);
  DEBOND_INSTANTIATE(broken_zone);
  DEBOND_INSTANTIATE(zone_without_bonds);
} // namespace Debond
