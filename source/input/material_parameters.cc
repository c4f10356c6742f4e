// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/material_parameters.h>

#include <stdexcept>

namespace Debond
{
  void
  bind_material(Material &material, ParameterTable &table)
  {
    table.bind("Material/Young modulus",
               material.young_modulus,
               quantity(),
               "E",
               "force per area");
    table.bind(
      "Material/Poisson ratio",
      material.poisson_ratio,
      any_number(),
      "nu, in (-1, 1) in plane stress and in (-1, 0.5) in plane strain and 3D",
      "none");
    table.bind_choice(
      "Material/Hypothesis",
      material.hypothesis,
      {{"plane stress", Material::Hypothesis::plane_stress},
       {"plane strain", Material::Hypothesis::plane_strain}},
      "How the plane body represents a solid one; not used in 3D");
  }



  void
  check_material(const unsigned int dimension,
                 const Material    &material,
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
        table.add_error("Material/Poisson ratio",
                        error.what(),
                        {"Dimension",
                         "Material/Young modulus",
                         "Material/Hypothesis"});
      }
  }
} // namespace Debond
