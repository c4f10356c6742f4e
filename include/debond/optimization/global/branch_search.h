// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_branch_search_h
#define debond_optimization_global_branch_search_h

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/separable_branches.h>
#include <debond/optimization/majorise/coarse_start.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <functional>
#include <optional>
#include <set>
#include <vector>

namespace Debond
{
  /// Which unknowns are neighbours on the contact boundary.
  using NeighbourGraph = std::vector<std::set<unsigned int>>;



  /// 1/2 s'S s - g's + Phi(s), s <= 0, and what a search needs to know of it.
  /// Keeps references.
  struct SearchProblem
  {
    MatrixView                S;
    VectorView                g;
    const PiecewiseQuadratic &phi;

    /// Says on which branch a node is (lumped_branches()); all its terms have
    /// to have the same number of pieces.
    const SeparableBranches &lumped;

    const NeighbourGraph   &neighbours;
    const MajoriseMinimise &method;

    /// Returns false to end.
    std::function<bool()> may_go_on = []() { return true; };

    /// For states that are far from the point that they are made from.
    const ActiveSetGuess *guess = nullptr;
  };



  struct BranchSearchParameters
  {
    /// Start from rest and from all unknowns on each further branch as well.
    bool starts = true;

    /// Nodes by which the edge of a patch moves, 0 for no such moves.
    unsigned int maximum_shift = 4;

    /// Take whole patches, and the middle of each, to the other side.
    bool flips = true;
  };



  struct BranchSearchResult
  {
    double functional = 0.; ///< of the best point

    /// Whether all moves were tried from there.
    bool complete = true;

    /// States minimised, and those that lowered the functional.
    unsigned int trials = 0, improvements = 0;

    /// Of the states minimised, those that led to no minimum.
    unsigned int failures = 0;
  };



  /// Minimises from the problem's point. If the method does not end with
  /// success, it goes on with a larger tolerance.
  MajoriseMinimiseResult
  minimise_trial(const MajoriseMinimise          &method,
                 MajorantProblem                 &problem,
                 const MajoriseMinimise::Monitor &monitor = {});



  /**
   * Improves a minimum by moves on patches. For each kink of the branches of
   * `lumped`, these are the connected parts of the nodes below it (with the
   * paper's law: the broken ones) and of those above: starts from rest and from
   * all nodes on each further branch; the edge of a patch (an end of an
   * interval in 2D, all around in 3D) moved in or out by some nodes; a patch
   * taken to the other side of the kink as a whole, which merges its
   * neighbours, or in its middle, which splits it. Each new state goes through
   * majorise-minimise and is taken if the functional falls; then the moves
   * begin anew.
   *
   * @p s has to be <= 0. What comes to the majorant of a minimum that is known
   * is not followed further: it ends there.
   */
  BranchSearchResult
  search_branches(const SearchProblem          &problem,
                  const BranchSearchParameters &parameters,
                  Eigen::VectorXd              &s);



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

    /// Not only the bound at the minimum but the first node of branch and bound
    /// is tried before the search, whether Phi is separable or not.
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
   * limit: nothing if the bound at it does
   * (NodeBound::bound_at) or, with proof_first, the first node of branch
   * and bound, or up to 100 unknowns a few relaxations of that node
   * (BranchAndBoundParameters::only_while_halving), else a search that starts
   * from rest and from all bonds broken and moves edges by one node; if the
   * bound at what that finds is not enough, the first node of branch and
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
