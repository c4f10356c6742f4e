// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/overlap.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Debond
{
  namespace
  {
    double
    cross(const dealii::Tensor<1, 2> &a, const dealii::Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }



    /// The greatest distance of two corners.
    template <int dim>
    double
    diameter_of(const Facet<dim> &facet)
    {
      double diameter = 0.;
      for (unsigned int v = 0; v < dim; ++v)
        diameter =
          std::max(diameter,
                   facet.corners[v].distance(facet.corners[(v + 1) % dim]));
      return diameter;
    }



    /// A facet as the one that is integrated over: where its points go to.
    template <int dim>
    class FirstFacet;

    template <>
    class FirstFacet<2>
    {
    public:
      FirstFacet(
        const Facet<2>                                     &facet,
        const std::map<unsigned int, dealii::Tensor<1, 2>> &vertex_normals)
        : a(facet.corners[0])
        , along(facet.corners[1] - facet.corners[0])
        , normal_a(vertex_normals.at(facet.vertices[0]))
        , normal_along(vertex_normals.at(facet.vertices[1]) - normal_a)
      {}

      void
      add_points(const Facet<2>                 &other,
                 std::vector<Overlap<2>::Point> &points) const
      {
        // Both ends of the other facet are taken back to this one, on which
        // what lies between them is an interval.
        std::array<double, 2> ends;
        for (unsigned int v = 0; v < 2; ++v)
          ends[v] = place_of(other.corners[v]);
        if (!(std::isfinite(ends[0]) && std::isfinite(ends[1])))
          return;
        const double begin = std::max(0., std::min(ends[0], ends[1])),
                     end   = std::min(1., std::max(ends[0], ends[1]));
        if (end - begin <= Tolerance::same_coordinate)
          return;
        const dealii::QGauss<1>    rule(3);
        const dealii::Tensor<1, 2> way = other.corners[1] - other.corners[0];
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            const double           r = begin + rule.point(q)[0] * (end - begin);
            const dealii::Point<2> x = a + r * along;
            const dealii::Tensor<1, 2> n = normal_a + r * normal_along;
            const double t = cross(x - other.corners[0], n) / cross(way, n);
            points.push_back({{{1. - r, r}},
                              {{1. - t, t}},
                              rule.weight(q) * (end - begin) * along.norm(),
                              (other.corners[0] + t * way - x) * n / n.norm()});
          }
      }

    private:
      /// Where the normal goes through x, as the coordinate along the facet;
      /// infinite if none does.
      double
      place_of(const dealii::Point<2> &x) const
      {
        // With a normal that is linear in r, (x - a - r along) x normal(r) = 0
        // is quadratic in r. The root beside the facet is of no use, therefore
        // that next to its middle is taken.
        const double c_0 = cross(x - a, normal_a);
        const double c_1 = cross(x - a, normal_along) - cross(along, normal_a);
        const double c_2 = -cross(along, normal_along);
        if (std::abs(c_2) <
            Tolerance::same_cell * (std::abs(c_1) + std::abs(c_0)))
          return -c_0 / c_1;
        const double square = c_1 * c_1 - 4. * c_2 * c_0;
        const double sum = -(c_1 + std::copysign(std::sqrt(square), c_1)) / 2.;
        const double one = sum / c_2, two = sum == 0. ? one : c_0 / sum;
        return std::abs(one - 0.5) < std::abs(two - 0.5) ? one : two;
      }

      const dealii::Point<2>     a;
      const dealii::Tensor<1, 2> along, normal_a, normal_along;
    };

    template <>
    class FirstFacet<3>
    {
    public:
      FirstFacet(const Facet<3> &facet,
                 const std::map<unsigned int, dealii::Tensor<1, 3>> &)
        : facet(facet)
        , size(facet.size())
      {}

      void
      add_points(const Facet<3>                 &other,
                 std::vector<Overlap<3>::Point> &points) const
      {
        // The corners of the other facet come to the plane of this one along
        // its normal. What lies within its three edges, a convex polygon, is
        // cut into triangles from its first corner.
        std::vector<Coordinates> polygon;
        for (const dealii::Point<3> &corner : other.corners)
          polygon.push_back(coordinates(facet, corner));
        for (unsigned int v = 0; v < 3; ++v)
          polygon = clipped(polygon, v);
        const dealii::QGaussSimplex<2> rule(3);
        for (std::size_t k = 2; k < polygon.size(); ++k)
          {
            const double part =
              std::abs(dealii::cross_product_3d(polygon[k - 1], polygon[k]) *
                       polygon[0]);
            if (part <= Tolerance::same_coordinate)
              continue;
            for (unsigned int q = 0; q < rule.size(); ++q)
              {
                const dealii::Point<2> &at = rule.point(q);
                const Coordinates here     = (1. - at[0] - at[1]) * polygon[0] +
                                         at[0] * polygon[k - 1] +
                                         at[1] * polygon[k];
                dealii::Point<3> x;
                for (unsigned int v = 0; v < 3; ++v)
                  x += here[v] * facet.corners[v];
                const double distance = (other.corners[0] - x) * other.normal /
                                        (facet.normal * other.normal);
                const Coordinates there =
                  coordinates(other, x + distance * facet.normal);
                points.push_back({{{here[0], here[1], here[2]}},
                                  {{there[0], there[1], there[2]}},
                                  rule.weight(q) * part * size,
                                  distance});
              }
          }
      }

    private:
      using Coordinates = dealii::Tensor<1, 3>;

      /// The barycentric coordinates of a point, or of where it is along the
      /// normal.
      static Coordinates
      coordinates(const Facet<3> &of, const dealii::Point<3> &x)
      {
        Coordinates  result;
        const double area = of.size();
        for (unsigned int v = 0; v < 3; ++v)
          result[v] = orientation(of) *
                      dealii::cross_product_3d(of.corners[(v + 1) % 3] - x,
                                               of.corners[(v + 2) % 3] - x) *
                      of.normal / area;
        return result;
      }

      /// 1 if the corners go around the outward normal.
      static double
      orientation(const Facet<3> &of)
      {
        return dealii::cross_product_3d(of.corners[1] - of.corners[0],
                                        of.corners[2] - of.corners[0]) *
                     of.normal >
                   0. ?
                 1. :
                 -1.;
      }

      /// What of the polygon is on the side of an edge where the coordinate of
      /// the opposite corner is not negative (Sutherland and Hodgman).
      static std::vector<Coordinates>
      clipped(const std::vector<Coordinates> &polygon, const unsigned int v)
      {
        std::vector<Coordinates> result;
        for (std::size_t k = 0; k < polygon.size(); ++k)
          {
            const Coordinates &here = polygon[k],
                              &next = polygon[(k + 1) % polygon.size()];
            if (here[v] >= 0.)
              result.push_back(here);
            if ((here[v] >= 0.) != (next[v] >= 0.))
              result.push_back(here +
                               here[v] / (here[v] - next[v]) * (next - here));
          }
        return result;
      }

      const Facet<3> &facet;
      const double    size;
    };



    /// The normals at the vertices of a side, the mean of those of its facets
    /// by their sizes.
    template <int dim>
    std::map<unsigned int, dealii::Tensor<1, dim>>
    vertex_normals(const std::vector<Facet<dim>> &side)
    {
      std::map<unsigned int, dealii::Tensor<1, dim>> normals;
      for (const Facet<dim> &facet : side)
        for (const unsigned int v : facet.vertices)
          normals[v] += facet.size() * facet.normal;
      for (auto &[unused, normal] : normals)
        if (normal.norm() > 0.)
          normal /= normal.norm();
      return normals;
    }
  } // namespace



  template <int dim>
  double
  Facet<dim>::size() const
  {
    if constexpr (dim == 2)
      return corners[0].distance(corners[1]);
    else
      return dealii::cross_product_3d(corners[1] - corners[0],
                                      corners[2] - corners[0])
        .norm();
  }



  template <int dim>
  std::vector<double>
  covered_parts(const std::vector<Facet<dim>>   &first,
                const std::vector<Overlap<dim>> &overlaps)
  {
    std::vector<double> parts(first.size(), 0.);
    for (const Overlap<dim> &overlap : overlaps)
      for (const auto &point : overlap.points)
        parts[overlap.first] +=
          (dim - 1.) * point.weight / first[overlap.first].size();
    return parts;
  }



  template <int dim>
  bool
  touch(const std::vector<Facet<dim>>   &first,
        const std::vector<Facet<dim>>   &second,
        const std::vector<Overlap<dim>> &overlaps)
  {
    // An edge of length h whose ends have normals at an angle is off a curve by
    // h times an eighth of it, and the normals of neighbouring facets are at
    // about the angle of the ends. What a facet is off counts more than twice,
    // for vertices need not be on the curve exactly, and places in files have
    // some digits.
    const auto deviations = [](const std::vector<Facet<dim>> &side) {
      std::map<unsigned int, std::vector<dealii::Tensor<1, dim>>> normals;
      for (const Facet<dim> &facet : side)
        for (const unsigned int v : facet.vertices)
          normals[v].push_back(facet.normal);
      std::vector<double> result;
      for (const Facet<dim> &facet : side)
        {
          double turn = 0.;
          for (const unsigned int v : facet.vertices)
            for (const dealii::Tensor<1, dim> &other : normals.at(v))
              turn = std::max(turn, (other - facet.normal).norm());
          result.push_back(diameter_of(facet) *
                           (0.3 * turn + Tolerance::same_place));
        }
      return result;
    };
    const auto of_first = deviations(first), of_second = deviations(second);
    for (const Overlap<dim> &overlap : overlaps)
      for (const auto &point : overlap.points)
        if (std::abs(point.distance) >
            of_first[overlap.first] + of_second[overlap.second])
          return false;
    return true;
  }



  template <int dim>
  std::vector<Overlap<dim>>
  find_overlaps(const std::vector<Facet<dim>> &first,
                const std::vector<Facet<dim>> &second,
                const double                   reach)
  {
    const auto normals = vertex_normals(first);

    // A tree of the boxes around the other side's facets finds those near the
    // facet, so that the time is about that of the number of pairs.
    std::vector<dealii::BoundingBox<dim>> boxes;
    for (const Facet<dim> &facet : second)
      boxes.emplace_back(facet.corners);
    const auto tree = dealii::pack_rtree_of_indices(boxes);

    std::vector<Overlap<dim>> result;
    for (unsigned int f = 0; f < first.size(); ++f)
      {
        const double             far = reach * diameter_of(first[f]);
        const FirstFacet<dim>    facet(first[f], normals);
        dealii::BoundingBox<dim> box(first[f].corners);
        box.extend(far);
        std::vector<std::size_t> near;
        tree.query(boost::geometry::index::intersects(box),
                   std::back_inserter(near));
        // The order of the tree is its own.
        std::sort(near.begin(), near.end());
        for (const std::size_t s : near)
          {
            if (first[f].normal * second[s].normal > -0.5)
              continue;
            Overlap<dim> overlap = {f, static_cast<unsigned int>(s), {}};
            facet.add_points(second[s], overlap.points);
            const bool is_near =
              std::all_of(overlap.points.begin(),
                          overlap.points.end(),
                          [far](const auto &point) {
                            return std::abs(point.distance) <= far;
                          });
            if (is_near && !overlap.points.empty())
              result.push_back(std::move(overlap));
          }
      }
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(Facet);
  DEBOND_INSTANTIATE(covered_parts);
  DEBOND_INSTANTIATE(touch);
  DEBOND_INSTANTIATE(find_overlaps);
} // namespace Debond
