// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/base/text.h>
#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/contact_nodes.h>
#include <debond/elasticity/rigid_motions.h>
#include <debond/elasticity/unknowns.h>
#include <debond/mesh/crossed_mesh.h>

#include <set>
#include <stdexcept>
#include <string>

namespace Debond
{
  template <int dim>
  ElasticUnknowns<dim>::ElasticUnknowns(
    const dealii::Triangulation<dim> &triangulation,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const unsigned int                degree,
    const std::vector<unsigned int>  &node_order)
    : mapping_p1(dealii::FE_SimplexP<dim>(1))
    , fe(dealii::FE_SimplexP<dim>(degree), dim)
    , dofs(triangulation)
  {
    if (!triangulation.all_reference_cells_are_simplex() ||
        triangulation.has_hanging_nodes())
      throw std::invalid_argument(
        "The elastic problem needs a mesh of simplices without hanging nodes.");
    for (const dealii::types::boundary_id id : conditions.contact)
      if (conditions.clamped.count(id) > 0)
        throw std::invalid_argument(
          "Boundary conditions: " + boundary_name(conditions.names, id) +
          " is both clamped and a contact boundary.");

    dofs.distribute_dofs(fe);
    const bool is_piece = !node_order.empty();
    if (is_piece)
      {
        std::vector<dealii::types::global_dof_index> numbers(dofs.n_dofs());
        for (const auto &cell : dofs.active_cell_iterators())
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int d = 0; d < dim; ++d)
              numbers[cell->vertex_dof_index(v, d)] =
                node_order[cell->vertex_index(v)] * dim + d;
        dofs.renumber_dofs(numbers);
      }
    const double diameter = [&] {
      const auto corners =
        dealii::BoundingBox<dim>(triangulation.get_vertices())
          .get_boundary_points();
      return corners.first.distance(corners.second);
    }();

    // G of most scenes is zero, and then there is none.
    gap.reinit(supports.gaps.empty() ? 0 : dofs.n_dofs());
    const auto faces = [&](const std::set<dealii::types::boundary_id> &ids) {
      return boundary_faces(dofs, ids, conditions.names, is_piece);
    };
    node_supports =
      NodeSupports<dim>(n_nodes(triangulation, degree),
                        supports.displacements.empty() ? 0 : dofs.n_dofs());
    node_supports.clamp(faces(conditions.clamped), conditions);
    for (const PrescribedDisplacement<dim> &condition : supports.displacements)
      node_supports.prescribe(faces(condition.boundaries),
                              condition,
                              conditions);
    contact_space = make_contact_space(faces(conditions.contact),
                                       degree,
                                       conditions,
                                       supports,
                                       diameter,
                                       node_supports,
                                       gap);
    std::vector<Support<dim>> held = node_supports.finish();
    if (gap.size() > 0 && gap.all_zero())
      gap.reinit(0);

