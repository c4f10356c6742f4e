// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_load_path_parameters_h
#define debond_input_load_path_parameters_h

#include <debond/base/parameter_table.h>

#include <string>
#include <vector>

namespace Debond
{
  /// What is computed beside the states that a load path leads to.
  enum class GlobalBranch
  {
    none,
    search, ///< the best minimum that the search finds at each factor
    prove   ///< and its proof
  };



  struct LoadPathParameters
  {
    /// Multiples of the loads in their order; empty if there is no load path.
    std::vector<double> factors;

    GlobalBranch global_branch = GlobalBranch::search;
  };

  /// Reads numbers and ranges FIRST:STEP:LAST, separated by commas, such as
  /// "0:0.05:1.2, 1.2:-0.05:0". A factor that equals the one before it is left
  /// out. The values of a range are rounded to 12 decimal digits, so that
  /// loading and unloading meet the same factors. Throws std::invalid_argument
  /// that says what is wrong with which part of the list.
  std::vector<double>
  parse_load_factors(const std::string &text);

  /// The section Load path.
  void
  bind_load_path(LoadPathParameters &load_path, ParameterTable &table);
} // namespace Debond

#endif
