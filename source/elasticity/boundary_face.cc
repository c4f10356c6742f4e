// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/linear_simplex.h>

#include <stdexcept>

namespace Debond
{
  template <int dim>
  BoundaryFace<dim>::BoundaryFace(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const unsigned int                                            face_no)
  {
    id                             = cell->face(face_no)->boundary_id();
    const auto           reference = cell->reference_cell();
    const CellNodes<dim> cell_nodes(cell);
    n_nodes = n_coefficients(dim, cell->get_fe().degree);
    unsigned int                  opposite = dim * (dim + 1) / 2;
    std::array<unsigned int, dim> cell_vertices;
    for (unsigned int v = 0; v < dim; ++v)
      {
        cell_vertices[v] = reference.face_to_cell_vertices(face_no, v, 1);
        opposite -= cell_vertices[v];
      }
    for (unsigned int n = 0; n < n_nodes; ++n)
      {
        const unsigned int node =
          n < dim ? cell_vertices[n] :
                    dim + 1 +
                      edge_between(cell_vertices[simplex_edges[n - dim][0]],
                                   cell_vertices[simplex_edges[n - dim][1]]);
        indices[n]   = cell_nodes.indices[node];
        positions[n] = node_position<dim>(cell, node);
        dofs[n]      = cell_nodes.dofs[node];
      }

    // The basis function of the opposite vertex grows inwards.
    const LinearSimplex<dim>     simplex(cell);
    const dealii::Tensor<1, dim> inward = simplex.gradients[opposite];

    measure = dim * simplex.volume * inward.norm();
    normal  = -inward / inward.norm();
  }



  template <int dim>
  std::vector<BoundaryFace<dim>>
  boundary_faces(const dealii::DoFHandler<dim>              &dofs,
                 const std::set<dealii::types::boundary_id> &boundaries,
                 const BoundaryNames                        &names,
                 const bool                                  is_piece)
  {
    std::vector<BoundaryFace<dim>>       faces;
    std::set<dealii::types::boundary_id> missing = boundaries;
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() &&
            boundaries.count(cell->face(f)->boundary_id()) > 0)
          {
            missing.erase(cell->face(f)->boundary_id());
            faces.emplace_back(cell, f);
          }
    if (!missing.empty() && !is_piece)
      throw std::invalid_argument(
        "Boundary conditions: " + boundary_name(names, *missing.begin()) +
        " is clamped or a contact boundary, but the mesh has no such "
        "boundary.");
    return faces;
  }



  template struct BoundaryFace<2>;
  template struct BoundaryFace<3>;
  template decltype(boundary_faces<2>) boundary_faces<2>;
  template decltype(boundary_faces<3>) boundary_faces<3>;
} // namespace Debond
