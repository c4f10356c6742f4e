// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/tensor.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/reference_cell.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/mesh/crossed_mesh.h>

#include <stdexcept>
#include <utility>

namespace Debond
{
  namespace
  {
    template <int dim>
    void
    check_coarse_mesh(const dealii::Triangulation<dim> &coarse)
    {
      if (coarse.n_active_cells() == 0)
        throw std::invalid_argument(
          "Crossed subdivision: the coarse mesh has no cells.");

      for (const auto &cell : coarse.active_cell_iterators())
        {
          if (!cell->reference_cell().is_hyper_cube())
            throw std::invalid_argument(
              "Crossed subdivision: the coarse mesh has a cell that is no " +
              std::string(dim == 2 ? "quadrilateral." : "hexahedron."));

          // All active cells have to be on the finest level. A coarser one
          // would be cut from its own corners, and its simplices would not fit
          // those of its finer neighbours.
          bool hanging_nodes = cell->level() + 1u != coarse.n_levels();
          for (const auto &face : cell->face_iterators())
            hanging_nodes = hanging_nodes || face->has_children();
          if (hanging_nodes)
            throw std::invalid_argument(
              "Crossed subdivision: the coarse mesh is locally refined; all "
              "its active cells must be on one level.");
        }
    }



    template <typename Object>
    std::vector<unsigned int>
    corners_of(const Object &object)
    {
      std::vector<unsigned int> corners;
      for (const unsigned int v : object->vertex_indices())
        corners.push_back(object->vertex_index(v));
      return corners;
    }
  } // namespace



  template <int dim>
  unsigned int
  CellCrossing<dim>::add_centre(const Corners &corners)
  {
    dealii::Point<dim> sum;
    for (const unsigned int v : corners)
      sum += vertices[v];
    vertices.push_back(sum / static_cast<double>(corners.size()));
    return static_cast<unsigned int>(vertices.size() - 1);
  }



  template <int dim>
  std::vector<typename CellCrossing<dim>::Corners>
  CellCrossing<dim>::parts(const Corners &face)
  {
    // A face has dim corners if it is that of a simplex, and in 2D each side is
    // a line. Only the quadrilaterals of hexahedra, prisms and pyramids are
    // cut. Their centre is looked up by their sorted corners, so that both
    // cells at a face get the same vertex.
    if (face.size() == dim)
      return {face};
    std::array<unsigned int, 4> key;
    std::copy_n(face.begin(), 4, key.begin());
    std::sort(key.begin(), key.end());
    const auto [centre, is_new] = centres.emplace(key, 0);
    if (is_new)
      centre->second = add_centre(face);
    // deal.II numbers the corners of a quadrilateral line by line, here they
    // are needed along the circumference. Each triangle has the edge first and
    // the centre last, which is the order that bisection needs (Bisection).
    const unsigned int c = centre->second;
    return {{face[0], face[1], c},
            {face[1], face[3], c},
            {face[3], face[2], c},
            {face[2], face[0], c}};
  }



  template <int dim>
  std::vector<typename CellCrossing<dim>::Corners>
  CellCrossing<dim>::simplices(const Corners &cell)
  {
    // The order of the vertices in each simplex is that of Maubach's bisection
    // with the tag 1: the two ends of an edge of the cell, in 3D the centre of
    // the face, the centre of the cell. So the first edge to be cut is the
    // longest one in a cube, and neighbours fit together.
    if (cell.size() == dim + 1)
      return {cell};
    const auto kind = dealii::ReferenceCell::n_vertices_to_type(
      dim, static_cast<unsigned int>(cell.size()));
    const unsigned int   centre = add_centre(cell);
    std::vector<Corners> result;
    for (const unsigned int f : kind.face_indices())
      {
        Corners face;
        for (const unsigned int v :
             kind.face_reference_cell(f).vertex_indices())
          face.push_back(cell[kind.face_to_cell_vertices(f, v, 1)]);
        for (Corners &part : parts(face))
          {
            // The corners of deal.II's faces turn to the left or to the right
            // as seen from the centre, depending on the number of the face.
            // Exchanging the ends of the edge makes the volumes positive for
            // quadrilaterals and hexahedra and does not change how the simplex
            // is bisected.
            part.push_back(centre);
            if (dim == 2 ? f % 2 == f / 2 : f % 2 == 1)
              std::swap(part[0], part[1]);
            result.push_back(std::move(part));
          }
      }
    return result;
  }



  template <int dim>
  MeshData<dim>
  crossed_subdivision(const dealii::Triangulation<dim> &coarse)
  {
    check_coarse_mesh(coarse);
    MeshData<dim> crossed;
    crossed.vertices = coarse.get_vertices();
    CellCrossing<dim> crossing(crossed.vertices);
    for (const auto &cell : coarse.active_cell_iterators())
      {
        // A simplex of negative volume has a face of the cell on the wrong side
        // of the centre. The sign also fails the test for coordinates that are
        // no numbers.
        for (const auto &simplex : crossing.simplices(corners_of(cell)))
          {
            dealii::Tensor<2, dim> edges;
            for (unsigned int d = 0; d < dim; ++d)
              edges[d] =
                crossed.vertices[simplex[d + 1]] - crossed.vertices[simplex[0]];
            if (!(dealii::determinant(edges) > 0.))
              throw std::invalid_argument(words(
                "Crossed subdivision: the coarse cell with centre (",
                cell->center(),
                ") is so distorted that its centre does not see all of its "
                "faces."));
            crossed.add_cell(simplex, cell->material_id());
          }
        // Triangulation gives the faces inside their boundary ids by itself,
        // but not the manifold ids by which a cut finds them, and wants each of
        // them once.
        for (const unsigned int f : cell->face_indices())
          {
            const auto face = cell->face(f);
            const bool is_inner =
              !face->at_boundary() &&
              face->manifold_id() != dealii::numbers::flat_manifold_id &&
              cell->active_cell_index() <
                cell->neighbor(f)->active_cell_index();
            if (!face->at_boundary() && !is_inner)
              continue;
            for (const auto &part : crossing.parts(corners_of(face)))
              if (is_inner)
                crossed.add_inner_face(part, face->manifold_id());
              else
                crossed.add_face(part, face->boundary_id());
          }
      }
    // The vertices of a refined coarse mesh may include some that no active
    // cell has.
    dealii::GridTools::delete_unused_vertices(crossed.vertices,
                                              crossed.cells,
                                              crossed.faces);
    return crossed;
  }



  DEBOND_INSTANTIATE_CLASS(CellCrossing);
  DEBOND_INSTANTIATE(crossed_subdivision);
} // namespace Debond
