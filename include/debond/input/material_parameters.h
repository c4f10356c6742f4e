// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_material_parameters_h
#define debond_input_material_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/elasticity/material.h>

namespace Debond
{
  /// The material, and what regions have of their own.
  struct MaterialParameters
  {
    Material everywhere;

    /// Texts of regions, by the entry ("Young modulus") and the region's name.
    std::map<std::string, std::map<std::string, std::string>> own;

    /// Returns the materials of the regions that have a number of their own, by
    /// name.
    std::map<std::string, Material>
    of_regions() const;

    /// Says whether some material expands with temperature.
    bool
    expands() const;

    /// Says whether the thermal stress of some material depends on the
    /// direction.
    bool
    has_axes() const;

    /// Returns an entry of the section that is the region's own, or the whole
    /// body's if @p region is empty, on which its elasticity depends.
    std::string
    entry_of(const std::string &region) const;
  };

  /// Binds the section Material.
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
