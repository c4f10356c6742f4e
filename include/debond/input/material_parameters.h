// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_material_parameters_h
#define debond_input_material_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/elasticity/material.h>

#include <map>
#include <set>
#include <string>

namespace Debond
{
  /// The material, and what regions have of their own.
  struct MaterialParameters
  {
    Material everywhere;

    /// What regions set, by the entry ("Young modulus") and the region's name.
    std::map<std::string, std::map<std::string, std::string>> own;

    /// The materials of the regions that have a number of their own, by name.
    std::map<std::string, Material>
    of_regions() const;

    /// Whether some material expands with temperature.
    bool
    expands() const;

    /// Whether the thermal stress of some material depends on the direction.
    bool
    has_axes() const;

    /// An entry of the section that is the region's own, or the whole body's
    /// if @p region is empty, on which its elasticity depends.
    std::string
    entry_of(const std::string &region) const;
  };

  /// The section Material.
  void
  bind_material(MaterialParameters &materials, ParameterTable &table);

  /// Rejects numbers that make no material, and regions that the body has not.
  void
  check_material(const unsigned int           dimension,
                 const MaterialParameters    &materials,
                 const std::set<std::string> &regions,
                 ParameterTable              &table);
} // namespace Debond

#endif
