// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/input/material_parameters.h>

#include <stdexcept>
#include <vector>

namespace Debond
{
  namespace
  {
    /// @p region: with a blank in front, empty for the material everywhere.
    void
    check_numbers(const unsigned int dimension,
                  const Material    &material,
                  const std::string &region,
                  ParameterTable    &table)
    {
      try
        {
          if (dimension == 2)
            material.validate<2>();
          else
            material.validate<3>();
        }
      catch (const std::invalid_argument &error)
        {
          table.reject("Material/Poisson ratio" + region,
                       error.what(),
                       {"Dimension",
                        "Material/Young modulus",
                        "Material/Hypothesis"});
        }
    }
  } // namespace



  std::map<std::string, Material>
  MaterialParameters::of_regions() const
  {
    std::map<std::string, Material> materials;
    const auto take = [&](const std::map<std::string, std::string> &texts,
                          double Material::*const number) {
      for (const auto &[region, text] : texts)
        read_number(text,
                    materials.emplace(region, everywhere).first->second.*
                      number);
    };
    take(young_moduli, &Material::young_modulus);
    take(poisson_ratios, &Material::poisson_ratio);
    take(thermal_expansions, &Material::thermal_expansion);
    return materials;
  }



  std::string
  MaterialParameters::entry_of(const std::string &region) const
  {
    return "Material/" +
           std::string(young_moduli.count(region) > 0 ? "Young modulus " :
                       poisson_ratios.count(region) > 0 ?
                                                        "Poisson ratio " :
                                                        "Thermal expansion ") +
           region;
  }



  void
  bind_material(MaterialParameters &materials, ParameterTable &table)
  {
    Material         &material = materials.everywhere;
    const std::string region   = ", in the region of this name";
    const auto        bind     = [&](const std::string                  &path,
                          double                             &everywhere,
                          std::map<std::string, std::string> &regions,
                          const Pattern                      &pattern,
                          const std::string                  &documentation,
                          const std::string                  &units) {
      table.bind(path, everywhere, pattern, documentation, units);
      table.bind_family(path, regions, pattern, documentation + region, units);
    };
    bind("Material/Young modulus",
         material.young_modulus,
         materials.young_moduli,
         quantity(),
         "E",
         "force per area");
    bind(
      "Material/Poisson ratio",
      material.poisson_ratio,
      materials.poisson_ratios,
      number(),
      "nu, in (-1, 1) in plane stress and in (-1, 0.5) in plane strain and 3D",
      "none");
    bind("Material/Thermal expansion",
         material.thermal_expansion,
         materials.thermal_expansions,
         number(),
         "alpha, the strain that a change of temperature by one makes",
         "per temperature");
    table.bind_choice(
      "Material/Hypothesis",
      material.hypothesis,
      {{"plane stress", Material::Hypothesis::plane_stress},
       {"plane strain", Material::Hypothesis::plane_strain}},
      "How the plane body represents a solid one; not used in 3D");
  }



  void
  check_material(const unsigned int           dimension,
                 const MaterialParameters    &materials,
                 const std::set<std::string> &regions,
                 ParameterTable              &table)
  {
    check_numbers(dimension, materials.everywhere, "", table);
    const std::vector<std::string> known(regions.begin(), regions.end());
    const auto                     check = [&](const std::string                        &path,
                           const std::map<std::string, std::string> &texts) {
      for (const auto &[region, unused] : texts)
        if (regions.count(region) == 0)
          table.reject(path + ' ' + region,
                       "the body has no region " + region +
                         (known.empty() ? "; name one in Parts" :
                                                              ", but " + join(known, ", ")));
    };
    check("Material/Young modulus", materials.young_moduli);
    check("Material/Poisson ratio", materials.poisson_ratios);
    check("Material/Thermal expansion", materials.thermal_expansions);
    for (const auto &[region, material] : materials.of_regions())
      if (regions.count(region) > 0 &&
          materials.poisson_ratios.count(region) > 0)
        check_numbers(dimension, material, ' ' + region, table);
  }
} // namespace Debond
