// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_load_path_parameters_h
#define debond_input_load_path_parameters_h

#include <debond/elasticity/load_factors.h>
#include <debond/input/load_parameters.h>
#include <debond/input/support_parameters.h>

namespace Debond
{
  /// The minima that are computed beside the states that a load path leads to.
  enum class GlobalBranch
  {
    none,
    automatic, ///< what a search finds with as much work as the path takes
    search,    ///< the best minimum that the search finds at each factor
    prove      ///< and its proof
  };



  struct LoadPathParameters
  {
    /// Multiples of the loads in their order; empty if there is no load path.
    std::vector<double> factors;

    /// The multiples of prescribed displacements, one for each factor; empty if
    /// they are the same.
    std::vector<double> displacement_factors;

    /// Loads without a factor: names of boundaries with loads, "body force".
    std::set<std::string> dead_loads;
    bool                  asks_for_branch = false; ///< the scene itself does

    /// Says whether bonds return to branches that they have left. Otherwise
    /// states depend on those before, those of the global branch on its own.
    bool bonds_heal = true;

    /// Returns the factors of a step, from 0.
    LoadFactors
    at(const unsigned int step) const
    {
      return {factors[step],
              displacement_factors.empty() ? factors[step] :
                                             displacement_factors[step]};
    }

    /// Says whether only prescribed displacements change on the path.
    bool
    moves_only() const;

    /// Returns the factor of the loads, unless they stay as they are.
    double
    varying(const LoadFactors &at_step) const
    {
      return moves_only() ? at_step.displacements : at_step.loads;
    }

    /// "factor 0.5", "displacement factor 0.5", or both.
    std::string
    name(const LoadFactors &factors) const;

    /// The part of the largest force to which that is sought inside of steps of
    /// prescribed displacements; 0 for the steps alone.
    double resolve = 0.01;

    GlobalBranch global_branch = GlobalBranch::automatic;

    /// Asks for the unstable states between those that the path leads to.
    bool arc = false;
  };

  /// Reads numbers, ranges FIRST:STEP:LAST and repetitions NUMBER x COUNT,
  /// separated by commas, such as "0:0.05:1.2, 1.2 x 3, 1.2:-0.05:0". The
  /// values of a range are rounded to 12 decimal digits, so that loading and
  /// unloading meet the same factors. Throws std::invalid_argument that says
  /// what is wrong with which part of the list.
  std::vector<double>
  parse_load_factors(const std::string &text);

  /// Binds the section Load path.
  void
  bind_load_path(LoadPathParameters &load_path, ParameterTable &table);

  /// Makes the two lists of factors equally long. What does not fit together,
  /// or the scene, is left in the table as an error.
  void
  complete_load_path(const LoadParameters    &loads,
                     const SupportParameters &supports,
                     LoadPathParameters      &load_path,
                     ParameterTable          &table);
} // namespace Debond

#endif
