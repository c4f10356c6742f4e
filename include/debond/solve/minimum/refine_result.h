// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_refine_result_h
#define debond_solve_minimum_refine_result_h

#include <debond/solve/minimum/refinement.h>
#include <debond/solve/minimum/solve_result.h>

namespace Debond
{
  /// Refines a result if rounding has a say in it. Returns whether it has.
  /// Where rounding kept majorise-minimise from a result the refinement goes on
  /// from where that ended, and what it finds is a success, with a note.
  template <int dim>
  bool
  refine_result(const Scene<dim>   &scene,
                CorrectionSolver   &solver,
                const Interruption &interruption,
                SolveResult        &result);
} // namespace Debond

#endif
