// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_material_parameters_h
#define debond_input_material_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/elasticity/material.h>

namespace Debond
{
  /// The section Material.
  void
  bind_material(Material &material, ParameterTable &table);

  /// Rejects numbers that make no material.
  void
  check_material(const unsigned int dimension,
                 const Material    &material,
                 ParameterTable    &table);
} // namespace Debond

#endif
