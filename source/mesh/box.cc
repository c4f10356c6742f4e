// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/physics/transformations.h>

#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/mesh/box.h>

#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    /// Cells that are longer than the shortest ones by this factor are not
    /// joined: smoothers have no grip on what varies slowly along them.
    constexpr double longest_joined = 1.5;

    /// The longest side of a coarser cell over the shortest, at most, where
    /// finer ones are rounder.
    constexpr double most_stretched = 1.9;



    /// The longest side of a cell over the shortest.
    template <int dim>
    double
    stretch(const BoxParameters &box)
    {
      double longest = 0., shortest = infinity;
      for (unsigned int d = 0; d < dim; ++d)
        {
          longest  = std::max(longest, box.lengths[d] / box.cells[d]);
          shortest = std::min(shortest, box.lengths[d] / box.cells[d]);
        }
      return longest / shortest;
    }
  } // namespace



  template <int dim>
  std::map<std::string, dealii::types::boundary_id>
  box_sides()
  {
    std::map<std::string, dealii::types::boundary_id> sides = {{"left", 0},
                                                               {"right", 1},
                                                               {"bottom", 2},
                                                               {"top", 3}};
    if (dim == 3)
      {
        sides["back"]  = 4;
        sides["front"] = 5;
      }
    return sides;
  }



  namespace
  {
    /// Where a box is.
    template <int dim>
    class Place
    {
    public:
      explicit Place(const BoxParameters &box)
        : is_turned(box.rotation != 0.)
        , rotation(rotation_matrix<dim>(box.rotation))
      {
        for (unsigned int d = 0; d < dim; ++d)
          origin[d] = box.origin[d];
      }

      /// Of a point of the box that begins at zero.
      dealii::Point<dim>
      of(const dealii::Point<dim> &point) const
      {
        // What is not turned keeps its last digits.
        const dealii::Point<dim> moved = point + origin;
        return is_turned ? dealii::Point<dim>(rotation * moved) : moved;
      }

      /// The way back.
      dealii::Tensor<1, dim>
      in_box(const dealii::Point<dim> &point) const
      {
        return (is_turned ?
                  dealii::Tensor<1, dim>(dealii::transpose(rotation) * point) :
                  dealii::Tensor<1, dim>(point)) -
               origin;
      }

    private:
      const bool                   is_turned;
      const dealii::Tensor<2, dim> rotation;
      dealii::Tensor<1, dim>       origin;
    };
  } // namespace



  template <int dim>
  MeshData<dim>
  part_of_box(const BoxParameters               &box,
              const std::array<unsigned int, 3> &begin,
              const std::array<unsigned int, 3> &n_cells)
  {
    // The cells have the size 1 first. Coordinates are whole numbers then, and
    // their products with the size of a cell do not depend on where the part
    // begins: ranks that make overlapping parts of a box get the same vertices
    // to the last bit.
    dealii::Point<dim> first, last;
    for (unsigned int d = 0; d < dim; ++d)
      {
        if (!(box.lengths[d] > 0.) || box.cells[d] == 0)
          throw std::invalid_argument(
            "Box: lengths and numbers of cells must be positive.");
        first[d] = begin[d];
        last[d]  = begin[d] + n_cells[d];
      }
    dealii::Triangulation<dim> cells;
    dealii::GridGenerator::subdivided_hyper_rectangle(
      cells,
      std::vector<unsigned int>(n_cells.begin(), n_cells.begin() + dim),
      first,
      last,
      /*colorize=*/true);
    dealii::GridTools::transform(
      [&](dealii::Point<dim> point) {
        for (unsigned int d = 0; d < dim; ++d)
          point[d] *= box.lengths[d] / box.cells[d];
        return point;
      },
      cells);
    // The box is moved and turned after the subdivision: centres are means of
    // corners with short coordinates then.
    MeshData<dim>    crossed = crossed_subdivision(cells);
    const Place<dim> place(box);
    for (dealii::Point<dim> &vertex : crossed.vertices)
      vertex = place.of(vertex);
    return crossed;
  }



  namespace
  {
    /// The vertices of the crossed mesh of a box by their places, in halves of
    /// cells: corners have only even coordinates, centres of cells only odd
    /// ones, and centres of faces, in 3D, one that is even.
    template <int dim>
    class Lattice
    {
    public:
      using Number = std::array<unsigned int, dim>;

      explicit Lattice(const BoxParameters &box)
        : box(box)
        , place_of_box(box)
      {
        // Places are numbered with the first coordinate running fastest.
        // Corners, centres of cells and, in 3D, centres of faces have a vertex;
        // the place in the middle of an edge, with one odd coordinate, has
        // none. In 2D that is also the middle of a face. The list of numbers
        // has 2^dim entries for each cell, and the coordinates are those of
        // part_of_box() but for rounding.
        unsigned int n_places = 1;
        for (unsigned int d = 0; d < dim; ++d)
          n_places *= 2 * box.cells[d] + 1;
        numbers.resize(n_places);
        for (unsigned int k = 0; k < n_places; ++k)
          {
            dealii::Point<dim> x;
            unsigned int       rest = k, n_odd = 0;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const unsigned int place = rest % (2 * box.cells[d] + 1);
                rest /= 2 * box.cells[d] + 1;
                n_odd += place % 2;
                x[d] = 0.5 * place * (box.lengths[d] / box.cells[d]);
              }
            if (n_odd == 1)
              continue;
            numbers[k] = static_cast<unsigned int>(vertices.size());
            vertices.push_back(place_of_box.of(x));
          }
      }

      /// Finds the simplex that contains a point without a search. It is
      /// spanned by the centre of a cell, in 3D the centre of the face that the
      /// point is nearest to, and the two ends of an edge.
      typename LinearFields<dim>::Weights
      weights_at(const dealii::Point<dim> &point) const
      {
        const dealii::Tensor<1, dim> x = place_of_box.in_box(point);
        // In the coordinates t of the cell its centre is at 0 and its faces are
        // at -1 and 1. The simplex follows from the order of the |t_d|: with
        // the largest one first, the point lies in the pyramid of that face,
        // and in 3D in the triangle of that face towards the edge of the second
        // one. The barycentric coordinates are the differences of successive
        // |t_d|, beginning with 1 - |t_d| for the centre; what remains is
        // divided between the two ends of the edge by the last coordinate.
        dealii::Tensor<1, dim>        t;
        Number                        at;
        std::array<unsigned int, dim> by_size;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double place = x[d] * (box.cells[d] / box.lengths[d]);
            const auto   cell  = static_cast<unsigned int>(
              std::clamp(std::floor(place), 0., box.cells[d] - 1.));
            at[d]      = 2 * cell + 1;
            t[d]       = 2. * (place - cell) - 1.;
            by_size[d] = d;
          }
        std::sort(by_size.begin(),
                  by_size.end(),
                  [&t](const unsigned int a, const unsigned int b) {
                    return std::abs(t[a]) > std::abs(t[b]);
                  });
        typename LinearFields<dim>::Weights result;
        // At each step the place moves from a centre to that of a face or edge
        // of lower dimension, in the direction in which the point lies.
        double left = 1.;
        for (unsigned int k = 0; k + 1 < dim; ++k)
          {
            const unsigned int d = by_size[k];
            result[k]            = {number(at), left - std::abs(t[d])};
            left                 = std::abs(t[d]);
            at[d] += t[d] < 0. ? -1 : 1;
          }
        // The remaining weight is that of the edge along the direction in which
        // the point is nearest to the centre, at whose ends this coordinate is
        // -1 and 1.
        const unsigned int along = by_size[dim - 1];
        --at[along];
        result[dim - 1] = {number(at), 0.5 * (left - t[along])};
        at[along] += 2;
        result[dim] = {number(at), 0.5 * (left + t[along])};
        return result;
      }

      std::vector<dealii::Point<dim>> vertices;

    private:
      unsigned int
      number(const Number &place) const
      {
        unsigned int k = 0;
        for (unsigned int d = dim; d-- > 0;)
          k = k * (2 * box.cells[d] + 1) + place[d];
        return numbers[k];
      }

      const BoxParameters       box;
      const Place<dim>          place_of_box;
      std::vector<unsigned int> numbers; ///< where there is a vertex
    };
  } // namespace



  template <int dim>
  LinearFields<dim>
  Box<dim>::linear_fields() const
  {
    const auto lattice = std::make_shared<const Lattice<dim>>(parameters);
    return {lattice->vertices, [lattice](const dealii::Point<dim> &point) {
              return lattice->weights_at(point);
            }};
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  Box<dim>::coarser_whole() const
  {
    // The shortest side of the cells is sought among the directions that still
    // have several cells, since those of one cell cannot be joined any more.
    double shortest = infinity;
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
    return std::make_unique<Box>(coarse);
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  Box<dim>::coarser_level() const
  {
    std::unique_ptr<Body<dim>> coarser = Body<dim>::coarser_level();
    // If the thickness has one cell already, the cells of the other directions
    // would become longer with each level, and a smoother reduces errors badly
    // along them.
    if (coarser && stretch<dim>(static_cast<const Box &>(*coarser).parameters) >
                     std::max(most_stretched, 1.1 * stretch<dim>(parameters)))
      return nullptr;
    return coarser;
  }



  template <int dim>
  dealii::Tensor<2, dim>
  rotation_matrix(const double degrees)
  {
    namespace Rotations = dealii::Physics::Transformations::Rotations;
    const double angle  = degrees * dealii::numbers::PI / 180.;
    if constexpr (dim == 2)
      return Rotations::rotation_matrix_2d(angle);
    else
      return Rotations::rotation_matrix_3d(dealii::Tensor<1, 3>({0., 0., 1.}),
                                           angle);
  }



  DEBOND_INSTANTIATE(rotation_matrix);
  DEBOND_INSTANTIATE(box_sides);
  DEBOND_INSTANTIATE(part_of_box);
  DEBOND_INSTANTIATE_CLASS(Box);
} // namespace Debond
