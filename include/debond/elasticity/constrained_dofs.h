// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_constrained_dofs_h
#define debond_elasticity_constrained_dofs_h

#include <deal.II/lac/affine_constraints.h>

#include <debond/elasticity/node_supports.h>
#include <debond/elasticity/rigid_motions.h>

namespace Debond
{
  /// A degree of freedom that a support prescribes. Of several supports of a
  /// vertex the first one bears a direction.
  struct SupportedDof
  {
    dealii::types::global_dof_index dof;
    unsigned int                    support; ///< of NodeSupports::names()
  };



  /// The displacements that are prescribed at nodes as constraints on unknowns,
  /// with the frames that nodes need for that, and the lifting.
  template <int dim>
  class ConstrainedDofs
  {
  public:
    ConstrainedDofs() = default;

    /// @p n_dofs: the number of unknowns.
    ConstrainedDofs(const unsigned int n_dofs, const Supports<dim> &supports)
      : prescribed(supports.displacements.empty() ? 0 : n_dofs)
      , gap(n_dofs)
    {}

    /// Constrains the node, unless that or a frame of its own is done.
    void
    constrain(const PrescribedNode<dim> &node);

    /// Gives the node a frame: @p free_directions, what is prescribed along
    /// the rows of @p node, and directions across, where zero is prescribed if
    /// @p fixes_rest. Throws as contact_frame() does.
    void
    add_frame(const PrescribedNode<dim>                 &node,
              const std::vector<dealii::Tensor<1, dim>> &free_directions,
              const bool                                 fixes_rest);

    /// Sets the gap at a normal displacement.
    void
    set_gap(const dealii::types::global_dof_index dof, const double value)
    {
      if (value != 0.)
        gap(dof) = value;
    }

    /// Constrains all nodes of @p supports that are left. Returns the
    /// directions of all that is constrained.
    std::vector<Support<dim>>
    finish(const NodeSupports<dim> &supports);

    const dealii::AffineConstraints<double> &
    constraints() const
    {
      return fixed;
    }

    /// The prescribed displacements for the whole load; empty if they are zero.
    const DofVector &
    displacements() const
    {
      return prescribed;
    }

    /// The gaps at normal displacements; empty if they are zero.
    const DofVector &
    gaps() const
    {
      return gap;
    }

    /// The step of a ChangeOfBasis from Cartesian components to those in the
    /// nodes' own frames.
    const std::vector<BasisRow<dim>> &
    frames() const
    {
      return node_frames;
    }

    const std::vector<SupportedDof> &
    supported() const
    {
      return supported_dofs;
    }

  private:
    /// Constrains a degree of freedom to a displacement.
    void
    constrain(const dealii::types::global_dof_index dof,
              const double                          value,
              const unsigned int                    support);

    std::vector<BasisRow<dim>>        node_frames;
    dealii::AffineConstraints<double> fixed;
    DofVector                         prescribed, gap;
    std::vector<SupportedDof>         supported_dofs;

    // Until it is finished.
    std::set<unsigned int>    done; ///< nodes
    std::vector<Support<dim>> held;
  };
} // namespace Debond

#endif
