// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/change_of_basis.h>

namespace Debond
{
  template <int dim>
  void
  ChangeOfBasis<dim>::set(const BasisStep                   step,
                          const std::vector<BasisRow<dim>> &rows,
                          const unsigned int                n_nodes)
  {
    // Only a few nodes have rows. A table from node to row makes find() a
    // lookup, for cells ask at each of their nodes; a step without rows needs
    // no table.
    Step &own = steps[static_cast<unsigned int>(step)];
    own.rows  = rows;
    own.row_of_node.assign(rows.empty() ? 0 : n_nodes,
                           dealii::numbers::invalid_unsigned_int);
    for (unsigned int k = 0; k < rows.size(); ++k)
      own.row_of_node[rows[k].node] = k;
  }



  template <int dim>
  void
  ChangeOfBasis<dim>::Step::add_others(Dofs &cell_dofs) const
  {
    if (rows.empty())
      return;
    // Only the unknowns that the cell has now are asked for. What they depend
    // on is appended once, as whole nodes, behind the nodes of the cell itself.
    const std::size_t n = cell_dofs.size();
    for (std::size_t i = 0; i < n; i += dim)
      if (const auto *row = find(static_cast<unsigned int>(cell_dofs[i] / dim)))
        for (const auto &[other, unused] : row->others)
          if (std::find(cell_dofs.begin(), cell_dofs.end(), dim * other) ==
              cell_dofs.end())
            for (unsigned int d = 0; d < dim; ++d)
              cell_dofs.push_back(dim * other + d);
  }



  template <int dim>
  void
  ChangeOfBasis<dim>::add_others(Dofs &cell_dofs) const
  {
    for (const Step &step : steps)
      step.add_others(cell_dofs);
  }



  template <int dim>
  void
  ChangeOfBasis<dim>::to_unknowns(Dofs                       &cell_dofs,
                                  dealii::FullMatrix<double> &matrix) const
  {
    // K becomes T_k' K T_k for one step k after the other, from nodal values
    // towards the unknowns, the order in which u = T_1 T_2 T_3 x asks for it.
    // At a node with a row, u = to_nodal x + sum of weight u(other), so that
    // the transposed step adds weight times the node's rows of K to those of
    // the others and multiplies its own by to_nodal'. The columns have the same
    // from the other side.
    for (const Step &step : steps)
      {
        step.add_others(cell_dofs);
        const auto n = static_cast<unsigned int>(cell_dofs.size());
        if (n > matrix.m())
          {
            // The unknowns of other cells have no entries in this cell's matrix
            // before the step fills them.
            const dealii::FullMatrix<double> of_cell = matrix;
            matrix.reinit(n, n);
            matrix.fill(of_cell);
          }
        for (unsigned int i = 0; i < n; i += dim)
          if (const auto *row =
                step.find(static_cast<unsigned int>(cell_dofs[i] / dim)))
            // Rows first and then columns: the second pass sees the rows that
            // the first one has changed, which makes the product from both
            // sides.
            for (const bool are_rows : {true, false})
              for (unsigned int j = 0; j < n; ++j)
                {
                  const auto entry = [&](const std::size_t k) -> double & {
                    return are_rows ? matrix(k, j) : matrix(j, k);
                  };
                  // A copy of the dim entries, since the node's own ones are
                  // overwritten while they are still needed.
                  dealii::Tensor<1, dim> nodal;
                  for (unsigned int d = 0; d < dim; ++d)
                    nodal[d] = entry(i + d);
                  const dealii::Tensor<1, dim> on_others =
                    nodal * row->of_others;
                  for (const auto &[other, weight] : row->others)
                    {
                      const auto k = std::find(cell_dofs.begin(),
                                               cell_dofs.end(),
                                               dim * other) -
                                     cell_dofs.begin();
                      for (unsigned int d = 0; d < dim; ++d)
                        entry(k + d) += weight * on_others[d];
                    }
                  // A vector times the matrix from the right is the transposed
                  // matrix times the vector, to_nodal' K.
                  nodal = nodal * row->to_nodal;
                  for (unsigned int d = 0; d < dim; ++d)
                    entry(i + d) = nodal[d];
                }
      }
  }



  template <int dim>
  DofVector
  ChangeOfBasis<dim>::sizes_of_terms(DofVector sizes) const
  {
    // At a first node u_first = +-[u] + u_second: the jump is a difference of
    // two displacements that may be much larger than it. Terms in the unknowns
    // are as large as |u_first| + 2 |u_second|, whatever cancels in their sum.
    // Frames change sizes by little.
    for (const BasisRow<dim> &row : rows(BasisStep::jumps))
      {
        auto terms = at(sizes, row.node);
        for (const auto &[other, weight] : row.others)
          terms += 2. * std::abs(weight) * at(sizes, other);
        set_at(sizes, row.node, terms);
      }
    return sizes;
  }



  template <int dim>
  DofVector
  ChangeOfBasis<dim>::rounding_of_forces(DofVector rounding) const
  {
    // The force on the displacement of a second node is that of both nodes
    // together, and so is its rounding.
    for (const BasisRow<dim> &row : rows(BasisStep::jumps))
      for (const auto &[other, weight] : row.others)
        set_at(rounding,
               other,
               at(rounding, other) + std::abs(weight) * at(rounding, row.node));
    return rounding;
  }



  DEBOND_INSTANTIATE_CLASS(ChangeOfBasis);
} // namespace Debond
