// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/tensor.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>

#include <debond/mesh/crossed_mesh.h>

#include <sstream>
#include <stdexcept>
#include <vector>

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

          bool hanging_nodes = cell->level() + 1u != coarse.n_levels();
          for (const auto &face : cell->face_iterators())
            hanging_nodes = hanging_nodes || face->has_children();
          if (hanging_nodes)
            throw std::invalid_argument(
              "Crossed subdivision: the coarse mesh is locally refined; all "
              "its active cells must be on one level.");
        }
    }



    /// The cell with the given corners; throws if it is turned inside out.
    template <int dim>
    dealii::CellData<dim>
    simplex(const std::array<unsigned int, dim + 1> &corners,
            const std::vector<dealii::Point<dim>>   &vertices)
    {
      dealii::Tensor<2, dim> edges;
      for (unsigned int d = 0; d < dim; ++d)
        edges[d] = vertices[corners[d + 1]] - vertices[corners[0]];

      if (!(dealii::determinant(edges) > 0.))
        {
          std::ostringstream message;
          message << "Crossed subdivision: the coarse cell with centre ("
                  << vertices[corners[dim]]
                  << ") is so distorted that its centre does not see all of "
                     "its faces.";
          throw std::invalid_argument(message.str());
        }

      dealii::CellData<dim> cell(dim + 1);
      cell.vertices.assign(corners.begin(), corners.end());
      return cell;
    }
  } // namespace



  template <int dim>
  void
  crossed_subdivision(const dealii::Triangulation<dim> &coarse,
                      dealii::Triangulation<dim>       &crossed)
  {
    check_coarse_mesh(coarse);
    std::vector<typename dealii::Triangulation<dim>::cell_iterator> cells;
    if (crossed.n_levels() != 0)
      throw std::invalid_argument(
        "Crossed subdivision: the triangulation to be filled is not empty.");
    cells.reserve(coarse.n_active_cells());
    for (const auto &cell : coarse.active_cell_iterators())
      cells.push_back(cell);
    const CellsAndVertices<dim> simplices =
      crossed_cells<dim>(cells, dealii::numbers::invalid_boundary_id);
    crossed.create_triangulation(simplices.vertices,
                                 simplices.cells,
                                 simplices.faces);
  }



  template <int dim>
  CellsAndVertices<dim>
  crossed_cells(
    const std::vector<typename dealii::Triangulation<dim>::cell_iterator>
                                    &coarse_cells,
    const dealii::types::boundary_id id_of_cuts)
  {
    const dealii::Triangulation<dim> &coarse =
      coarse_cells.front()->get_triangulation();

    // The vertices and the faces of the cells.
    std::vector<unsigned int> new_index(coarse.n_vertices(), 0),
      n_cells_at(coarse.n_raw_faces(), 0);
    for (const auto &cell : coarse_cells)
      {
        for (const unsigned int v : cell->vertex_indices())
          new_index[cell->vertex_index(v)] = 1;
        for (const unsigned int f : cell->face_indices())
          ++n_cells_at[cell->face_index(f)];
      }
    CellsAndVertices<dim>               result;
    std::vector<dealii::Point<dim>>    &vertices = result.vertices;
    std::vector<dealii::CellData<dim>> &cells    = result.cells;
    dealii::SubCellData                &subcells = result.faces;
    for (unsigned int v = 0; v < new_index.size(); ++v)
      if (new_index[v] != 0)
        {
          new_index[v] = static_cast<unsigned int>(vertices.size());
          vertices.push_back(coarse.get_vertices()[v]);
        }

    // Only in 3D do the faces have a centre of their own.
    std::vector<unsigned int> face_centres(
      dim == 3 ? coarse.n_raw_faces() : 0,
      dealii::numbers::invalid_unsigned_int);

    cells.reserve(coarse_cells.size() * (dim == 2 ? 4 : 24));
    for (const auto &cell : coarse_cells)
      {
        const unsigned int cell_centre =
          static_cast<unsigned int>(vertices.size());
        vertices.push_back(cell->center());

        // A simplex on the edge ab of a face, (a, b, cell_centre) in 2D and
        // (a, b, face_centre, cell_centre) in 3D.
        const auto add_cell =
          [&](const std::array<unsigned int, dim + 1> &corners) {
            cells.push_back(simplex<dim>(corners, vertices));
            cells.back().material_id = cell->material_id();
          };

        for (const unsigned int f : cell->face_indices())
          {
            const auto face = cell->face(f);
            const bool is_cut =
              !face->at_boundary() && n_cells_at[cell->face_index(f)] == 1;

            // The corners as the cell numbers them, so that the orientation
            // of the simplices is known beforehand.
            const auto corner = [&](const unsigned int v) {
              return new_index[cell->vertex_index(
                dealii::GeometryInfo<dim>::face_to_cell_vertices(f, v))];
            };

            const auto add_face =
              [&](auto &faces, const std::vector<unsigned int> &corners) {
                // Triangulation gives all other faces these ids by itself.
                if (!face->at_boundary() && !is_cut)
                  return;
                faces.emplace_back(dim);
                faces.back().vertices = corners;
                faces.back().boundary_id =
                  is_cut ? id_of_cuts : face->boundary_id();
              };

            if constexpr (dim == 2)
              {
                unsigned int a = corner(0);
                unsigned int b = corner(1);
                if (f == 0 || f == 3)
                  std::swap(a, b);
                add_cell({{a, b, cell_centre}});
                add_face(subcells.boundary_lines, {a, b});
              }
            else
              {
                unsigned int &face_centre = face_centres[face->index()];
                const bool    is_new =
                  face_centre == dealii::numbers::invalid_unsigned_int;
                if (is_new)
                  {
                    face_centre = static_cast<unsigned int>(vertices.size());
                    vertices.push_back(face->center());
                  }

                // deal.II numbers the corners of a quadrilateral line by line,
                // here they are needed along its circumference.
                constexpr std::array<unsigned int, 4> circumference = {
                  {0, 1, 3, 2}};
                for (unsigned int e = 0; e < 4; ++e)
                  {
                    unsigned int a = corner(circumference[e]);
                    unsigned int b = corner(circumference[(e + 1) % 4]);
                    if (f % 2 == 1)
                      std::swap(a, b);
                    add_cell({{a, b, face_centre, cell_centre}});
                    if (is_new)
                      add_face(subcells.boundary_quads, {a, b, face_centre});
                  }
              }
          }
      }

    return result;
  }



  template decltype(crossed_subdivision<2>) crossed_subdivision<2>;
  template decltype(crossed_subdivision<3>) crossed_subdivision<3>;
  template decltype(crossed_cells<2>)       crossed_cells<2>;
  template decltype(crossed_cells<3>)       crossed_cells<3>;
} // namespace Debond
