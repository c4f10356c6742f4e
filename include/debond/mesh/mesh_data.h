// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_mesh_data_h
#define debond_mesh_mesh_data_h

#include <deal.II/grid/tria.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <vector>

namespace Debond
{
  /// Vertices, cells and faces of which deal.II makes a mesh.
  template <int dim>
  struct MeshData
  {
    std::vector<dealii::Point<dim>>    vertices;
    std::vector<dealii::CellData<dim>> cells;
    dealii::SubCellData                faces; ///< with ids of their own

    template <typename Corners>
    void
    add_cell(const Corners &corners, const dealii::types::material_id id)
    {
      add(corners, cells).material_id = id;
    }

    template <typename Corners>
    void
    add_face(const Corners &corners, const dealii::types::boundary_id id)
    {
      if constexpr (dim == 2)
        add(corners, faces.boundary_lines).boundary_id = id;
      else
        add(corners, faces.boundary_quads).boundary_id = id;
    }

    /// A face between two cells, which deal.II lets have no boundary id.
    template <typename Corners>
    void
    add_inner_face(const Corners &corners, const dealii::types::manifold_id id)
    {
      add_face(corners, dealii::numbers::internal_face_boundary_id);
      if constexpr (dim == 2)
        faces.boundary_lines.back().manifold_id = id;
      else
        faces.boundary_quads.back().manifold_id = id;
    }

    /// Fills an empty triangulation.
    void
    make_mesh(dealii::Triangulation<dim> &mesh) const
    {
      mesh.create_triangulation(vertices, cells, faces);
    }

  private:
    template <typename Corners, typename List>
    static auto &
    add(const Corners &corners, List &list)
    {
      list.emplace_back(static_cast<unsigned int>(corners.size()));
      std::copy(corners.begin(), corners.end(), list.back().vertices.begin());
      return list.back();
    }
  };
} // namespace Debond

#endif
