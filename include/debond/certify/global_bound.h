// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_global_bound_h
#define debond_certify_global_bound_h

#include <debond/base/infinity.h>
#include <debond/certify/mean_problem.h>
#include <debond/optimization/global/branch_and_bound.h>

namespace Debond
{
  /// A problem of theorem 2 and what was proved of it.
  struct BoundStage
  {
    std::shared_ptr<const MeanProblem> problem;

    ProofRecord              bound;
    std::vector<ProofRecord> ranges;
  };



  struct GlobalBound
  {
    double lower = -infinity;

    /// The part of it that is a reserve for what elimination may have lost to
    /// rounding.
    double rounding = 0.;

    /// The end of the branch and bound that has it.
    ProofStatus  status = ProofStatus::no_bound;
    unsigned int nodes  = 0; ///< of all

    std::vector<CertifiedSide> sides;

    /// The losses of the sides where the best bound is the least; empty if
    /// there is none.
    std::vector<double> losses;

    /// If BranchAndBoundParameters::keeps_record.
    std::vector<BoundStage> stages = {};
  };



  /// Returns trace_constant() of the triangles above the contact sides.
  std::vector<double>
  side_constants(const EquilibriumProblem<2> &equilibrium,
                 const ByRegion<Material>    &materials,
                 const BoundaryConditions    &conditions);

  /**
   * A lower bound of the least J of the continuous problem, and where its
   * minimisers are (theorems 1 and 2 of doc/reference/certificate.md).
   *
   * @p means: of u_nu on the contact sides, of a good displacement; @p upper: a
   * value of J that is reached. Throws EquilibriumError if there is no bound.
   */
  GlobalBound
  bound_global(const MeanProblems             &problems,
               const Eigen::VectorXd          &means,
               const double                    upper,
               const BranchAndBoundParameters &proof,
               const Interruption             &interruption);
} // namespace Debond

#endif
