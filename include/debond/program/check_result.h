// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_check_result_h
#define debond_program_check_result_h

#include <debond/output/run_result.h>

namespace Debond
{
  /// Throws BadInput if the exact displacement, unless it is empty, is not
  /// finite somewhere on the mesh: before a solve, so that nothing is lost.
  template <int dim>
  void
  check_exact_displacement(const std::string &exact_displacement,
                           const Scene<dim>  &scene);

  /// Verifies what the solver found, estimates the error of the mesh and adds
  /// what else is to be said of the result. Success needs the stop criterion
  /// and the verification. Where rounding kept the method from its stop
  /// criterion, the verification decides; what the method left is said in
  /// either case. @p notes: on the scene. Ranks that share the scene call it
  /// together, and the first one has the result.
  template <int dim>
  void
  check_result(const VerificationParameters   &verification,
               const std::vector<std::string> &notes,
               RunResult<dim>                 &result);
} // namespace Debond

#endif
