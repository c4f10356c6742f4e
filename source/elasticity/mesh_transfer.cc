// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>

#include <debond/elasticity/mesh_transfer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace Debond
{
  namespace
  {
    /// A field on the vertices of a box's crossed mesh. They are points of a
    /// lattice of half the cell size: corners of the cells have even
    /// coordinates, centres of cells odd ones, centres of faces (3D) odd ones
    /// but for the direction of their normal.
    template <int dim>
    class CrossedField
    {
    public:
      using Value = dealii::Tensor<1, dim>;

      explicit CrossedField(const BoxParameters &box)
        : box(box)
        , cosine(std::cos(box.rotation * dealii::numbers::PI / 180.))
        , sine(std::sin(box.rotation * dealii::numbers::PI / 180.))
      {
        std::size_t n_points = 1;
        for (unsigned int d = 0; d < dim; ++d)
          n_points *= 2 * box.cells[d] + 1;
        values.resize(n_points);
      }

      /// The value at the lattice point next to a vertex.
      Value &
      at_vertex(const dealii::Point<dim> &vertex)
      {
        const dealii::Point<dim>      position = in_cells(vertex);
        std::array<unsigned int, dim> lattice;
        for (unsigned int d = 0; d < dim; ++d)
          lattice[d] = static_cast<unsigned int>(std::lround(2. * position[d]));
        return values[index(lattice)];
      }

      Value
      operator()(const dealii::Point<dim> &point) const
      {
        const dealii::Point<dim>      position = in_cells(point);
        std::array<unsigned int, dim> centre;
        std::array<double, dim>       offset;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double cell =
              std::clamp(std::floor(position[d]), 0., box.cells[d] - 1.);
            centre[d] = 2 * static_cast<unsigned int>(cell) + 1;
            offset[d] = 2. * (position[d] - cell) - 1.;
          }
        return interpolate(centre, offset);
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
      index(const std::array<unsigned int, dim> &lattice) const
      {
        std::size_t result = 0;
        for (unsigned int d = dim; d-- > 0;)
          result = result * (2 * box.cells[d] + 1) + lattice[d];
        return result;
      }

      /// The field at an offset from a centre, of a cell, a face or an edge:
      /// linear on the way from the centre to the boundary, where a point of
      /// lower dimension follows. Edges are not divided; offsets that are
      /// zero belong to directions that are done with.
      Value
      interpolate(std::array<unsigned int, dim> centre,
                  std::array<double, dim>       offset) const
      {
        const auto odd = [&](const unsigned int d) {
          return centre[d] % 2 == 1;
        };
        unsigned int n_odd = 0, farthest = dim;
        for (unsigned int d = 0; d < dim; ++d)
          if (odd(d))
            {
              ++n_odd;
              if (farthest == dim ||
                  std::abs(offset[d]) > std::abs(offset[farthest]))
                farthest = d;
            }

        std::array<unsigned int, dim> below = centre, above = centre;
        --below[farthest];
        ++above[farthest];
        const double x = offset[farthest];
        if (n_odd == 1)
          return 0.5 * (1. - x) * values[index(below)] +
                 0.5 * (1. + x) * values[index(above)];

        const double distance = std::abs(x);
        if (distance == 0.)
          return values[index(centre)];
        for (unsigned int d = 0; d < dim; ++d)
          offset[d] /= distance;
        return (1. - distance) * values[index(centre)] +
               distance * interpolate(x < 0. ? below : above, offset);
      }

      const BoxParameters &box;
      const double         cosine;
      const double         sine;
      std::vector<Value>   values;
    };
  } // namespace



  template <int dim>
  dealii::Vector<double>
  interpolate_displacement(const BoxParameters          &box,
                           const ElasticProblem<dim>    &source,
                           const dealii::Vector<double> &u,
                           const ElasticProblem<dim>    &target)
  {
    CrossedField<dim>            field(box);
    const dealii::Vector<double> displacement =
      source.cartesian_displacement(u);
    for (const auto &cell : source.dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          auto &value = field.at_vertex(cell->vertex(v));
          for (unsigned int d = 0; d < dim; ++d)
            value[d] = displacement[cell->vertex_dof_index(v, d)];
        }

    dealii::Vector<double> result(target.n_dofs());
    std::vector<bool>      visited(
      target.dof_handler().get_triangulation().n_vertices(), false);
    for (const auto &cell : target.dof_handler().active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (!visited[cell->vertex_index(v)])
          {
            visited[cell->vertex_index(v)] = true;
            const auto value               = field(cell->vertex(v));
            for (unsigned int d = 0; d < dim; ++d)
              result[cell->vertex_dof_index(v, d)] = value[d];
          }
    return target.unknowns(result);
  }



  template dealii::Vector<double>
  interpolate_displacement(const BoxParameters &,
                           const ElasticProblem<2> &,
                           const dealii::Vector<double> &,
                           const ElasticProblem<2> &);
  template dealii::Vector<double>
  interpolate_displacement(const BoxParameters &,
                           const ElasticProblem<3> &,
                           const dealii::Vector<double> &,
                           const ElasticProblem<3> &);
} // namespace Debond
