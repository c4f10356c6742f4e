// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/mesh_body.h>
#include <debond/mesh/simplex_interpolation.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    template <typename Names>
    std::set<std::string>
    keys(const Names &names)
    {
      std::set<std::string> result;
      for (const auto &[name, unused] : names)
        result.insert(name);
      return result;
    }
  } // namespace



  template <int dim>
  MeshBody<dim>::MeshBody(const Source &make, const unsigned int n_refinements)
    : make(make)
    , n_refinements(n_refinements)
    , source(make(n_refinements))
    , is_simplicial(source->mesh.all_reference_cells_are_simplex())
  {
    // A crossed hexahedron has a vertex on each of its faces.
    std::map<std::string, std::set<unsigned int>> vertices, faces;
    for (const auto &face : source->mesh.active_face_iterators())
      if (face->at_boundary())
        for (const auto &[name, ids] : source->names.boundaries)
          if (ids.count(face->boundary_id()) > 0)
            {
              faces[name].insert(face->index());
              for (const unsigned int v : face->vertex_indices())
                vertices[name].insert(face->vertex_index(v));
            }
    const bool has_face_centres = dim == 3 && !is_simplicial;
    for (const auto &[name, on_boundary] : vertices)
      boundary_vertices[name] =
        static_cast<double>(on_boundary.size()) +
        (has_face_centres ? static_cast<double>(faces[name].size()) : 0.);
  }



  template <int dim>
  std::set<std::string>
  MeshBody<dim>::boundaries() const
  {
    return keys(source->names.boundaries);
  }



  template <int dim>
  std::set<std::string>
  MeshBody<dim>::regions() const
  {
    return keys(source->names.regions);
  }



  template <int dim>
  double
  MeshBody<dim>::n_cells() const
  {
    const double n = source->mesh.n_active_cells();
    return is_simplicial ? n : (dim == 2 ? 4. : 24.) * n;
  }



  template <int dim>
  double
  MeshBody<dim>::n_vertices() const
  {
    const double corners = source->mesh.n_used_vertices();
    if (is_simplicial)
      return corners;
    const double centres = source->mesh.n_active_cells();
    return corners + centres + (dim == 3 ? source->mesh.n_active_faces() : 0.);
  }



  template <int dim>
  double
  MeshBody<dim>::n_vertices_on(const std::string &boundary) const
  {
    return boundary_vertices.at(boundary);
  }



  template <int dim>
  BodyShape
  MeshBody<dim>::shape() const
  {
    const dealii::BoundingBox<dim> box(source->mesh.get_vertices());
    double                         measure = 0.;
    for (const auto &cell : source->mesh.active_cell_iterators())
      measure += cell->measure();
    const double edge =
      std::pow(measure / n_cells() * (dim == 2 ? 4. : 24.), 1. / dim);

    BodyShape shape = {};
    for (unsigned int d = 0; d < dim; ++d)
      {
        shape.lengths[d] = box.side_length(d);
        shape.cells[d]   = std::max(1., std::round(shape.lengths[d] / edge));
      }
    return shape;
  }



  template <int dim>
  PieceNames
  MeshBody<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    if (is_simplicial)
      {
        mesh.copy_triangulation(source->mesh);
        // Sides are flat between the vertices, wherever they came from.
        mesh.reset_all_manifolds();
      }
    else
      crossed_subdivision(source->mesh, mesh);
    return source->names;
  }



  template <int dim>
  std::unique_ptr<const Body<dim>>
  MeshBody<dim>::coarser() const
  {
    return n_refinements > 0 ?
             std::make_unique<const MeshBody>(make, n_refinements - 1) :
             nullptr;
  }



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  MeshBody<dim>::interpolate(
    const dealii::Triangulation<dim>          &mesh,
    const std::vector<dealii::Tensor<1, dim>> &values,
    const std::vector<dealii::Point<dim>>     &points) const
  {
    return interpolate_on_simplices(mesh, values, points);
  }



  template class MeshBody<2>;
  template class MeshBody<3>;
} // namespace Debond
