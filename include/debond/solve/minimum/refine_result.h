// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_refine_result_h
#define debond_solve_minimum_refine_result_h

#include <debond/solve/minimum/refinement.h>
#include <debond/solve/minimum/solution.h>

namespace Debond
{
  struct RefinedResult
  {
    bool is_needed          = false; ///< rounding has a say in the result
    bool is_on_other_pieces = false; ///< of Phi than before
  };

  /// Refines a result if rounding has a say in it. If rounding kept
  /// majorise-minimise from a result the refinement continues from where that
  /// ended, and what it finds is a success, with a note.
  template <int dim>
  RefinedResult
  refine_result(const Scene<dim>   &scene,
                CorrectionSolver   &solver,
                const Interruption &interruption,
                Solution           &result);
} // namespace Debond

#endif
