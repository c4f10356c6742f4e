// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_which_minimum_h
#define debond_solve_minimum_which_minimum_h

#include <debond/input/solver_parameters.h>
#include <debond/solve/minimum/minimum_kind.h>

namespace Debond
{
  struct WhichMinimum
  {
    MinimumKind kind = MinimumKind::stationary;

    unsigned int search_trials       = 0;
    unsigned int search_improvements = 0;
    unsigned int search_failures     = 0; ///< trials without a result
    unsigned int search_nodes = 0; ///< contact nodes of the mesh of the search

    double operations = 0.;    ///< of the search (BoundQPResult::operations)
    bool   is_cut     = false; ///< the search, by its limit of operations

    bool interrupted = false; ///< search or proof, by a signal

    bool         proof_attempted = false;
    ProofStatus  proof_status    = ProofStatus::no_bound;
    double       lower_bound     = 0.; ///< of J
    double       relative_gap    = 0.; ///< J - lower bound, by energy_of_bonds
    double       energy_of_bonds = 0.; ///< what they can change in J
    unsigned int proof_nodes     = 0;

    /// J of the result as the condensed problem has it, if there is a proof.
    double functional = 0.;

    double rounding = 0.; ///< by which round_outwards() has moved the bounds

    /// With J in place of the condensed functional; of Solver/Prove only.
    std::vector<ProofProgress> proof_history;

    /// What Solver/Prove has proved, if it was to be kept.
    std::shared_ptr<const RecordedProof> recorded;

    /// Sentences about work that its limits have left undone.
    std::vector<std::string> notes;
  };



  /// The search and the proof that are asked for, from the stationary point
  /// @p s, which moves if they find a better one.
  template <int dim>
  WhichMinimum
  find_better_minimum(const SolverParameters      &parameters,
                      const AdhesionIntegral<dim> &adhesion,
                      const Condensation          &condensed,
                      const Interruption          &interruption,
                      Eigen::VectorXd             &s);

  /// Moves the bounds, which are those of the condensed problem in double
  /// precision, to where they hold for J as it is: @p functional for the
  /// result, with rounding_of_energy() @p energy_rounding. Where J is below the
  /// bound all the same there is no proof.
  void
  round_outwards(const double  functional,
                 const double  energy_rounding,
                 WhichMinimum &minimum);
} // namespace Debond

#endif
