// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/largest_values.h>
#include <debond/elasticity/cell_nodes.h>

#include <algorithm>

namespace Debond
{
  template <int dim>
  LargestValues
  largest_values(const ElasticProblem<dim> &problem,
                 const DofVector           &u,
                 const LoadFactors          factors)
  {
    const DofVector displacement =
      problem.unknowns().cartesian_displacement(u, factors);
    const DofVector at_nodes = problem.unknowns().nodal_values(displacement);

    LargestValues largest;
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        const CellNodes<dim> nodes(cell);
        for (unsigned int n = 0; n < nodes.size; ++n)
          {
            dealii::Tensor<1, dim> at_node;
            for (unsigned int d = 0; d < dim; ++d)
              at_node[d] = at_nodes(nodes.dofs[n][d]);
            largest.displacement =
              std::max(largest.displacement, at_node.norm());
          }
        largest.gradient = std::max(
          largest.gradient,
          problem.fields().displacement_gradient(cell, displacement).norm());
        largest.von_mises = std::max(largest.von_mises,
                                     von_mises(problem.fields().solid_stress(
                                       cell, displacement, factors)));
      }
    return largest;
  }



  template decltype(largest_values<2>) largest_values<2>;
  template decltype(largest_values<3>) largest_values<3>;
} // namespace Debond
