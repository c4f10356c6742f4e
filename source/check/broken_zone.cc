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
      // A segment or a triangle that zero cuts has a vertex that is alone on
      // its side, with the value c. The edges from it to the vertices with
      // values v are cut at the fraction c / (c - v), and the corner's part of
      // the measure is the product of these fractions. Of bonds that hold at
      // any distance values are minus infinity, which makes the positive part
      // zero.
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
      // A face is cut into 1024 segments, or 32^2 triangles, which are equal in
      // barycentric coordinates. Each has the exact positive part of its linear
      // interpolant, and the density in its middle.
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
              const AdhesionIntegral<dim> &adhesion,
              const VectorView            &s)
  {
    // A place is broken if it is opened beyond a threshold: that of
    // AdhesiveLaw::broken_beyond(), or zero if there are no bonds or they are
    // broken for good. The edge of the zone is the zero of the opening minus
    // this threshold, so that the length of a crack changes continuously as the
    // crack grows inside a face.
    // Bonds that do not return remember their largest opening at the quadrature
    // points only. Unless these are the nodes, nothing is known between them,
    // and the points are summed up.
    if (!adhesion.memory().empty() && !adhesion.points().is_nodal())
      return open_measure(adhesion, s);

    const bool shears = adhesion.shears(); // looks at all points
    double     sum    = 0.;
    for (const auto &face : boundary.faces)
      {
        const auto threshold = [&](const std::array<double, dim> &coordinates) {
          const BondScale bonds = adhesion.points().bonds_at(face, coordinates);
          const double    beyond = bonds.law->broken_beyond();
          return bonds.energy == 0. ||
                     adhesion.reached_at(face, coordinates) < -beyond ?
                   0. :
                   beyond * bonds.length;
        };
        const auto density = [&](const std::array<double, dim> &place) {
          return boundary.density(face, place);
        };
        // With bonds that shear the opening is that of the jump in all
        // directions: what is closed may be broken, and slide.
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
        // Of opening alone the thresholds at the vertices decide, and bounds of
        // the displacement on the face. Thresholds are those just inside the
        // face, since other bonds may begin at a vertex.
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
        // Openings are between -largest and -least. The whole face counts if
        // the least opening is beyond the highest threshold, and nothing of it
        // if the largest one is not beyond the lowest.
        const auto [least, largest] =
          range_on_simplex<dim>(trace, boundary.degree);
        if (-largest >= *high && -least > 0.)
          sum += face.measure;
        else if (-least > *low)
          // Only part of the face is broken. If the opening is linear, there is
          // no axis, and bonds are at all vertices or at none, the values at
          // the vertices give this part; otherwise it is summed up over small
          // pieces. Closed cracks are not open, as the opening has to exceed a
          // threshold of zero.
          sum += face.measure *
                 (boundary.degree == 1 && n_without % dim == 0 &&
                      boundary.symmetry == Symmetry::none ?
                    positive_part(beyond) :
                    positive_part_on_pieces<dim>(gap_beyond, density));
      }
    return sum;
  }



  namespace
  {
    /// A part of the front by its ends: a point in the plane, otherwise a
    /// segment.
    template <int dim>
    using FrontPiece = std::array<dealii::Point<dim>, dim - 1>;



    template <int dim>
    std::vector<FrontPiece<dim>>
    front_pieces(const ContactBoundary<dim>  &boundary,
                 const AdhesionIntegral<dim> &adhesion,
                 const VectorView            &s)
    {
      // On a face with bonds at all vertices the front is the zero of the
      // opening minus broken_beyond(), which is taken for linear. If the
      // scene's bonds begin inside a face the front is halfway, and if they
      // begin at one of its sides, a vertex or an edge, it is there.
      std::vector<FrontPiece<dim>> result;
      // By the sum of a side's vertices, what bonds next to it do on the first
      // of its faces: 0 if there are none, 1 if they are broken, 2 if they
      // hold.
      std::map<std::array<double, dim>, unsigned int> grips;
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
              // What has broken for good stays broken if it closes.
              beyond[k] =
                std::max(adhesion.points().opening(face, place, s),
                         -adhesion.reached_at(face, k) * bonds.length) -
                bonds.law->broken_beyond() * bonds.length;
              grip[k] = bonds.energy == 0. ? 0 : beyond[k] < 0. ? 2 : 1;
            }
          for (unsigned int k = dim; k-- > 0;)
            {
              // The side opposite to vertex k.
              FrontPiece<dim>         side;
              std::array<double, dim> place = {};
              const unsigned int      here  = grip[(k + 1) % dim];
              for (unsigned int other = 1; other < dim; ++other)
                {
                  side[other - 1] = face.vertices[(k + other) % dim];
                  for (unsigned int d = 0; d < dim; ++d)
                    place[d] += side[other - 1][d];
                }
              if (here == 1 || here != grip[(k + dim - 1) % dim])
                continue;
              const auto [there, is_first] = grips.emplace(place, here);
              // The second face: on one side bonds hold, and on the other one
              // there are none.
              if (!is_first && here + there->second == 2)
                result.push_back(side);
            }
          // Without bonds that hold at some vertices and do not at others no
          // front is inside the face. It cuts the edges of the vertex that is
          // alone.
          const auto n_hold = std::count(grip.begin(), grip.end(), 2u);
          if (n_hold % dim == 0)
            continue;
          unsigned int alone = 0;
          while ((grip[alone] == 2) != (n_hold == 1))
            ++alone;
          FrontPiece<dim> piece;
          for (unsigned int other = 1; other < dim; ++other)
            {
              const unsigned int k    = (alone + other) % dim;
              const double       part = grip[alone] * grip[k] == 0 ?
                                          0.5 :
                                          beyond[alone] / (beyond[alone] - beyond[k]);
              piece[other - 1] =
                face.vertices[alone] +
                part * (face.vertices[k] - face.vertices[alone]);
            }
          result.push_back(piece);
        }
      return result;
    }
  } // namespace



  template <>
  std::vector<dealii::Point<2>>
  fronts(const ContactBoundary<2>  &boundary,
         const AdhesionIntegral<2> &adhesion,
         const VectorView          &s)
  {
    std::vector<dealii::Point<2>> result;
    if (adhesion.adhesive_law().broken_beyond() != 0.)
      for (const auto &[point] : front_pieces(boundary, adhesion, s))
        result.push_back(point);
    return result;
  }



  template <>
  std::vector<dealii::Point<3>>
  fronts(const ContactBoundary<3>  &boundary,
         const AdhesionIntegral<3> &adhesion,
         const VectorView          &s)
  {
    dealii::Point<3> least, mean, largest;
    double           length = 0.;
    bool             is_any = false;
    if (adhesion.adhesive_law().broken_beyond() != 0.)
      for (const auto &[a, b] : front_pieces(boundary, adhesion, s))
        {
          length += a.distance(b);
          for (unsigned int d = 0; d < 3; ++d)
            {
              mean[d] += a.distance(b) * (a[d] + b[d]) / 2.;
              const auto [low, high] = std::minmax(a[d], b[d]);
              least[d]               = is_any ? std::min(least[d], low) : low;
              largest[d] = is_any ? std::max(largest[d], high) : high;
            }
          is_any = true;
        }
    if (length == 0.)
      return {};
    return {least, dealii::Point<3>(mean / length), largest};
  }



  DEBOND_INSTANTIATE(broken_zone);
  DEBOND_INSTANTIATE(zone_without_bonds);
} // namespace Debond