    if (!is_piece)
      free_motions = free_rigid_motions(held, diameter);
    if (!free_motions.motions.empty())
      {
        for (const auto &node : contact_space.boundary().nodes)
          held.push_back({node.position, node.normal});
        const std::vector<std::string> motions =
          free_rigid_motions(held, diameter).names;
        if (!motions.empty())
          throw std::invalid_argument(
            "Boundary conditions leave a rigid motion free: " +
            join(motions, ", ") + ". Clamp a side.");
      }
  }



  template <int dim>
  const dealii::DoFHandler<dim> &
  ElasticUnknowns<dim>::dof_handler() const
  {
    return dofs;
  }



  template <int dim>
  const dealii::Mapping<dim> &
  ElasticUnknowns<dim>::mapping() const
  {
    return mapping_p1;
  }



  template <int dim>
  unsigned int
  ElasticUnknowns<dim>::degree() const
  {
    return fe.degree;
  }



  template <int dim>
  const ContactSpace<dim> &
  ElasticUnknowns<dim>::contact() const
  {
    return contact_space;
  }



  template <int dim>
  const std::vector<DisplacementFrame<dim>> &
  ElasticUnknowns<dim>::frames() const
  {
    return node_supports.frames();
  }



  template <int dim>
  const dealii::Tensor<2, dim> *
  ElasticUnknowns<dim>::directions(const unsigned int node_index) const
  {
    const DisplacementFrame<dim> *frame = node_supports.frame(node_index);
    return frame == nullptr ? nullptr : &frame->to_cartesian;
  }



  template <int dim>
  const std::vector<std::string> &
  ElasticUnknowns<dim>::support_names() const
  {
    return node_supports.names();
  }



  template <int dim>
  const FreeRigidMotions<dim> &
  ElasticUnknowns<dim>::held_by_contact() const
  {
    return free_motions;
  }



  template <int dim>
  const std::vector<SupportedDof> &
  ElasticUnknowns<dim>::supported() const
  {
    return node_supports.supported();
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::has_lifting() const
  {
    return has_prescribed_displacements() || has_gap();
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::has_prescribed_displacements() const
  {
    return node_supports.displacements().size() > 0;
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::has_gap() const
  {
    return gap.size() > 0;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::lifting(const LoadFactors factors) const
  {
    DofVector G(n_dofs());
    if (has_prescribed_displacements())
      G.equ(factors.displacements, node_supports.displacements());
    if (has_gap())
      G += gap;
    return G;
  }



  template <int dim>
  unsigned int
  ElasticUnknowns<dim>::n_dofs() const
  {
    return dofs.n_dofs();
  }



  template <int dim>
  unsigned int
  ElasticUnknowns<dim>::n_free_dofs() const
  {
    return n_dofs() - constraints().n_constraints();
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::is_constrained(
    const dealii::types::global_dof_index dof) const
  {
    return constraints().is_constrained(dof);
  }



  template <int dim>
  const dealii::AffineConstraints<double> &
  ElasticUnknowns<dim>::constraints() const
  {
    return node_supports.constraints();
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::cartesian_displacement(const DofVector  &w,
                                               const LoadFactors factors) const
  {
    DofVector u = w;
    if (has_lifting())
      u += lifting(factors);
    DofVector result = u;
    for (const DisplacementFrame<dim> &frame : frames())
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[frame.dofs[d]] = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result[frame.dofs[d]] +=
              frame.to_cartesian[d][k] * u[frame.dofs[k]];
        }
    return result;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::nodal_values(
    const DofVector &cartesian_displacement) const
  {
    DofVector result = cartesian_displacement;
    if (degree() == 2)
      for (const auto &cell : dofs.active_cell_iterators())
        {
          const CellNodes<dim> nodes(cell);
          for (unsigned int n = dim + 1; n < nodes.size; ++n)
            {
              const auto &[a, b] = simplex_edges[n - (dim + 1)];
              for (unsigned int d = 0; d < dim; ++d)
                result(nodes.dofs[n][d]) =
                  0.5 * cartesian_displacement(nodes.dofs[n][d]) +
                  0.25 * (cartesian_displacement(nodes.dofs[a][d]) +
                          cartesian_displacement(nodes.dofs[b][d]));
            }
        }
    return result;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::to_frames(const DofVector &cartesian) const
  {
    DofVector result = cartesian;
    for (const DisplacementFrame<dim> &frame : frames())
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_frame[k][d] * cartesian[frame.dofs[d]];
        }
    return result;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::from_cartesian(
    const DofVector &cartesian_displacement) const
  {
    DofVector result = to_frames(cartesian_displacement);
    if (has_lifting())
      result -= lifting();
    constraints().set_zero(result);
    return result;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::in_frames(const DofVector &forces) const
  {
    DofVector result = forces;
    for (const DisplacementFrame<dim> &frame : frames())
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_cartesian[d][k] * forces[frame.dofs[d]];
        }
    return result;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::cartesian_forces(const DofVector &forces) const
  {
    DofVector result = forces;
    for (const DisplacementFrame<dim> &frame : frames())
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[frame.dofs[d]] = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result[frame.dofs[d]] +=
              frame.to_frame[k][d] * forces[frame.dofs[k]];
        }
    return result;
  }



  template <int dim>
  std::vector<DofVector>
  ElasticUnknowns<dim>::rigid_body_modes() const
  {
    constexpr unsigned int n_rotations = dim * (dim - 1) / 2;
    std::vector<DofVector> modes(dim + n_rotations, DofVector(dofs.n_dofs()));
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const CellNodes<dim> nodes(cell);
        for (unsigned int n = 0; n < nodes.size; ++n)
          {
            const dealii::Point<dim> position = node_position<dim>(cell, n);
            for (unsigned int d = 0; d < dim; ++d)
              modes[d][nodes.dofs[n][d]] = 1.;
            // The rotation in the plane of the axes d and e.
            unsigned int rotation = dim;
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int e = d + 1; e < dim; ++e, ++rotation)
                {
                  modes[rotation][nodes.dofs[n][d]] = -position[e];
                  modes[rotation][nodes.dofs[n][e]] = position[d];
                }
          }
      }
    for (DofVector &mode : modes)
      {
        mode = to_frames(mode);
        constraints().set_zero(mode);
      }
    return modes;
  }



  template class ElasticUnknowns<2>;
  template class ElasticUnknowns<3>;
} // namespace Debond
