// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/check/plausibility.h>
#include <debond/mesh/owned_cells.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

    /// A body this slender bends.
    constexpr double slender_ratio = 5.;

    /// Cells larger than this part of the thickness, along or through it, make
    /// a strip too stiff in bending: as measured, J is 1 / (1 + 0.6 (size /
    /// thickness)^2) of the beam's, 96 % for a quarter.
    constexpr double largest_cell = 0.3;
    constexpr double locking      = 0.6;

    constexpr double largest_stretch = 5.;
  } // namespace



  std::vector<std::string>
  plausibility_notes(const BodyShape     &shape,
                     const unsigned int   dim,
                     const bool           has_load,
                     const LargestValues &largest,
                     const unsigned int   degree)
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

    // How long and how thin a body of another shape is, is not known; quadratic
    // displacements bend.
    if (!shape.is_box || degree > 1)
      return notes;

    const double thickness =
      *std::min_element(shape.lengths.begin(), shape.lengths.begin() + dim);
    double shortest = std::numeric_limits<double>::max();
    double longest  = 0.;
    double bending  = 0.; // of cells that bend
    bool   slender  = false;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double edge  = shape.lengths[d] / shape.cells[d];
        const bool   thin  = shape.lengths[d] <= thickness;
        const bool   along = shape.lengths[d] >= slender_ratio * thickness;
        shortest           = std::min(shortest, edge);
        longest            = std::max(longest, edge);
        slender |= along;
        if (thin || along)
          bending = std::max(bending, edge);
      }
    if (slender && bending > largest_cell * thickness)
      {
        const double size = bending / thickness;
        add("cells of ",
            size,
            " times the body's thickness: bent, a strip has about ",
            std::round(100. / (1. + locking * size * size)),
            " % of its J, with a quarter 96 %");
      }
    else if (longest > largest_stretch * shortest)
      add("cells are stretched by a factor of ",
          longest / shortest,
          ", which makes them stiff where they bend");
    return notes;
  }



  template decltype(largest_values<2>) largest_values<2>;
  template decltype(largest_values<3>) largest_values<3>;
} // namespace Debond
