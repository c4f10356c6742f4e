// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/owned_cells.h>
#include <debond/base/text.h>
#include <debond/check/plausibility.h>

#include <algorithm>
#include <cmath>

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
    for (const auto &cell : owned_cells(problem.unknowns().dof_handler()))
      {
        means.reinit(cell);
        largest.gradient = std::max(largest.gradient, means.gradient(0).norm());
        largest.von_mises =
          std::max(largest.von_mises, von_mises(means.solid_stress(0)));
      }
    const MPI_Comm ranks = problem.unknowns().communicator();
    largest.gradient     = dealii::Utilities::MPI::max(largest.gradient, ranks);
    largest.von_mises = dealii::Utilities::MPI::max(largest.von_mises, ranks);
    return largest;
  }



  namespace
  {
    /// Beyond it the strains of linear elasticity are wrong by some percent.
    constexpr double largest_small_gradient = 0.05;
  } // namespace



  std::vector<std::string>
  plausibility_notes(const bool has_load, const LargestValues &largest)
  {
    std::vector<std::string> notes;
    const auto               add = [&notes](const auto &...parts) {
      notes.push_back(words(std::setprecision(2), parts...));
    };

    if (!has_load)
      add("the scene has no load");
    if (largest.gradient > largest_small_gradient)
      add("displacement gradients up to ",
          largest.gradient,
          " are beyond linear elasticity, which is for small strains and "
          "rotations, below about ",
          largest_small_gradient);
    return notes;
  }



  template decltype(largest_values<2>) largest_values<2>;
  template decltype(largest_values<3>) largest_values<3>;
} // namespace Debond
