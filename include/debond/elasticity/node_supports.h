// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_node_supports_h
#define debond_elasticity_node_supports_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/lac/affine_constraints.h>

#include <debond/base/dof_vector.h>
#include <debond/elasticity/boundary_conditions.h>
#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/edge_coefficients.h>
#include <debond/elasticity/node_pairs.h>
#include <debond/elasticity/rigid_motions.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace Debond
{
  /// The degrees of freedom of a node's components.
  template <int dim>
  using NodeDofs = std::array<dealii::types::global_dof_index, dim>;



  /// The unknowns of a node: x = to_frame u, where u are the Cartesian
  /// components, and u = to_cartesian x.
  template <int dim>
  struct DisplacementFrame
  {
    NodeDofs<dim>          dofs;
    dealii::Tensor<2, dim> to_frame;
    dealii::Tensor<2, dim> to_cartesian;
  };



  /// Multiplies the components of each node that has a frame by the matrix of
  /// it that @p matrix_of gives.
  template <int dim, typename Vector, typename MatrixOf>
  void
  multiply_in_frames(const std::vector<DisplacementFrame<dim>> &frames,
                     const MatrixOf                            &matrix_of,
                     Vector                                    &v)
  {
    for (const DisplacementFrame<dim> &frame : frames)
      {
        std::array<std::decay_t<decltype(v(0))>, dim> before;
        for (unsigned int d = 0; d < dim; ++d)
          before[d] = std::exchange(v(frame.dofs[d]), 0.);
        const dealii::Tensor<2, dim> matrix = matrix_of(frame);
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int k = 0; k < dim; ++k)
            v(frame.dofs[d]) += matrix[d][k] * before[k];
      }
  }



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

    /// Prescribes zero in all other directions.
    void
    fix_rest();

    NodeDofs<dim>      dofs     = {};
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
    /// Of no nodes.
    NodeSupports() = default;

    /// @p n_prescribed: the number of degrees of freedom if displacements that
    /// are not zero may be prescribed, and else 0.
    NodeSupports(const unsigned int n_nodes, const unsigned int n_prescribed)
      : frame_of_node(n_nodes, dealii::numbers::invalid_unsigned_int)
      , prescribed(n_prescribed)
    {}

    /// Clamps the nodes of these faces.
    void
    clamp(const std::vector<BoundaryFace<dim>> &faces,
          const BoundaryConditions             &conditions);

    /// Notes what @p condition prescribes at the nodes of these faces, those of
    /// its boundaries; at @p edges the coefficients of its values. Throws
    /// SupportError if that contradicts another support or the foundation, is
    /// not finite, or if a roller is not flat.
    void
    prescribe(const std::vector<BoundaryFace<dim>> &faces,
              const PrescribedDisplacement<dim>    &condition,
              const BoundaryConditions             &conditions,
              const EdgeCoefficients<dim>          &edges);

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
                  const NodeDofs<dim>      &node_dofs,
                  const dealii::Point<dim> &position) const;

    /// Constrains the node, unless that or a frame of its own is done.
    void
    constrain(const unsigned int index, const PrescribedNode<dim> &node);

    /// Gives the node a frame: @p free_directions, what is prescribed along
    /// the rows of @p node, and directions across, where zero is prescribed if
    /// @p fixes_rest. Throws as contact_frame() does.
    void
    add_frame(const unsigned int                         index,
              const PrescribedNode<dim>                 &node,
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

    const std::vector<DisplacementFrame<dim>> &
    frames() const
    {
      return node_frames;
    }

    /// Null where the unknowns are Cartesian.
    const DisplacementFrame<dim> *
    frame(const unsigned int index) const;

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

    /// By node index, invalid_unsigned_int where the unknowns are Cartesian.
    std::vector<unsigned int>           frame_of_node;
    std::vector<DisplacementFrame<dim>> node_frames;
    dealii::AffineConstraints<double>   fixed;
    DofVector                           prescribed;
    std::vector<std::string>            support_names;
    std::vector<SupportedDof>           supported_dofs;

    // Until it is finished.
    std::map<unsigned int, PrescribedNode<dim>> prescribed_nodes; ///< by index
    std::vector<Support<dim>>                   held;
    std::set<unsigned int>                      ends_of_interfaces;
    std::map<unsigned int, std::array<unsigned int, 2>> glued_supports;
  };
} // namespace Debond

#endif
