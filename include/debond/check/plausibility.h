// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_plausibility_h
#define debond_check_plausibility_h

#include <debond/check/largest_values.h>
#include <debond/mesh/body.h>

#include <string>
#include <vector>

namespace Debond
{
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
