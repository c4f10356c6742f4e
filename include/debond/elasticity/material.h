// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_material_h
#define debond_elasticity_material_h

#include <deal.II/base/symmetric_tensor.h>

namespace Debond
{
  /// An isotropic, homogeneous, linearly elastic material.
  struct Material
  {
    enum class Hypothesis
    {
      plane_stress, ///< thin body, paper's eq. (16)
      plane_strain
    };

    double     young_modulus = 69.;  ///< E > 0, force per area
    double     poisson_ratio = 0.33; ///< nu
    Hypothesis hypothesis    = Hypothesis::plane_stress; ///< 2D only

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
    shear_modulus() const;

    /// The tensor of sigma = E(epsilon), eq. (3).
    template <int dim>
    dealii::SymmetricTensor<4, dim>
    elasticity_tensor() const;

    /// Von Mises' equivalent stress of the in-plane stress sigma, with the
    /// out-of-plane stress that the hypothesis implies.
    template <int dim>
    double
    von_mises(const dealii::SymmetricTensor<2, dim> &stress) const;
  };
} // namespace Debond

#endif
