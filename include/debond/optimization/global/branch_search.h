// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_branch_search_h
#define debond_optimization_global_branch_search_h

#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/moves.h>
#include <debond/optimization/majorise/coarse_start.h>

#include <optional>

namespace Debond
{
  /// A problem as a search needs to know it. Keeps references.
  struct SearchProblem : public PiecewiseProblem
  {
    /// Says on which piece a node is (lumped_energy()).
    const SeparableEnergy &lumped;

    const NeighbourGraph   &neighbours;
    const MajoriseMinimise &method;

    /// For starts, which are far from the point that they are made from.
    const ActiveSetGuess *guess = nullptr;

    /// The sum to which search and proof add what they have done
    /// (BoundQPResult::operations), if it is not null.
    WorkLimit *work = nullptr;
  };



  struct BranchSearchParameters
  {
    /// Start from rest and from all unknowns on each further piece as well.
    bool starts = true;

    /// Nodes by which the edge of a patch moves at first, and further if that
    /// pays. 0: no such moves, and none by stretch.
    unsigned int maximum_shift = 4;

    /// Take whole patches, and the middle of each, to the other side.
    bool flips = true;
  };



  struct BranchSearchResult
  {
    double functional = 0.; ///< of the best point

    /// True if all moves were tried from there.
    bool complete = true;

    /// States minimised, and those that lowered the functional.
    unsigned int trials = 0, improvements = 0;

    /// The number of states minimised that led to no minimum.
    unsigned int failures = 0;
  };



  /// Minimises from the problem's point. If the method does not end with
  /// success, it goes on with a larger tolerance.
  MajoriseMinimiseResult
  minimise_trial(const MajoriseMinimise          &method,
                 MajorantProblem                 &problem,
                 const MajoriseMinimise::Monitor &monitor = {});



  /**
   * Improves a minimum by starts from rest and from all nodes on each further
   * piece, and by the moves of moves_from() and moves_by_stretch(). Each new
   * state goes through majorise-minimise and is taken if the functional falls;
   * then the moves begin anew. @p s has to be within the bounds.
   *
   * Most trials slide into a minimum that another trial has ended in. Where
   * each unknown has a law of its own, the pieces at a point say what its
   * majorant is, so that a trial that comes to a state on the way of another
   * one ends where that did. Majorants of trials are minimised roughly, so the
   * way might have been another one: what is taken is a minimum all the same.
   */
  BranchSearchResult
  search_branches(const SearchProblem          &problem,
                  const BranchSearchParameters &parameters,
                  Eigen::VectorXd              &s);



  /// Each unknown has @p pieces with its @p lengths and @p weights[i]
  /// times their second derivative; with those of Phi this is Phi itself if
  /// each unknown has a multiple of them for its own.
  SeparableEnergy
  lumped_energy(const PiecewiseEnergy     &pieces,
                const Eigen::VectorXd     &weights,
                const std::vector<double> &lengths = {});



  struct GuidedSearchResult
  {
    BranchSearchResult search;

    /// A bound for the functional, if Phi is separable.
    std::optional<BranchAndBoundResult> proof;
  };



  /**
   * Improves a minimum with as much effort as it takes to prove it, up to a
   * limit: nothing if the bound at it does (NodeBound::bound_at) or, up to 100
   * unknowns, the first node of branch and bound; else a search that starts
   * from rest and from all bonds broken and moves edges by one node, and the
   * first node; then the full search, and branch and bound with a number of
   * nodes that depends on n only, 500 up to n = 92 and as n^-3 from there on;
   * both again, at most thrice, if that finds something. Tolerance and threads
   * of branch and bound are those of @p limits.
   *
   * If Phi is not separable, the proof is for the lumped one and says where
   * to look: the minimum that it finds is a start for the true Phi.
   */
  GuidedSearchResult
  guided_search(const SearchProblem            &problem,
                const bool                      is_separable,
                const BranchAndBoundParameters &limits,
                Eigen::VectorXd                &s);
} // namespace Debond

#endif
