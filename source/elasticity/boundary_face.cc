// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>

#include <debond/elasticity/boundary_face.h>

#include <stdexcept>

namespace Debond
{
  template <int dim>
  std::vector<BoundaryFace<dim>>
  boundary_faces(const dealii::DoFHandler<dim>              &dofs,
                 const std::set<dealii::types::boundary_id> &boundaries,
                 const BoundaryNames                        &names,
                 const bool                                  is_piece)
  {
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
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary() &&
            boundaries.count(cell->face(f)->boundary_id()) > 0)
          {
            fe_values.reinit(cell, f);
            cell->get_dof_indices(cell_dofs);
            BoundaryFace<dim> face;
            face.id      = cell->face(f)->boundary_id();
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
                for (unsigned int d = 0; d < dim; ++d)
                  face.dofs[n][d] = cell_dofs[i] + d;
              }
            missing.erase(face.id);
            faces.push_back(face);
          }
    if (!missing.empty() && !is_piece)
      throw std::invalid_argument(
        "Boundary conditions: " + boundary_name(names, *missing.begin()) +
        " is clamped or a contact boundary, but the mesh has no such "
        "boundary.");
    return faces;
  }



  template decltype(boundary_faces<2>) boundary_faces<2>;
  template decltype(boundary_faces<3>) boundary_faces<3>;
} // namespace Debond
