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

    /// Numbers by the names of the regions.
    std::map<std::string, std::string> young_moduli;
    std::map<std::string, std::string> poisson_ratios;
    std::map<std::string, std::string> thermal_expansions;

    /// The materials of the regions that have a number of their own, by name.
    std::map<std::string, Material>
    of_regions() const;

    /// An entry that gives the region a number of its own.
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
