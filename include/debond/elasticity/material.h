// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_material_h
#define debond_elasticity_material_h

#include <deal.II/base/symmetric_tensor.h>

namespace Debond
{
  /// An isotropic, linearly elastic material.
  struct Material
  {
    enum class Hypothesis
    {
      plane_stress, ///< thin body, paper's eq. (16)
      plane_strain
    };

    double     young_modulus     = 69.;  ///< E > 0, force per area
    double     poisson_ratio     = 0.33; ///< nu
    Hypothesis hypothesis        = Hypothesis::plane_stress; ///< 2D only
    double     thermal_expansion = 0.; ///< alpha, per temperature

    /// Throws std::invalid_argument with the allowed range if E <= 0 or nu is
    /// outside (-1, 1) in plane stress, (-1, 1/2) otherwise.
    template <int dim>
    void
    validate() const;

    /// Lame's lambda; in plane stress the one of the plane problem.
    template <int dim>
    double
    lame_lambda() const;

    /// Lame's mu.
    double
    shear_modulus() const
    {
      return young_modulus / (2. * (1. + poisson_ratio));
    }

    /// The stress that a temperature change of one gives a body that cannot
    /// move is minus this number times the identity: (3 lambda + 2 mu) alpha
    /// with the lambda of the solid, in plane stress E alpha / (1 - nu).
    template <int dim>
    double
    thermal_stress() const;

    /// The tensor of sigma = E(epsilon), eq. (3).
    template <int dim>
    dealii::SymmetricTensor<4, dim>
    elasticity_tensor() const;

    /// The stress of the solid body: @p stress, with the out-of-plane stress
    /// that the hypothesis implies if a change of temperature makes @p
    /// thermal_stress of thermal_stress().
    template <int dim>
    dealii::SymmetricTensor<2, 3>
    solid_stress(const dealii::SymmetricTensor<2, dim> &stress,
                 const double thermal_stress = 0.) const;

    /// The strain energy per volume of that stress.
    double
    energy_density(const dealii::SymmetricTensor<2, 3> &stress) const;
  };

  /// Von Mises' equivalent stress.
  double
  von_mises(const dealii::SymmetricTensor<2, 3> &stress);
} // namespace Debond

#endif
