// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_plausibility_h
#define debond_check_plausibility_h

#include <debond/base/dof_vector.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/mesh/body.h>

#include <string>
#include <vector>

namespace Debond
{
  /// What tells whether a result can be that of linear elasticity.
  struct LargestValues
  {
    double displacement = 0.; ///< |u| at a vertex, length
    double gradient     = 0.; ///< |grad u| of a cell (Frobenius' norm)
    double von_mises    = 0.; ///< of a cell, force per area
  };

  /// Of the displacement @p u. The largest stress of a body with clamped
  /// corners grows with refinement.
  template <int dim>
  LargestValues
  largest_values(const ElasticProblem<dim> &problem,
                 const DofVector           &u,
                 const LoadFactors          factors = 1.);



  /// What a user should know of a result that is right as the solution of the
  /// discrete problem: that there is no load, or that displacements are too
  /// large for linear elasticity.
  std::vector<std::string>
  plausibility_notes(const bool has_load, const LargestValues &largest);
} // namespace Debond

#endif
