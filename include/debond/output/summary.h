// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_summary_h
#define debond_output_summary_h

#include <debond/check/displacement_error.h>
#include <debond/check/largest_values.h>
#include <debond/solve/load_path_steps.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Debond
{
  /// What a run reports, for the log and for summary.json.
  struct Summary
  {
    std::string scene;         ///< path of the .prm as given
    std::string method;        ///< Solver/Method
    std::string linear_solver; ///< direct, multigrid or none
    std::string status;        ///< to_string(SolverStatus)
    std::string message;

    /// What did not go as it should, and did not decide on the status.
    std::vector<std::string> notes;

    unsigned int dimension  = 2;
    double       functional = 0.;

    /// J of the state to which the method led from its start, which is rest
    /// unless the scene says otherwise, if there was a search or a proof: they
    /// may have found a lower one.
    std::optional<double> functional_from_start;
    bool                  is_replaced = false; ///< by a lower state

    /// stationary, local minimum, best known or global; empty if there is no
    /// verified result.
    std::string  minimum;
    unsigned int search_trials       = 0;
    unsigned int search_improvements = 0;
    unsigned int search_failures     = 0; ///< trials without a result
    unsigned int search_nodes = 0; ///< contact nodes on which it searched
    unsigned int closed_nodes = 0; ///< coarser ones with a proof
    std::string  proof; ///< to_string(ProofStatus), empty if none was tried
    unsigned int proof_nodes  = 0;
    double       lower_bound  = 0.; ///< of J, by the proof
    double       relative_gap = 0.; ///< to what the bonds can change in J

    unsigned int total_iterations = 0;
    unsigned int long_steps       = 0;
    unsigned int short_steps      = 0;
    unsigned int null_steps       = 0;
    double       stop_criterion   = 0.; ///< last v_k, or the relative residual
    double       largest_qp_residual      = 0.;
    unsigned int linear_iterations        = 0;  ///< of conjugate gradients
    double       memory_estimate          = 0.; ///< bytes, before the solve
    double       peak_memory              = 0.; ///< bytes, of the whole program
    unsigned int cells                    = 0;
    unsigned int degrees_of_freedom       = 0; ///< free ones
    unsigned int degrees_of_freedom_paper = 0;
    unsigned int contact_nodes            = 0;
    double       law_violation            = 0.;
    double       penetration              = 0.;
    double       equilibrium_residual     = 0.;
    double       force_imbalance          = 0.;

    LargestValues largest;

    /// Of the elastic problem on the contact normals, if there was one.
    std::optional<double> condition_estimate;

    /// If the exact displacement is known.
    std::optional<DisplacementError> displacement_error;

    /// Resultants on the body, Cartesian components.
    std::vector<double> applied_force;
    std::vector<double> clamped_reaction;
    std::vector<double> contact_reaction;
    std::vector<double> tangential_reaction; ///< part of contact_reaction

    /// Number of contact nodes in each state that there is with the law.
    std::map<std::string, unsigned int> bond_states;

    /// If the scene has a load path; all the rest is of its last step.
    std::optional<LoadPathTotals> load_path;

    /// Wall seconds: mesh, assembly, solve, output, total, and the parts of
    /// solve under "solve/...".
    std::map<std::string, double> timings_s;

    std::string revision;
    std::string deal_ii_version;
    std::string build_type;
  };

  /// Writes summary.json. Numbers that are not finite become null. Throws
  /// std::runtime_error naming the file if it cannot be written.
  void
  write_summary(const Summary &summary, const std::string &file_name);
} // namespace Debond

#endif
