// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_support_parameters_h
#define debond_input_support_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/input/expression.h>
#include <debond/mesh/body.h>

namespace Debond
{
  /// The supports of the body beside clamps. Expressions are with the constants
  /// of the loads.
  struct SupportParameters
  {
    std::set<std::string> rollers; ///< boundaries

    /// For each component "free" or an expression, by the name of the boundary.
    std::map<std::string, std::string> displacements;

    /// The gap between body and foundation, empty for none, and the gaps that
    /// are not that of all others, by the name of the boundary.
    std::string                        gap;
    std::map<std::string, std::string> gaps;

    /// Likewise, where the normal of the foundation is not that of the body.
    std::string                        normal;
    std::map<std::string, std::string> normals;
  };

  /// Binds roller boundaries, prescribed displacements and the gap.
  void
  bind_supports(SupportParameters &supports, ParameterTable &table);

  /// Leaves what is wrong in the table as an error.
  void
  check_supports(const SupportParameters &supports,
                 const BodyDescription   &body,
                 const unsigned int       dimension,
                 const Constants         &constants,
                 ParameterTable          &table);

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
