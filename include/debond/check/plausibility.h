// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_plausibility_h
#define debond_check_plausibility_h

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/dof_vector.h>
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
  /// discrete problem: that there is no load, that displacements are too large
  /// for linear elasticity, or that the mesh is too coarse or too stretched for
  /// a slender body, which P1 elements then make too stiff. @p degree: of the
  /// displacements.
  std::vector<std::string>
  plausibility_notes(const BodyShape     &shape,
                     const unsigned int   dim,
                     const bool           has_load,
                     const LargestValues &largest,
                     const unsigned int   degree = 1);
} // namespace Debond

#endif
