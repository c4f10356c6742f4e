// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>

#include <debond/base/instantiate.h>
#include <debond/base/ranks.h>
#include <debond/elasticity/boundary_face.h>
#include <debond/mesh/owned_cells.h>

#include <boost/serialization/array.hpp>

namespace Debond
{
  template <int dim>
  std::vector<BoundaryFace<dim>>
  boundary_faces(const dealii::DoFHandler<dim>              &dofs,
                 const std::set<dealii::types::boundary_id> &boundaries,
                 const BoundaryNames                        &names)
  {
    // Faces are flat, so that one quadrature point has the normal, and its JxW
    // is the measure of the face. Only own cells know their boundary ids: a
    // ghost's outer face has the id 0, whatever it is.
    const dealii::MappingFE<dim> mapping(dealii::FE_SimplexP<dim>(1));
    const auto                  &fe = dofs.get_fe();
    dealii::FEFaceValues<dim>    fe_values(mapping,
                                        fe,
                                        dealii::QGaussSimplex<dim - 1>(1),
                                        dealii::update_normal_vectors |
                                          dealii::update_JxW_values);
    std::vector<dealii::types::global_dof_index> cell_dofs(fe.dofs_per_cell);

    std::vector<BoundaryFace<dim>>       faces;
    std::set<dealii::types::boundary_id> missing = boundaries;
    for (const auto &cell : owned_cells(dofs))
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() &&
            boundaries.count(cell->face(f)->boundary_id()) > 0)
          {
            fe_values.reinit(cell, f);
            cell->get_dof_indices(cell_dofs);
            BoundaryFace<dim> face;
            face.cell = cell->id().get_coarse_cell_id();
            face.id   = cell->face(f)->boundary_id();
            // A node has dim unknowns in succession, so that the first of them
            // stands for the node. face_to_cell_index() lists vertices before
            // the middles of edges, in the order of the reference face, which
            // is that of simplex_edges.
            face.n_nodes = fe.n_dofs_per_face(f) / dim;
            face.measure = fe_values.JxW(0);
            face.normal  = fe_values.normal_vector(0);
            for (unsigned int n = 0; n < face.n_nodes; ++n)
              {
                const unsigned int i = fe.face_to_cell_index(n * dim, f);
                face.indices[n] = static_cast<unsigned int>(cell_dofs[i] / dim);
                face.positions[n] =
                  mapping.transform_unit_to_real_cell(cell,
                                                      fe.unit_support_point(i));
              }
            faces.push_back(face);
          }
    // All ranks get all faces, as laws, search and proof work on the whole
    // contact boundary. Ranks number the cells of their meshes as they like,
    // but the coarse ids are the places in the whole mesh; sorted by them the
    // list is the same on all ranks and for any number of them. The sort is
    // stable, as a cell may have several faces.
    if (const MPI_Comm ranks = dofs.get_communicator();
        number_of_ranks(ranks) > 1)
      {
        const auto all = dealii::Utilities::MPI::all_gather(ranks, faces);
        faces.clear();
        for (const auto &of_rank : all)
          faces.insert(faces.end(), of_rank.begin(), of_rank.end());
        std::stable_sort(faces.begin(),
                         faces.end(),
                         [](const auto &a, const auto &b) {
                           return a.cell < b.cell;
                         });
      }
    // Whether a boundary is missing is known only from the faces of all ranks.
    for (const BoundaryFace<dim> &face : faces)
      missing.erase(face.id);
    if (!missing.empty())
      throw std::invalid_argument(
        "Boundary conditions: " + boundary_name(names, *missing.begin()) +
        " is clamped or a contact boundary, but the mesh has no such "
        "boundary.");
    return faces;
  }



  template <int dim>
  std::vector<Facet<dim>>
  facets_of(const std::vector<BoundaryFace<dim>> &faces)
  {
    std::vector<Facet<dim>> facets(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
      {
        std::copy_n(faces[f].indices.begin(), dim, facets[f].vertices.begin());
        std::copy_n(faces[f].positions.begin(), dim, facets[f].corners.begin());
        facets[f].normal = faces[f].normal;
      }
    return facets;
  }



  DEBOND_INSTANTIATE(boundary_faces);
  DEBOND_INSTANTIATE(facets_of);
} // namespace Debond
