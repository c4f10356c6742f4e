// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_support_parameters_h
#define debond_input_support_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/mesh/body.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace Debond
{
  /// What supports the body beside clamps. Expressions are with the constants
  /// of the loads.
  struct SupportParameters
  {
    std::set<std::string> rollers; ///< boundaries

    /// By the name of the boundary: for each component "free" or an
    /// expression.
    std::map<std::string, std::string> displacements;

    /// Between body and foundation; empty for none. By the name of the
    /// boundary those that are not that of all others.
    std::string                        gap;
    std::map<std::string, std::string> gaps;
  };

  /// Roller boundaries, prescribed displacements and the gap.
  void
  bind_supports(SupportParameters &supports, ParameterTable &table);

  /// What is wrong is left in the table as an error.
  void
  check_supports(const SupportParameters             &supports,
                 const BodyDescription               &body,
                 const unsigned int                   dimension,
                 const std::map<std::string, double> &constants,
                 ParameterTable                      &table);

  /// The expressions of a prescribed displacement with 0 for "free", and which
  /// components are not free.
  struct DisplacementText
  {
    std::string       expressions;
    std::vector<bool> is_prescribed;

    explicit DisplacementText(const std::string &text);
  };
} // namespace Debond

#endif
