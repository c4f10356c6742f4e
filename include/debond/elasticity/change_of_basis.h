// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_change_of_basis_h
#define debond_elasticity_change_of_basis_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>
#include <deal.II/lac/full_matrix.h>

#include <debond/base/dof_vector.h>

#include <array>
#include <type_traits>
#include <utility>

namespace Debond
{
  /// The steps of a ChangeOfBasis in their order, from values at nodes to
  /// unknowns.
  enum class BasisStep : unsigned int
  {
    coefficients, ///< of edges, in place of values in their middles
    jumps,        ///< of glued bodies, in place of the displacement of one
    frames        ///< components along directions of the node's own
  };



  /// A node at which a step changes what there is to u = to_nodal x + of_others
  /// (sum of weight u(other)). The step leaves the others as they are.
  template <int dim>
  struct BasisRow
  {
    unsigned int                                 node;
    dealii::Tensor<2, dim>                       to_nodal, to_unknowns;
    std::vector<std::pair<unsigned int, double>> others = {};
    dealii::Tensor<2, dim> of_others = dealii::unit_symmetric_tensor<dim>();

    /// The row of u = scale x + sum of weight u(other).
    static BasisRow
    scaled(const unsigned int                                  node,
           const double                                        scale,
           const std::vector<std::pair<unsigned int, double>> &others)
    {
      const dealii::Tensor<2, dim> identity =
        dealii::unit_symmetric_tensor<dim>();
      return {node, scale * identity, identity / scale, others};
    }
  };



  /**
   * The change from the unknowns x to the displacement u at the nodes, in
   * Cartesian components: u = T x, T being the product of T_k over the steps k,
   * each of which is the identity but for the rows of a few nodes. Whatever is
   * known at nodes (displacements, forces, matrices of cells) comes to the
   * unknowns here and nowhere else, so that one more kind of unknowns is one
   * more step.
   *
   * Vectors have dim entries for each node, those of node n from dim n on, and
   * numbers of any precision.
   */
  template <int dim>
  class ChangeOfBasis
  {
  public:
    using Dofs = std::vector<dealii::types::global_dof_index>;

    /// Makes these the rows of a step. @p n_nodes: of the mesh.
    void
    set(const BasisStep                   step,
        const std::vector<BasisRow<dim>> &rows,
        const unsigned int                n_nodes);

    const std::vector<BasisRow<dim>> &
    rows(const BasisStep step) const
    {
      return steps[static_cast<unsigned int>(step)].rows;
    }

    /// The row of the node in a step; null if the step leaves it as it is.
    const BasisRow<dim> *
    find(const BasisStep step, const unsigned int node) const
    {
      return steps[static_cast<unsigned int>(step)].find(node);
    }

    /// u = T x; of the steps before @p first nothing is undone.
    template <typename Vector>
    Vector
    to_nodal(Vector x, const BasisStep first = BasisStep::coefficients) const
    {
      for_each_row_back(first, [&x](const BasisRow<dim> &row) {
        set_at(x, row.node, row.to_nodal * at(x, row.node) + others(x, row));
      });
      return x;
    }

    /// x = T^{-1} u.
    template <typename Vector>
    Vector
    to_unknowns(Vector u) const
    {
      for_each_row([&u](const BasisRow<dim> &row) {
        set_at(u,
               row.node,
               row.to_unknowns * (at(u, row.node) - others(u, row)));
      });
      return u;
    }

    /// T' f, the forces on the unknowns.
    template <typename Vector>
    Vector
    forces_to_unknowns(Vector f) const
    {
      for_each_row([&f](const BasisRow<dim> &row) {
        const auto force = at(f, row.node), on_others = force * row.of_others;
        for (const auto &[other, weight] : row.others)
          set_at(f, other, at(f, other) + weight * on_others);
        set_at(f, row.node, force * row.to_nodal);
      });
      return f;
    }

    /// T'^{-1} f, the forces at nodes; of the steps before @p first nothing is
    /// undone.
    template <typename Vector>
    Vector
    forces_to_nodal(Vector          f,
                    const BasisStep first = BasisStep::coefficients) const
    {
      for_each_row_back(first, [&f](const BasisRow<dim> &row) {
        const auto force     = at(f, row.node) * row.to_unknowns;
        const auto on_others = force * row.of_others;
        set_at(f, row.node, force);
        for (const auto &[other, weight] : row.others)
          set_at(f, other, at(f, other) - weight * on_others);
      });
      return f;
    }

    /// Appends to the degrees of freedom of a cell those of other cells' nodes
    /// that the values at its nodes depend on.
    void
    add_others(Dofs &cell_dofs) const;

    /// Takes the matrix of a cell for the values at its nodes to that for the
    /// unknowns, T' K T. Both become larger as add_others() says.
    void
    to_unknowns(Dofs &cell_dofs, dealii::FullMatrix<double> &matrix) const;

    /// The sizes of the unknowns that sum up to values of these sizes where one
    /// can be much larger than their sum: at glued nodes.
    DofVector
    sizes_of_terms(DofVector sizes) const;

    /// How inexact the forces on the unknowns are if those at nodes are that
    /// inexact, again at glued nodes alone: others have about the same.
    DofVector
    rounding_of_forces(DofVector rounding) const;

  private:
    struct Step
    {
      std::vector<BasisRow<dim>> rows;
      std::vector<unsigned int>  row_of_node; ///< empty without rows

      const BasisRow<dim> *
      find(const unsigned int node) const
      {
        return rows.empty() ||
                   row_of_node[node] == dealii::numbers::invalid_unsigned_int ?
                 nullptr :
                 &rows[row_of_node[node]];
      }

      void
      add_others(Dofs &cell_dofs) const;
    };

    template <typename Vector>
    static auto
    at(const Vector &v, const unsigned int node)
    {
      dealii::Tensor<1, dim, std::decay_t<decltype(v(0))>> result;
      for (unsigned int d = 0; d < dim; ++d)
        result[d] = v(dim * node + d);
      return result;
    }

    template <typename Vector, typename Value>
    static void
    set_at(Vector &v, const unsigned int node, const Value &value)
    {
      for (unsigned int d = 0; d < dim; ++d)
        v(dim * node + d) = value[d];
    }

    /// What the others add.
    template <typename Vector>
    static auto
    others(const Vector &v, const BasisRow<dim> &row)
    {
      decltype(at(v, 0)) sum;
      for (const auto &[other, weight] : row.others)
        sum += weight * at(v, other);
      return row.of_others * sum;
    }

    template <typename Action>
    void
    for_each_row(const Action &action) const
    {
      for (const Step &step : steps)
        for (const BasisRow<dim> &row : step.rows)
          action(row);
    }

    template <typename Action>
    void
    for_each_row_back(const BasisStep first, const Action &action) const
    {
      for (auto k = steps.size(); k-- > static_cast<unsigned int>(first);)
        for (const BasisRow<dim> &row : steps[k].rows)
          action(row);
    }

    std::array<Step, 3> steps;
  };
} // namespace Debond

#endif
