// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_node_supports_h
#define debond_elasticity_node_supports_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/lac/affine_constraints.h>

#include <debond/base/dof_vector.h>
#include <debond/elasticity/boundary_conditions.h>
#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/change_of_basis.h>
#include <debond/elasticity/node_pairs.h>
#include <debond/elasticity/rigid_motions.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace Debond
{
  /// A degree of freedom that a support prescribes. Of several supports of a
  /// vertex the first one bears a direction.
  struct SupportedDof
  {
    dealii::types::global_dof_index dof;
    unsigned int                    support; ///< of NodeSupports::names()
  };



  /// A node where displacements are prescribed along orthonormal directions.
  template <int dim>
  struct PrescribedNode
  {
    struct Row
    {
      dealii::Tensor<1, dim> direction;
      double                 value;
      unsigned int           support;
    };

    /// The least displacement that satisfies the rows.
    dealii::Tensor<1, dim>
    displacement() const;

    /// Adds what a row prescribes beside the others. Returns whether it does
    /// not contradict them.
    bool
    add(Row row);

    /// Prescribes zero in all other directions.
    void
    fix_rest();

    unsigned int       node     = 0; ///< its number
    dealii::Point<dim> position = {};
    std::vector<Row>   rows     = {};
  };



  /**
   * What supports prescribe at the nodes of a mesh, and the frames of the nodes
   * whose unknowns are not Cartesian. It is made step by step: clamps first,
   * then other displacements, then the contact boundary constrains its nodes
   * (see make_contact_space()), and finish() all that are left.
   */
  template <int dim>
  class NodeSupports
  {
  public:
    NodeSupports() = default;

    /// @p n_prescribed: the number of degrees of freedom if displacements that
    /// are not zero may be prescribed, and else 0.
    explicit NodeSupports(const unsigned int n_prescribed)
      : prescribed(n_prescribed)
    {}

    /// Clamps the nodes of these faces.
    void
    clamp(const std::vector<BoundaryFace<dim>> &faces,
          const BoundaryConditions             &conditions);

    /// Notes what @p condition prescribes at the nodes of these faces, those of
    /// its boundaries; at edges that have coefficients in the @p basis those of
    /// its values. Throws SupportError if that contradicts another support or
    /// the foundation, is not finite, or if a roller is not flat.
    void
    prescribe(const std::vector<BoundaryFace<dim>> &faces,
              const PrescribedDisplacement<dim>    &condition,
              const BoundaryConditions             &conditions,
              const ChangeOfBasis<dim>             &basis);

    /// Makes displacements that are prescribed at the first nodes of @p pairs
    /// those of jumps, after exchanging both where only the first one is
    /// supported. Throws std::invalid_argument if both nodes of a
    /// pair are supported, and neither as far as the other one.
    void
    glue(NodePairs<dim> &pairs);

    /// Of a first node of a pair that is supported, the supports of the bodies
    /// on the high and on the low side; null of others.
    const std::array<unsigned int, 2> *
    supports_of_pair(const unsigned int first) const
    {
      const auto entry = glued_supports.find(first);
      return entry == glued_supports.end() ? nullptr : &entry->second;
    }

    /// Whether the node is one of NodePairs::ends().
    bool
    is_end_of_interface(const unsigned int index) const
    {
      return ends_of_interfaces.count(index) > 0;
    }

    /// What prescribe() has noted of a node; nothing of most.
    PrescribedNode<dim>
    prescribed_at(const unsigned int        index,
                  const dealii::Point<dim> &position) const;

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

    /// Constrains the nodes that prescribe() has noted and nobody constrained.
    /// Returns the directions of all that is constrained.
    std::vector<Support<dim>>
    finish();

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

    /// The step of a ChangeOfBasis from Cartesian components to those in the
    /// nodes' own frames.
    const std::vector<BasisRow<dim>> &
    frames() const
    {
      return node_frames;
    }

    /// The pieces of the boundary that support the body.
    const std::vector<std::string> &
    names() const
    {
      return support_names;
    }

    const std::vector<SupportedDof> &
    supported() const
    {
      return supported_dofs;
    }

  private:
    using Row = typename PrescribedNode<dim>::Row;

    /// Constrains a degree of freedom to a displacement.
    void
    constrain(const dealii::types::global_dof_index dof,
              const double                          value,
              const unsigned int                    support);

    std::vector<BasisRow<dim>>        node_frames;
    dealii::AffineConstraints<double> fixed;
    DofVector                         prescribed;
    std::vector<std::string>          support_names;
    std::vector<SupportedDof>         supported_dofs;

    // Until it is finished.
    std::map<unsigned int, PrescribedNode<dim>> prescribed_nodes; ///< by node
    std::set<unsigned int>                      nodes_with_frames;
    std::vector<Support<dim>>                   held;
    std::set<unsigned int>                      ends_of_interfaces;
    std::map<unsigned int, std::array<unsigned int, 2>> glued_supports;
  };
} // namespace Debond

#endif
