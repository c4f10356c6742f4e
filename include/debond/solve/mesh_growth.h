// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_mesh_growth_h
#define debond_solve_mesh_growth_h

#include <debond/input/accuracy_parameters.h>

#include <vector>

namespace Debond
{
  /// How many times the cells of each mesh the next one has, by how the
  /// estimate of the error falls from mesh to mesh.
  class MeshGrowth
  {
  public:
    /// Of displacements of a @p degree in @p dim dimensions. Keeps a reference
    /// to @p accuracy.
    MeshGrowth(const AccuracyParameters &accuracy,
               const unsigned int        dim,
               const unsigned int        degree);

    /// A mesh has been estimated.
    void
    add(const double n_unknowns, const double relative_error);

    /// That of the next mesh: equal steps to the mesh that meets the target,
    /// or to the largest one that is allowed.
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
    const double              smooth_rate;
    double                    rate; ///< error ~ unknowns^-rate
    double                    unknowns = 0.;
    double                    error    = 0.;
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
