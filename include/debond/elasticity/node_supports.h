// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_node_supports_h
#define debond_elasticity_node_supports_h

#include <debond/elasticity/node_pairs.h>

namespace Debond
{
  /// A node where displacements are prescribed along orthonormal directions.
  template <int dim>
  struct PrescribedNode
  {
    struct Row
    {
      dealii::Tensor<1, dim> direction;
      double                 value;
      unsigned int           support; ///< of NodeSupports::names()
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

    unsigned int       node       = 0; ///< its number
    dealii::Point<dim> position   = {};
    std::vector<Row>   rows       = {};
    bool               is_clamped = false;
  };



  /// The displacements that supports prescribe at the nodes of a mesh: clamps
  /// are to come first, then other displacements.
  template <int dim>
  class NodeSupports
  {
  public:
    /// Clamps the nodes of these faces.
    void
    clamp(const std::vector<BoundaryFace<dim>> &faces,
          const BoundaryConditions             &conditions);

    /// Adds what @p condition prescribes at the nodes of these faces, those of
    /// its boundaries; at edges that have coefficients in the @p basis those of
    /// its values. Throws SupportError if that contradicts another support or
    /// the foundation, is not finite, or if a roller is not flat.
    void
    prescribe(const std::vector<BoundaryFace<dim>> &faces,
              const PrescribedDisplacement<dim>    &condition,
              const BoundaryConditions             &conditions,
              const ChangeOfBasis<dim>             &basis);

    /// Holds the nodes on the axis of a body of revolution of this @p diameter
    /// along x. Throws EntryError if a node is beyond the axis, SupportError if
    /// another displacement is prescribed on it.
    void
    hold_axis(const std::vector<dealii::Point<dim>> &positions,
              const double                           diameter);

    /// The nodes that hold_axis() has found on the axis.
    const std::set<unsigned int> &
    on_axis() const
    {
      return axis_nodes;
    }

    /// Makes displacements that are prescribed at the first nodes of @p pairs
    /// those of jumps, after exchanging both where only the first one is
    /// supported. Throws std::invalid_argument if both nodes of a pair are
    /// supported, and neither as far as the other one.
    void
    glue(NodePairs<dim> &pairs);

    /// The nodes with supports by their numbers.
    const std::map<unsigned int, PrescribedNode<dim>> &
    all() const
    {
      return nodes;
    }

    /// Returns the supports of a node, which may prescribe nothing.
    PrescribedNode<dim>
    at(const unsigned int node, const dealii::Point<dim> &position) const
    {
      const auto entry = nodes.find(node);
      return entry == nodes.end() ? PrescribedNode<dim>{node, position} :
                                    entry->second;
    }

    /// The supports of the bodies on the high and on the low side of a first
    /// node of a pair that is supported; null of other nodes.
    const std::array<unsigned int, 2> *
    supports_of_pair(const unsigned int first) const
    {
      const auto entry = glued.find(first);
      return entry == glued.end() ? nullptr : &entry->second;
    }

    /// Returns whether the node is one of NodePairs::ends().
    bool
    is_end_of_interface(const unsigned int node) const
    {
      return ends_of_interfaces.count(node) > 0;
    }

    /// The name of a support of a row, which may be none of names().
    std::string
    name(const unsigned int support) const
    {
      return support < support_names.size() ? support_names[support] : "axis";
    }

    /// The pieces of the boundary that support the body.
    const std::vector<std::string> &
    names() const
    {
      return support_names;
    }

  private:
    using Row = typename PrescribedNode<dim>::Row;

    std::map<unsigned int, PrescribedNode<dim>>         nodes;
    std::vector<std::string>                            support_names;
    std::set<unsigned int>                              axis_nodes;
    std::set<unsigned int>                              ends_of_interfaces;
    std::map<unsigned int, std::array<unsigned int, 2>> glued;
  };
} // namespace Debond

#endif
