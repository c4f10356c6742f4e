// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_branch_search_h
#define debond_optimization_global_branch_search_h

#include <debond/optimization/global/separable_branches.h>
#include <debond/optimization/majorise/active_set_guess.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <functional>
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
} // namespace Debond

#endif
