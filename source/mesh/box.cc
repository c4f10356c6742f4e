// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/mesh/box.h>
#include <debond/mesh/crossed_mesh.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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
  const std::map<std::string, dealii::types::boundary_id> &
  box_sides()
  {
    using Sides = std::map<std::string, dealii::types::boundary_id>;
    static const Sides names = [] {
      Sides sides = {{"left", 0}, {"right", 1}, {"bottom", 2}, {"top", 3}};
      if (dim == 3)
        {
          sides["back"]  = 4;
          sides["front"] = 5;
        }
      return sides;
    }();
    return names;
  }



  template <int dim>
  BoundaryNames
  box_boundaries()
  {
    BoundaryNames names;
    for (const auto &[side, id] : box_sides<dim>())
      names[side] = {id};
    return names;
  }



  template <int dim>
  void
  make_box(const BoxParameters &parameters, dealii::Triangulation<dim> &crossed)
  {
    dealii::Point<dim>        corner;
    std::vector<unsigned int> cells(dim);
    for (unsigned int d = 0; d < dim; ++d)
      {
        if (!(parameters.lengths[d] > 0.))
          throw std::invalid_argument(
            "Box: length " + std::to_string(parameters.lengths[d]) +
            " in direction " + std::to_string(d) + " must be positive.");
        if (parameters.cells[d] == 0)
          throw std::invalid_argument("Box: the number of cells in direction " +
                                      std::to_string(d) +
                                      " is 0, it must be at least 1.");
        corner[d] = parameters.lengths[d];
        cells[d]  = parameters.cells[d];
      }

    dealii::Triangulation<dim> coarse;
    dealii::GridGenerator::subdivided_hyper_rectangle(
      coarse, cells, dealii::Point<dim>(), corner, /*colorize=*/true);
    crossed_subdivision(coarse, crossed);

    if (parameters.rotation != 0.)
      {
        const double angle = parameters.rotation * dealii::numbers::PI / 180.;
        if constexpr (dim == 2)
          dealii::GridTools::rotate(angle, crossed);
        else
          dealii::GridTools::rotate(dealii::Tensor<1, 3>({0., 0., 1.}),
                                    angle,
                                    crossed);
      }
  }



  template <int dim>
  Box<dim>::Box(const BoxParameters &parameters)
    : parameters(parameters)
  {}



  template <int dim>
  std::set<std::string>
  Box<dim>::boundaries() const
  {
    std::set<std::string> names;
    for (const auto &[side, unused] : box_sides<dim>())
      names.insert(side);
    return names;
  }



  template <int dim>
  std::set<std::string>
  Box<dim>::regions() const
  {
    return {};
  }



  template <int dim>
  double
  Box<dim>::n_cells() const
  {
    const auto &n = shape().cells;
    return dim == 2 ? 4. * n[0] * n[1] : 24. * n[0] * n[1] * n[2];
  }



  template <int dim>
  double
  Box<dim>::n_vertices() const
  {
    const auto &n = shape().cells;
    if (dim == 2)
      return (n[0] + 1.) * (n[1] + 1.) + n[0] * n[1];
    const double faces = (n[0] + 1.) * n[1] * n[2] + n[0] * (n[1] + 1.) * n[2] +
                         n[0] * n[1] * (n[2] + 1.);
    return (n[0] + 1.) * (n[1] + 1.) * (n[2] + 1.) + faces + n[0] * n[1] * n[2];
  }



  template <int dim>
  double
  Box<dim>::n_vertices_on(const std::string &side) const
  {
    const unsigned int boundary = box_sides<dim>().at(side);
    double             corners = 1., faces = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      if (d != boundary / 2)
        {
          corners *= parameters.cells[d] + 1.;
          faces *= parameters.cells[d];
        }
    return dim == 2 ? corners : corners + faces;
  }



  template <int dim>
  BodyShape
  Box<dim>::shape() const
  {
    BodyShape shape = {};
    shape.is_box    = true;
    for (unsigned int d = 0; d < dim; ++d)
      {
        shape.lengths[d] = parameters.lengths[d];
        shape.cells[d]   = parameters.cells[d];
      }
    return shape;
  }



  template <int dim>
  PieceNames
  Box<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    make_box(parameters, mesh);
    return {box_boundaries<dim>(), {}};
  }



  template <int dim>
  std::unique_ptr<const Body<dim>>
  Box<dim>::coarser() const
  {
    BoxParameters coarse = parameters;
    for (unsigned int d = 0; d < dim; ++d)
      coarse.cells[d] = (coarse.cells[d] + 1) / 2;
    if (coarse.cells == parameters.cells)
      return nullptr;
    return std::make_unique<const Box>(coarse);
  }



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  Box<dim>::interpolate(const dealii::Triangulation<dim>          &mesh,
                        const std::vector<dealii::Tensor<1, dim>> &values,
                        const std::vector<dealii::Point<dim>>     &points) const
  {
    CrossedField<dim> field(parameters);
    const auto       &vertices = mesh.get_vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v)
      field.at_vertex(vertices[v]) = values[v];

    std::vector<dealii::Tensor<1, dim>> result;
    result.reserve(points.size());
    for (const dealii::Point<dim> &point : points)
      result.push_back(field(point));
    return result;
  }



  template const std::map<std::string, dealii::types::boundary_id> &
  box_sides<2>();
  template const std::map<std::string, dealii::types::boundary_id> &
  box_sides<3>();
  template BoundaryNames
  box_boundaries<2>();
  template BoundaryNames
  box_boundaries<3>();
  template void
  make_box(const BoxParameters &, dealii::Triangulation<2> &);
  template void
  make_box(const BoxParameters &, dealii::Triangulation<3> &);
  template class Box<2>;
  template class Box<3>;
} // namespace Debond
