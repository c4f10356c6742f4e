// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_tables_h
#define debond_output_tables_h

#include <debond/check/verification.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/majorise/majorise_minimise.h>

namespace Debond
{
  /**
   * Writes the paper's Figures 5 and 6 as CSV, one row per contact node: x, y[,
   * z], u_nu, normal_force, normal_force_density, normal_traction,
   * allowed_lower, allowed_upper, violation, state, tangential_force_x, ...
   * Throws std::runtime_error naming the file if it cannot be written.
   */
  template <int dim>
  void
  write_contact_profile(const ContactBoundary<dim> &boundary,
                        const Verification<dim>    &verification,
                        const std::string          &file_name);

  /// Writes the iteration history as CSV: iteration, functional, v, t_L, t_R,
  /// bundle_size, qp_steps, kind. @p found: J of the state that a search or a
  /// proof put in the place of the last iterate, for a last row with this
  /// number and the kind "search".
  void
  write_history(const std::vector<BundleIteration> &history,
                const std::optional<double>        &found,
                const std::string                  &file_name);

  /// Writes the history of majorise-minimise: iteration, functional, residual,
  /// active_set_steps, linear_iterations, contact_nodes. The row of @p found
  /// has the first two.
  void
  write_history(const std::vector<MajoriseMinimiseIteration> &history,
                const std::optional<double>                  &found,
                const std::string                            &file_name);

  /// Writes the history of a proof: nodes, open nodes, lower bound, J, seconds.
  void
  write_history(const std::vector<ProofProgress> &history,
                const std::string                &file_name);
} // namespace Debond

#endif
