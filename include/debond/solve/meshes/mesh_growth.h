// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_meshes_mesh_growth_h
#define debond_solve_meshes_mesh_growth_h

#include <debond/input/accuracy_parameters.h>

#include <optional>
#include <vector>

namespace Debond
{
  /// A mesh of a loop that refines, and the solution on it.
  struct AdaptiveLevel
  {
    unsigned int cells;
    unsigned int unknowns;
    unsigned int contact_nodes;
    unsigned int iterations;

    /// The step of a load path, from 1, whose estimate is the largest part of
    /// its J; 0 without a path. The next ones are of it.
    unsigned int step;
    double       functional; ///< J

    double residual_error; ///< what the residuals say, relative to the scale
    double scale;          ///< ErrorEstimate::scale

    double search_gain; ///< what a search lowered J by

    /// How many times the residual error that of J is; empty if there was no
    /// mesh to measure it.
    std::optional<double> error_factor;

    double gap;     ///< GoalOnMesh::width, 0 without a goal
    double seconds; ///< wall time of mesh, assembly and solve

    /// ErrorEstimate::relative().
    double
    estimated_error() const
    {
      return error_factor.value_or(1.) * residual_error;
    }
  };

  /// The growth of meshes that are refined: J and the estimates of its error on
  /// the meshes so far tell the error of the last one, and how many times its
  /// cells the next one has.
  class MeshGrowth
  {
  public:
    /// Sets the exponents for displacements of a @p degree in @p dim
    /// dimensions. Keeps a reference to @p accuracy.
    MeshGrowth(const AccuracyParameters &accuracy,
               const unsigned int        dim,
               const unsigned int        degree);

    /// A mesh has been estimated. Sets its error_factor, by the last mesh with
    /// sufficiently fewer unknowns and the same step; if there is none it is
    /// that of the mesh before.
    void
    add(AdaptiveLevel &level);

    /// Returns whether the error of the last mesh is at most the target,
    /// whatever the factor is if it has not been measured.
    bool
    meets_target() const;

    /// Returns the growth to the next mesh: equal steps to the mesh that meets
    /// the target, or to the largest one that is allowed, and enough to measure
    /// the factor.
    double
    next() const;

    /// Less is not worth a mesh.
    double
    least() const
    {
      return least_growth;
    }

  private:
    const AccuracyParameters &accuracy;
    const double              least_growth;
    const double              largest_growth;
    const double              least_ratio; ///< of unknowns, for the factor
    const double              smooth_rate;
    double                    rate; ///< error ~ unknowns^-rate

    std::vector<AdaptiveLevel> levels;
  };

  /// How often each cell is to be cut, for @p growth times the cells, by the
  /// @p parts that cells have of the estimate. The cell with the largest part
  /// is next until there are enough; where the solution is smooth, a half has
  /// 2^(-(2 + dim) / dim) of its part, and at corners more: with less for
  /// quadratic displacements those are cut too little where a mesh may grow but
  /// once.
  std::vector<unsigned int>
  divisions(const std::vector<double> &parts,
            const unsigned int         dim,
            const double               growth);
} // namespace Debond

#endif
