// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/largest_values.h>

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
    LargestValues largest;
    for (unsigned int i = 0; i < displacement.size(); i += dim)
      {
        dealii::Tensor<1, dim> at_node;
        for (unsigned int d = 0; d < dim; ++d)
          at_node[d] = displacement(i + d);
        largest.displacement = std::max(largest.displacement, at_node.norm());
      }
    CellStresses<dim> means(problem.fields(), displacement, factors);
    for (const auto &cell :
         problem.unknowns().dof_handler().active_cell_iterators())
      {
        means.reinit(cell);
        largest.gradient = std::max(largest.gradient, means.gradient(0).norm());
        largest.von_mises =
          std::max(largest.von_mises, von_mises(means.solid_stress(0)));
      }
    return largest;
  }



  template decltype(largest_values<2>) largest_values<2>;
  template decltype(largest_values<3>) largest_values<3>;
} // namespace Debond
