// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/material.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  template <int dim>
  void
  Material::validate() const
  {
    std::ostringstream message;
    if (!(young_modulus > 0. && std::isfinite(young_modulus)))
      message << "Young modulus = " << young_modulus
              << " must be positive and finite.";

    const bool is_plane_stress =
      dim == 2 && hypothesis == Hypothesis::plane_stress;
    const double largest = is_plane_stress ? 1. : 0.5;
    if (message.str().empty() &&
        !(poisson_ratio > -1. && poisson_ratio < largest))
      message << "Poisson ratio = " << poisson_ratio << " must lie in (-1, "
              << largest << ") in "
              << (dim == 3        ? "3D" :
                  is_plane_stress ? "plane stress" :
                                    "plane strain")
              << ".";

    if (!message.str().empty())
      throw std::invalid_argument(message.str());
  }



  template <int dim>
  double
  Material::lame_lambda() const
  {
    const double E  = young_modulus;
    const double nu = poisson_ratio;
    return dim == 2 && hypothesis == Hypothesis::plane_stress ?
             E * nu / (1. - nu * nu) :
             E * nu / ((1. + nu) * (1. - 2. * nu));
  }



  template <int dim>
  double
  Material::thermal_stress() const
  {
    const bool is_plane_stress =
      dim == 2 && hypothesis == Hypothesis::plane_stress;
    return young_modulus * thermal_expansion /
           (1. - (is_plane_stress ? 1. : 2.) * poisson_ratio);
  }



  template <int dim>
  dealii::SymmetricTensor<4, dim>
  Material::elasticity_tensor() const
  {
    const auto identity = dealii::unit_symmetric_tensor<dim>();
    return lame_lambda<dim>() * dealii::outer_product(identity, identity) +
           2. * shear_modulus() * dealii::identity_tensor<dim>();
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  Material::solid_stress(const dealii::SymmetricTensor<2, dim> &stress,
                         const double thermal_stress) const
  {
    dealii::SymmetricTensor<2, 3> s;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = i; j < dim; ++j)
        s[i][j] = stress[i][j];
    if (dim == 2 && hypothesis == Hypothesis::plane_strain)
      s[2][2] = poisson_ratio * dealii::trace(stress) -
                (1. - 2. * poisson_ratio) * thermal_stress;
    return s;
  }



  double
  Material::energy_density(const dealii::SymmetricTensor<2, 3> &stress) const
  {
    const double trace = dealii::trace(stress);
    return ((1. + poisson_ratio) * (stress * stress) -
            poisson_ratio * trace * trace) /
           (2. * young_modulus);
  }



  double
  von_mises(const dealii::SymmetricTensor<2, 3> &stress)
  {
    return std::sqrt(1.5) * dealii::deviator(stress).norm();
  }



  template void
  Material::validate<2>() const;
  template void
  Material::validate<3>() const;
  template double
  Material::lame_lambda<2>() const;
  template double
  Material::lame_lambda<3>() const;
  template double
  Material::thermal_stress<2>() const;
  template double
  Material::thermal_stress<3>() const;
  template dealii::SymmetricTensor<4, 2>
  Material::elasticity_tensor<2>() const;
  template dealii::SymmetricTensor<4, 3>
  Material::elasticity_tensor<3>() const;
  template dealii::SymmetricTensor<2, 3>
  Material::solid_stress(const dealii::SymmetricTensor<2, 2> &,
                         const double) const;
  template dealii::SymmetricTensor<2, 3>
  Material::solid_stress(const dealii::SymmetricTensor<2, 3> &,
                         const double) const;
} // namespace Debond
