// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/material_parameters.h>

#include <algorithm>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    using Three = std::array<double, 3>;

    /// One number for all three of them if @p may_be_one.
    bool
    read_three(const std::string &text, const bool may_be_one, Three &numbers)
    {
      const std::vector<std::string> items =
        dealii::Utilities::split_string_list(text, ',');
      if (items.size() != 3 && !(may_be_one && items.size() == 1))
        return false;
      for (unsigned int i = 0; i < 3; ++i)
        if (!read_number(items[items.size() == 1 ? 0 : i], numbers[i]))
          return false;
      return true;
    }



    /// Without a text there are none of them, and without any no orthotropy.
    void
    set_orthotropy(const std::string &text,
                   Three Orthotropy::*const numbers,
                   Material                &material)
    {
      // Three entries have nine numbers between them and are read one after the
      // other. As soon as one of them has numbers the material is orthotropic;
      // if the last of them becomes empty again, it is not.
      Orthotropy own = material.orthotropy.value_or(Orthotropy());
      if (text.empty())
        own.*numbers = {};
      else
        read_three(text, false, own.*numbers);
      if (own == Orthotropy())
        material.orthotropy.reset();
      else
        material.orthotropy = own;
    }



    Pattern
    three_numbers(const std::string &words, const bool may_be_one)
    {
      return Pattern(words, [may_be_one](const std::string &text) {
        Three numbers;
        return text.empty() || read_three(text, may_be_one, numbers);
      });
    }



    /// An entry of the section, for the whole body and for regions.
    struct Entry
    {
      std::string                                          name;
      std::string                                          default_value;
      Pattern                                              pattern;
      std::string                                          documentation, units;
      std::function<void(Material &, const std::string &)> set;
    };

    const std::vector<Entry> &
    entries()
    {
      // Each entry stands here once. bind_material() declares it for the whole
      // body and for regions, and of_regions() applies it to the material of a
      // region by the same function.
      const auto one = [](double Material::*const number) {
        return [number](Material &material, const std::string &text) {
          read_number(text, material.*number);
        };
      };
      const auto three = [](Three Orthotropy::*const numbers) {
        return [numbers](Material &material, const std::string &text) {
          set_orthotropy(text, numbers, material);
        };
      };
      const Pattern axes = three_numbers("nothing, or three numbers", false);
      static const std::vector<Entry> all = {
        {"Young modulus",
         "69",
         quantity(),
         "E",
         "force per area",
         one(&Material::young_modulus)},
        {"Poisson ratio",
         "0.33",
         number(),
         "nu, in (-1, 1) in plane stress and in (-1, 0.5) in plane strain and 3D",
         "none",
         one(&Material::poisson_ratio)},
        {"Young moduli",
         "",
         axes,
         "E_1, E_2, E_3 along the axes of an orthotropic material, in place of Young modulus and Poisson ratio",
         "force per area",
         three(&Orthotropy::young_moduli)},
        {"Poisson ratios",
         "",
         axes,
         "nu_12, nu_13, nu_23 of an orthotropic material: a force along the first axis strains it by -nu times as much along the second one",
         "none",
         three(&Orthotropy::poisson_ratios)},
        {"Shear moduli",
         "",
         axes,
         "G_12, G_13, G_23 of an orthotropic material",
         "force per area",
         three(&Orthotropy::shear_moduli)},
        {"Axis angle",
         "0",
         number(),
         "From x to axis 1 of the material, about z, which is axis 3",
         "degrees",
         one(&Material::axis_angle)},
        {"Thermal expansion",
         "0",
         three_numbers("a number, or three", true),
         "alpha, the strain that a change of temperature by one makes, or alpha_1, alpha_2, alpha_3 along the material's axes",
         "per temperature",
         [](Material &material, const std::string &text) {
           read_three(text, true, material.thermal_expansions);
         }}};
      return all;
    }



    /// @p region: empty for the material everywhere.
    void
    check_numbers(const unsigned int        dimension,
                  const Material           &material,
                  const MaterialParameters &materials,
                  const std::string        &region,
                  ParameterTable           &table)
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
          table.reject(materials.entry_of(region),
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
    // A region has the material of the whole body but for what is its own.
    std::map<std::string, Material> materials;
    for (const auto &[name, texts] : own)
      for (const auto &[region, unused] : texts)
        materials.emplace(region, everywhere);
    for (auto &[region, material] : materials)
      {
        // A region with a Young modulus of its own is isotropic, also in an
        // orthotropic body.
        if (own.at("Young modulus").count(region) > 0)
          material.orthotropy.reset();
        for (const Entry &entry : entries())
          if (const auto text = own.at(entry.name).find(region);
              text != own.at(entry.name).end())
            entry.set(material, text->second);
      }
    return materials;
  }



  bool
  MaterialParameters::expands() const
  {
    // A region that has an entry of its own expands, whatever its number is.
    return everywhere.thermal_expansions != Three() ||
           !own.at("Thermal expansion").empty();
  }



  bool
  MaterialParameters::has_axes() const
  {
    const auto has = [](const Material &material) {
      const Three &alpha = material.thermal_expansions;
      return material.orthotropy || alpha[0] != alpha[1] ||
             alpha[0] != alpha[2];
    };
    const auto regions = of_regions();
    return has(everywhere) ||
           std::any_of(regions.begin(), regions.end(), [&](const auto &region) {
             return has(region.second);
           });
  }



  std::string
  MaterialParameters::entry_of(const std::string &region) const
  {
    // What makes a material impossible are several numbers together. The
    // message is at the first entry that the region has itself, since that is
    // where it differs from the material of the body.
    if (region.empty())
      return everywhere.orthotropy ? "Material/Young moduli" :
                                     "Material/Poisson ratio";
    for (const std::string name : {"Poisson ratio",
                                   "Poisson ratios",
                                   "Young modulus",
                                   "Young moduli",
                                   "Shear moduli",
                                   "Axis angle"})
      if (own.at(name).count(region) > 0)
        return "Material/" + name + ' ' + region;
    return "Material/Thermal expansion " + region;
  }



  void
  bind_material(MaterialParameters &materials, ParameterTable &table)
  {
    for (const Entry &entry : entries())
      {
        const std::string path = "Material/" + entry.name;
        table.declare(path,
                      entry.default_value,
                      entry.pattern,
                      entry.documentation,
                      entry.units,
                      [&materials, &entry](const std::string &text) {
                        entry.set(materials.everywhere, text);
                      });
        table.bind_family(path,
                          materials.own[entry.name],
                          entry.pattern,
                          entry.documentation + ", in the region of this name",
                          entry.units);
      }
    table.bind_choice(
      "Material/Hypothesis",
      materials.everywhere.hypothesis,
      {{"plane stress", Material::Hypothesis::plane_stress},
       {"plane strain", Material::Hypothesis::plane_strain}},
      "How the plane body represents a solid one; not used in 3D and with Symmetry = axis");
  }



  void
  check_material(const unsigned int           dimension,
                 const MaterialParameters    &materials,
                 const std::set<std::string> &regions,
                 ParameterTable              &table)
  {
    // Regions that the body does not have are refused as such, and their
    // numbers are not looked at. The isotropic numbers of an orthotropic body
    // have no effect unless a region is isotropic, which may take its Poisson
    // ratio from it.
    check_numbers(dimension, materials.everywhere, materials, "", table);
    if (materials.everywhere.orthotropy &&
        materials.own.at("Young modulus").empty())
      table.without_effect("Material/Young modulus, Material/Poisson ratio",
                           "the material is orthotropic");
    const std::vector<std::string> known(regions.begin(), regions.end());
    for (const auto &[name, texts] : materials.own)
      for (const auto &[region, unused] : texts)
        if (regions.count(region) == 0)
          table.reject("Material/" + name + ' ' + region,
                       "the body has no region " + region +
                         (known.empty() ? "; name one in Parts" :
                                          ", but " + join(known, ", ")));
    for (const auto &[region, material] : materials.of_regions())
      if (regions.count(region) > 0)
        check_numbers(dimension, material, materials, region, table);
  }
} // namespace Debond
