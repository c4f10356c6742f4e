// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_bisection_h
#define debond_mesh_bisection_h

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <set>
#include <vector>

namespace Debond
{
  /**
   * A conforming mesh of simplices that is refined locally by Maubach's
   * bisection (SIAM J. Sci. Comput. 16, 1995). A simplex has an order of its
   * vertices x_0, ..., x_d and a tag k in 1, ..., d: it is cut at the middle z
   * of x_0 x_k into
   *
   *     (x_0, ..., x_{k-1}, z, x_{k+1}, ..., x_d)
   *     (x_1, ..., x_k,     z, x_{k+1}, ..., x_d)
   *
   * with the tag k - 1, or d after 1. A simplex with the middle of one of its
   * edges on it is cut as well, until there is none: meshes stay conforming. Of
   * each simplex of the first mesh there are only finitely many similarity
   * classes.
   *
   * Vertices at one place, as the two sides of a Cut have them, count as one in
   * all of this, so that both sides stay alike.
   *
   * The first mesh needs orders and tags that fit together. These are
   *  - the order in which crossed_subdivision() lists the vertices, with the
   *    tag 1, if neighbours satisfy the condition of Stevenson (Math. Comp. 77,
   *    2008): all meshes are conforming then, however cells are chosen;
   *  - in 2D otherwise, the longest edge first: any choice of first edges will
   *    do (Karkulik, Pavlicek, Praetorius, Constr. Approx. 38, 2013);
   *  - in 3D otherwise, the order of four colours of the vertices, no two alike
   *    in a cell, with the tag 3, which satisfies Stevenson's condition; few
   *    meshes have such a colouring.
   */
  template <int dim>
  class Bisection
  {
  public:
    /// Takes cells, boundary and material ids of @p mesh. Throws
    /// std::invalid_argument if there are no such orders.
    explicit Bisection(const dealii::Triangulation<dim> &mesh);

    /// Cuts each cell at least @p times as often, in the order of the active
    /// cells of make_mesh().
    void
    refine(const std::vector<unsigned int> &times);

    unsigned int
    n_cells() const
    {
      return static_cast<unsigned int>(cells.size());
    }

    /// Returns the vertices. Those before a refinement keep their numbers.
    const std::vector<dealii::Point<dim>> &
    vertices() const
    {
      return points;
    }

    /// Returns for each cell the one before the last refine() that it is a part
    /// of.
    const std::vector<unsigned int> &
    ancestors() const
    {
      return whole_cells;
    }

    /// Fills an empty triangulation, with vertices and cells in this order.
    void
    make_mesh(dealii::Triangulation<dim> &mesh) const;

  private:
    struct Simplex
    {
      std::array<unsigned int, dim + 1> vertices; ///< x_0, ..., x_dim
      unsigned int                      tag;

      /// The boundary ids of the faces opposite to the vertices,
      /// internal_face_boundary_id of those inside.
      std::array<dealii::types::boundary_id, dim + 1> boundaries;
      dealii::types::material_id                      material;

      unsigned int cuts_left = 0; ///< during refine()
      unsigned int whole     = 0; ///< the cell before it
    };

    /// The numbers with one for all vertices at one place.
    template <std::size_t n>
    std::array<unsigned int, n>
    joined(std::array<unsigned int, n> numbers) const
    {
      if (!twins.empty())
        for (unsigned int &v : numbers)
          v = twins[v];
      return numbers;
    }

    void
    find_twins();

    /// Tries the tag 1 with the order of the vertices as it is.
    bool
    is_compatible_as_it_is() const;

    void
    put_longest_edges_first();

    /// Returns whether there is a colouring.
    bool
    order_by_colours();

    /// The pairs of cells at the faces inside, each with the position of the
    /// vertex that is not on the face.
    struct Neighbours
    {
      std::array<unsigned int, 2> cells;
      std::array<unsigned int, 2> opposite;
    };

    std::vector<Neighbours>
    neighbours() const;

    std::vector<dealii::Point<dim>> points;
    std::vector<unsigned int>       twins; ///< of each point; or empty
    std::vector<Simplex>            cells;
    std::vector<unsigned int>       whole_cells; ///< see ancestors()
  };
} // namespace Debond

#endif
