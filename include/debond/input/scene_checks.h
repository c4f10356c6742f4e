// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_scene_checks_h
#define debond_input_scene_checks_h

#include <debond/input/parameters.h>

namespace Debond
{
  /// Refuses what a body of revolution cannot have. Its material is that of the
  /// solid, as in plane strain.
  void
  check_symmetry(Parameters &p, ParameterTable &table);

  /// Checks bonds that vary, as the scene gives them, and the names in entries
  /// that contact boundaries have of their own.
  void
  check_bonds(const Parameters &p, ParameterTable &table);

  /// Refuses entries that cannot be together, and names that the body does not
  /// have.
  void
  check_scene(Parameters &p, ParameterTable &table);
} // namespace Debond

#endif
