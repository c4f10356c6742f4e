// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_crossed_lattice_h
#define debond_mesh_crossed_lattice_h

#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>

#include <debond/mesh/box.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace Debond
{
  /// The vertices of a box's crossed mesh. They are points of a lattice of
  /// half the cell size: corners of the cells have even coordinates, centres
  /// of cells odd ones, centres of faces (3D) odd ones but for the direction
  /// of their normal.
  template <int dim>
  class CrossedLattice
  {
  public:
    using Coordinates = std::array<unsigned int, dim>;

    explicit CrossedLattice(const BoxParameters &box)
      : box(box)
      , cosine(std::cos(box.rotation * dealii::numbers::PI / 180.))
      , sine(std::sin(box.rotation * dealii::numbers::PI / 180.))
    {}

    /// The number of lattice points, some of which are no vertices.
    std::size_t
    size() const
    {
      std::size_t n_points = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n_points *= 2 * box.cells[d] + 1;
      return n_points;
    }

    /// Of the lattice point next to a vertex.
    std::size_t
    index(const dealii::Point<dim> &vertex) const
    {
      return index(coordinates(vertex));
    }

    bool
    is_vertex(std::size_t index) const
    {
      unsigned int n_odd = 0;
      for (unsigned int d = 0; d < dim; ++d)
        {
          n_odd += index % (2 * box.cells[d] + 1) % 2 == 1;
          index /= 2 * box.cells[d] + 1;
        }
      return n_odd != 1;
    }

    dealii::Point<dim>
    point(std::size_t index) const
    {
      dealii::Point<dim> unturned;
      for (unsigned int d = 0; d < dim; ++d)
        {
          unturned[d] = 0.5 *
                        static_cast<double>(index % (2 * box.cells[d] + 1)) *
                        box.lengths[d] / box.cells[d];
          index /= 2 * box.cells[d] + 1;
        }
      dealii::Point<dim> result = unturned;
      result[0]                 = cosine * unturned[0] - sine * unturned[1];
      result[1]                 = sine * unturned[0] + cosine * unturned[1];
      return result;
    }

    /// Calls @p visit with the index and the weight of each vertex that a P1
    /// field at the point depends on.
    template <typename Visitor>
    void
    visit_weights(const dealii::Point<dim> &point, const Visitor &visit) const
    {
      const dealii::Point<dim> position = in_cells(point);
      Coordinates              centre;
      std::array<double, dim>  offset;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double cell =
            std::clamp(std::floor(position[d]), 0., box.cells[d] - 1.);
          centre[d] = 2 * static_cast<unsigned int>(cell) + 1;
          offset[d] = 2. * (position[d] - cell) - 1.;
        }
      visit_weights(centre, offset, 1., visit);
    }

    /// P1 interpolation to points, between vertices of which @p number gets the
    /// index.
    template <typename Numbering>
    Interpolation
    interpolation(const std::vector<dealii::Point<dim>> &points,
                  const unsigned int                     n_vertices,
                  const Numbering                       &number) const
    {
      Interpolation rows;
      rows.n_nodes = n_vertices;
      rows.starts.reserve(points.size() + 1);
      for (const dealii::Point<dim> &point : points)
        {
          // What rounding of the point makes of a zero is none.
          constexpr double noise = 1e-6;
          double           sum   = 0.;
          visit_weights(point, [&](const std::size_t i, const double weight) {
            if (weight < noise)
              return;
            sum += weight;
            rows.nodes.push_back(number(i));
            rows.weights.push_back(static_cast<float>(weight));
          });
          for (std::size_t k = rows.starts.back(); k < rows.weights.size(); ++k)
            rows.weights[k] = static_cast<float>(rows.weights[k] / sum);
          rows.starts.push_back(rows.nodes.size());
        }
      rows.nodes.shrink_to_fit();
      rows.weights.shrink_to_fit();
      return rows;
    }

    /// The coordinates of the lattice point next to a vertex.
    Coordinates
    coordinates(const dealii::Point<dim> &vertex) const
    {
      const dealii::Point<dim> position = in_cells(vertex);
      Coordinates              lattice;
      for (unsigned int d = 0; d < dim; ++d)
        lattice[d] = static_cast<unsigned int>(std::lround(2. * position[d]));
      return lattice;
    }

  private:
    /// In the coordinates of the unturned box, in units of cells.
    dealii::Point<dim>
    in_cells(const dealii::Point<dim> &point) const
    {
      dealii::Point<dim> result = point;
      result[0]                 = cosine * point[0] + sine * point[1];
      result[1]                 = -sine * point[0] + cosine * point[1];
      for (unsigned int d = 0; d < dim; ++d)
        result[d] *= box.cells[d] / box.lengths[d];
      return result;
    }

    std::size_t
    index(const Coordinates &lattice) const
    {
      std::size_t result = 0;
      for (unsigned int d = dim; d-- > 0;)
        result = result * (2 * box.cells[d] + 1) + lattice[d];
      return result;
    }

    /// At an offset from a centre, of a cell, a face or an edge: linear on
    /// the way from the centre to the boundary, where a point of lower
    /// dimension follows. Edges are not divided; offsets that are zero belong
    /// to directions that are done with.
    template <typename Visitor>
    void
    visit_weights(const Coordinates      &centre,
                  std::array<double, dim> offset,
                  const double            weight,
                  const Visitor          &visit) const
    {
      const auto odd = [&](const unsigned int d) { return centre[d] % 2 == 1; };
      unsigned int n_odd = 0, farthest = dim;
      for (unsigned int d = 0; d < dim; ++d)
        if (odd(d))
          {
            ++n_odd;
            if (farthest == dim ||
                std::abs(offset[d]) > std::abs(offset[farthest]))
              farthest = d;
          }

      Coordinates below = centre, above = centre;
      --below[farthest];
      ++above[farthest];
      const double x = offset[farthest];
      if (n_odd == 1)
        {
          visit(index(below), 0.5 * (1. - x) * weight);
          visit(index(above), 0.5 * (1. + x) * weight);
          return;
        }

      const double distance = std::abs(x);
      visit(index(centre), (1. - distance) * weight);
      if (distance == 0.)
        return;
      for (unsigned int d = 0; d < dim; ++d)
        offset[d] /= distance;
      visit_weights(x < 0. ? below : above, offset, distance * weight, visit);
    }

    const BoxParameters &box;
    const double         cosine;
    const double         sine;
  };
} // namespace Debond

#endif
