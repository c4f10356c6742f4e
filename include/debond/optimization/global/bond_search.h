// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_global_bond_search_h
#define debond_optimization_global_bond_search_h

#include <deal.II/lac/full_matrix.h>

#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <array>
#include <functional>
#include <set>
#include <vector>

namespace Debond
{
  /// Which unknowns are neighbours on the contact boundary.
  using NeighbourGraph = std::vector<std::set<unsigned int>>;



  struct BondSearchParameters
  {
    /// Start from rest and from all bonds broken as well.
    bool starts = true;

    /// Nodes by which the edge of a broken patch moves, 0 for no such moves.
    unsigned int maximum_shift = 4;

    /// Break or close whole patches.
    bool flips = true;

    /// Break or close the middle of a patch.
    bool splits = true;

    /// States that are minimised, at most.
    unsigned int maximum_trials = 100000;
  };



  enum class BondMove
  {
    start,
    shift,
    flip,
    split
  };

  struct BondSearchResult
  {
    double functional = 0.; ///< of the best point

    /// Whether all moves were tried from there.
    bool complete = true;

    /// States minimised, and those that lowered the functional, by BondMove.
    std::array<unsigned int, 4> trials = {}, improvements = {};

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
   * Improves a minimum of 1/2 s'S s - g's + Phi(s), s <= 0, by moves on the
   * broken patches, the connected parts of the nodes with s < -M: starts from
   * rest and from all bonds broken; the edge of a patch (an end of an interval
   * in 2D, all around in 3D) moved in or out by some nodes; a patch of broken
   * or of bonded nodes changed as a whole, which merges its neighbours, or in
   * its middle, which splits it. Each new state goes through majorise-minimise
   * and is taken if the functional falls; then the moves begin anew.
   *
   * @p threshold is M, @p s has to be <= 0. The monitor returns false to end.
   */
  BondSearchResult
  search_bonds(const dealii::FullMatrix<double> &S,
               const dealii::Vector<double>     &g,
               const PiecewiseQuadratic         &phi,
               const double                      threshold,
               const NeighbourGraph             &neighbours,
               const MajoriseMinimise           &method,
               const BondSearchParameters       &parameters,
               dealii::Vector<double>           &s,
               const std::function<bool()>      &monitor = {});
} // namespace Debond

#endif
