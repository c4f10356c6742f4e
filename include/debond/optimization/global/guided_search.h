// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_guided_search_h
#define debond_optimization_global_guided_search_h

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/global/separable_branches.h>

#include <optional>

namespace Debond
{
  /// Phi lumped at its @p n unknowns: each has the multiple of @p branches with
  /// the row sum of the second derivative at 0. This is Phi itself if each
  /// unknown has a multiple of them for its own.
  SeparableBranches
  lumped_branches(const PiecewiseQuadratic  &phi,
                  const unsigned int         n,
                  const BranchMinimum       &branches,
                  const std::vector<double> &stretches = {});

  struct GuidedSearchParameters
  {
    double tolerance = 0.; ///< of the gap, an energy

    unsigned int n_threads = 1;

    /// Not only the certificate but the first node of branch and bound is
    /// tried before the search, whether Phi is separable or not.
    bool proof_first = false;
  };



  struct GuidedSearchResult
  {
    BranchSearchResult search;

    /// A bound for the functional, if Phi is separable.
    std::optional<BranchAndBoundResult> proof;

    /// Whether the minimum of the lumped problem is known, and lies in a state
    /// that was tried.
    bool is_closed = false;
  };



  /**
   * Improves a minimum with as much effort as it takes to prove it, up to a
   * limit: nothing if its certificate does
   * (NodeBound::certificate) or, with proof_first, the first node of branch
   * and bound, or up to 100 unknowns a few relaxations of that node
   * (BranchAndBoundParameters::only_while_halving), else a search that starts
   * from rest and from all bonds broken and moves edges by one node; if the
   * certificate of what that finds is not enough, the first node of branch and
   * bound; then the full search, and branch and bound with a number of nodes
   * that depends on n only, 500 up to n = 92 and as n^-3 from there on; both
   * again, at most thrice, if that finds something. @p may_end is asked after
   * the first search, with whether that found anything; if true the search
   * ends.
   *
   * If Phi is not separable, the proof is for the lumped one and says where
   * to look: the minimum that it finds is a start for the true Phi.
   */
  GuidedSearchResult
  guided_search(const SearchProblem             &problem,
                const bool                       is_separable,
                const GuidedSearchParameters    &parameters,
                Eigen::VectorXd                 &s,
                const std::function<bool(bool)> &may_end = {});
} // namespace Debond

#endif
