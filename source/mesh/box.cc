// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/mesh/box.h>
#include <debond/mesh/crossed_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// Cells that are longer than the shortest ones by this factor are not
    /// joined: smoothers have no grip on what varies slowly along them.
    constexpr double longest_joined = 1.5;

    /// Of a coarser cell, the longest side over the shortest, where finer ones
    /// are rounder.
    constexpr double most_stretched = 1.9;

    /// Coarser levels are not worth a smoother.
    constexpr double fewest_vertices = 400.;

    /// The coarsest level is factorised at each change of the contact set.
    constexpr double most_coarsest_vertices = 5000.;



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
        const dealii::Point<dim> position = in_cells(vertex);
        Coordinates              lattice;
        for (unsigned int d = 0; d < dim; ++d)
          lattice[d] = static_cast<unsigned int>(std::lround(2. * position[d]));
        return index(lattice);
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



    /// The vertices of the lattice and P1 interpolation from them to points.
    template <int dim>
    CoarseLevel<dim>
    coarse_level(const CrossedLattice<dim>             &lattice,
                 const std::vector<dealii::Point<dim>> &points)
    {
      CoarseLevel<dim>          level;
      std::vector<unsigned int> numbers(lattice.size());
      for (std::size_t i = 0; i < lattice.size(); ++i)
        if (lattice.is_vertex(i))
          {
            numbers[i] = static_cast<unsigned int>(level.vertices.size());
            level.vertices.push_back(lattice.point(i));
          }

      Interpolation &rows = level.to_finer;
      rows.n_nodes        = static_cast<unsigned int>(level.vertices.size());
      rows.starts.reserve(points.size() + 1);
      for (const dealii::Point<dim> &point : points)
        {
          // What rounding of the point makes of a zero is none.
          constexpr double noise = 1e-6;
          double           sum   = 0.;
          lattice.visit_weights(point,
                                [&](const std::size_t i, const double weight) {
                                  if (weight < noise)
                                    return;
                                  sum += weight;
                                  rows.nodes.push_back(numbers[i]);
                                  rows.weights.push_back(
                                    static_cast<float>(weight));
                                });
          for (std::size_t k = rows.starts.back(); k < rows.weights.size(); ++k)
            rows.weights[k] = static_cast<float>(rows.weights[k] / sum);
          rows.starts.push_back(rows.nodes.size());
        }
      rows.nodes.shrink_to_fit();
      rows.weights.shrink_to_fit();
      return level;
    }



    /// The longest side of a cell over the shortest.
    template <int dim>
    double
    stretch(const BoxParameters &box)
    {
      double longest = 0., shortest = std::numeric_limits<double>::infinity();
      for (unsigned int d = 0; d < dim; ++d)
        {
          longest  = std::max(longest, box.lengths[d] / box.cells[d]);
          shortest = std::min(shortest, box.lengths[d] / box.cells[d]);
        }
      return longest / shortest;
    }
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
    // Of the directions in which cells can be joined.
    double shortest = std::numeric_limits<double>::infinity();
    for (unsigned int d = 0; d < dim; ++d)
      if (parameters.cells[d] > 1)
        shortest =
          std::min(shortest, parameters.lengths[d] / parameters.cells[d]);
    BoxParameters coarse = parameters;
    for (unsigned int d = 0; d < dim; ++d)
      if (parameters.lengths[d] / parameters.cells[d] <=
          longest_joined * shortest)
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
    const CrossedLattice<dim>           lattice(parameters);
    std::vector<dealii::Tensor<1, dim>> field(lattice.size());
    const auto                         &vertices = mesh.get_vertices();
    for (std::size_t v = 0; v < vertices.size(); ++v)
      field[lattice.index(vertices[v])] = values[v];

    std::vector<dealii::Tensor<1, dim>> result(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
      lattice.visit_weights(points[p],
                            [&](const std::size_t i, const double weight) {
                              result[p] += weight * field[i];
                            });
    return result;
  }



  template <int dim>
  std::vector<CoarseLevel<dim>>
  Box<dim>::coarse_levels(const std::vector<dealii::Point<dim>> &vertices) const
  {
    std::vector<CoarseLevel<dim>> levels;
    for (const BoxParameters &box : coarse_boxes())
      levels.push_back(
        coarse_level(CrossedLattice<dim>(box),
                     levels.empty() ? vertices : levels.back().vertices));
    return levels;
  }



  template <int dim>
  std::vector<BoxParameters>
  Box<dim>::coarse_boxes() const
  {
    std::vector<BoxParameters> boxes;
    BoxParameters              finer = parameters;
    while (Box(finer).n_vertices() >= fewest_vertices)
      {
        const std::unique_ptr<const Body<dim>> body = Box(finer).coarser();
        if (!body)
          break;
        const BoxParameters coarse = static_cast<const Box &>(*body).parameters;
        // Where the thickness has one cell left, others would grow longer.
        if (stretch<dim>(coarse) >
            std::max(most_stretched, 1.1 * stretch<dim>(finer)))
          break;
        boxes.push_back(coarse);
        finer = coarse;
      }
    if (Box(finer).n_vertices() > most_coarsest_vertices)
      boxes.clear();
    return boxes;
  }



  template <int dim>
  bool
  Box<dim>::has_coarse_levels() const
  {
    return !coarse_boxes().empty();
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
