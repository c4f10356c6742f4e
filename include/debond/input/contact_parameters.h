// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_contact_parameters_h
#define debond_input_contact_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/input/problem_parameters.h>

namespace Debond
{
  /// The words for what holds the body along the contact boundary.
  const std::vector<std::pair<std::string, TangentialDisplacement>> &
  tangential_words();

  /// The one of a word of theirs.
  TangentialDisplacement
  tangential_named(const std::string &word);

  /// Binds the names of the clamped and the contact boundary.
  void
  bind_boundaries(ProblemParameters &p, ParameterTable &table);

  /// Binds what the section Contact law has besides the law itself.
  void
  bind_contact(ProblemParameters &p, ParameterTable &table);
} // namespace Debond

#endif
