// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_unknowns_h
#define debond_elasticity_unknowns_h

#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>

#include <debond/contact/contact_space.h>
#include <debond/elasticity/rigid_motions.h>
#include <debond/mesh/body.h>

#include <array>
#include <set>
#include <vector>

namespace Debond
{
  /// What is prescribed where.
  struct BoundaryConditions
  {
    std::set<dealii::types::boundary_id> clamped; ///< Gamma_D, u = 0
    std::set<dealii::types::boundary_id> contact; ///< Gamma_C

    /// The paper's simplification (7), u_tau = 0 on Gamma_C; otherwise
    /// sigma_tau = 0 there.
    bool tangential_displacement_fixed = true;

    /// For messages.
    BoundaryNames names = {};
  };



  /**
   * The unknowns of P1 elasticity on simplices: the Cartesian components of the
   * displacement at each vertex, except at the contact nodes, where they are
   * the components in the node's own frame: first u_nu (one degree of freedom,
   * so that the unilateral constraint is a simple bound), then the tangential
   * ones. A vertex where contact sides of different normals meet has one u_nu
   * for each of them; if tangential displacements are fixed there, it is
   * clamped. Normals that differ by less than 30 degrees count as one (their
   * mean), as on a polygonal approximation of a smooth side.
   *
   * All vectors have n_dofs() entries; the constrained ones are zero.
   */
  template <int dim>
  class ElasticUnknowns
  {
  public:
    /// The unknowns of a vertex on the contact boundary: x = to_frame u, where
    /// u are the Cartesian components, and u = to_cartesian x.
    struct Frame
    {
      std::array<dealii::types::global_dof_index, dim> dofs;
      dealii::Tensor<2, dim>                           to_frame;
      dealii::Tensor<2, dim>                           to_cartesian;
    };

    /// Keeps a reference to the triangulation, a connected mesh of simplices.
    /// Throws std::invalid_argument if a boundary is both clamped and contact
    /// or is not in the mesh, if contact_frame() does, or if a rigid motion is
    /// left free; the message names the motion ("translation in y", "rotation
    /// about z"). The unilateral condition on u_nu does not count as a
    /// support.
    ElasticUnknowns(const dealii::Triangulation<dim> &triangulation,
                    const BoundaryConditions         &conditions);

    ElasticUnknowns(const ElasticUnknowns &) = delete;

    const dealii::DoFHandler<dim> &
    dof_handler() const;

    const dealii::Mapping<dim> &
    mapping() const;

    const ContactSpace<dim> &
    contact() const;

    /// Of all vertices on the contact boundary that are not clamped.
    const std::vector<Frame> &
    contact_frames() const;

    /// The columns are the Cartesian directions of the vertex' unknowns; null
    /// where the unknowns are Cartesian.
    const dealii::Tensor<2, dim> *
    directions(const unsigned int vertex_index) const;

    unsigned int
    n_dofs() const;

    /// Unknowns of the discrete problem.
    unsigned int
    n_free_dofs() const;

    /// Whether a degree of freedom is fixed to zero (clamped or tangential).
    bool
    is_constrained(const dealii::types::global_dof_index dof) const;

    /// The fixed degrees of freedom.
    const dealii::AffineConstraints<double> &
    constraints() const;

    /// The Cartesian components of a vector of unknowns, at every vertex.
    dealii::Vector<double>
    cartesian_displacement(const dealii::Vector<double> &u) const;

    /// The vector of unknowns of a displacement that is given by its Cartesian
    /// components; constrained degrees of freedom are zero.
    dealii::Vector<double>
    from_cartesian(const dealii::Vector<double> &cartesian_displacement) const;

    /// Cartesian forces as forces in the unknowns' frames.
    dealii::Vector<double>
    in_frames(const dealii::Vector<double> &forces) const;

    /// The forces in the unknowns' frames (such as a residual) as Cartesian
    /// components.
    dealii::Vector<double>
    cartesian_forces(const dealii::Vector<double> &forces) const;

    /// Translations and rotations about the origin in the unknowns, zero where
    /// constrained: the near null space of A.
    std::vector<dealii::Vector<double>>
    rigid_body_modes() const;

  private:
    void
    clamp(const BoundaryConditions  &conditions,
          std::vector<Support<dim>> &supports);

    void
    clamp_vertex(
      const std::array<dealii::types::global_dof_index, dim> &vertex_dofs,
      const dealii::Point<dim>                               &position,
      std::vector<Support<dim>>                              &supports);

    void
    make_contact_boundary(const BoundaryConditions  &conditions,
                          const double               diameter,
                          std::vector<Support<dim>> &supports);

    const dealii::MappingFE<dim> mapping_p1;
    const dealii::FESystem<dim>  fe;
    dealii::DoFHandler<dim>      dofs;

    /// By vertex index, invalid_unsigned_int where the unknowns are Cartesian.
    std::vector<unsigned int> frame_of_vertex;
    std::vector<Frame>        frames;

    dealii::AffineConstraints<double> fixed;
    ContactSpace<dim>                 contact_space;
  };
} // namespace Debond

#endif
