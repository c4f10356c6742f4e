// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_idle_entries_h
#define debond_input_idle_entries_h

#include <debond/input/mesh_parameters.h>
#include <debond/input/parameters.h>

namespace Debond
{
  /// The @p constants that no entry of the table uses: a misspelt one has no
  /// effect, however a study varies it.
  std::set<std::string>
  idle_constants(const std::map<std::string, double> &constants,
                 const ParameterTable                &table);

  /// Notes entries that the run does not look at, and defaults that are hardly
  /// meant.
  void
  note_entries_without_effect(const Parameters            &p,
                              const BodyParameters        &body,
                              const std::set<std::string> &idle_constants,
                              ParameterTable              &table);
} // namespace Debond

#endif
