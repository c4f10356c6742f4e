// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_material_h
#define debond_elasticity_material_h

#include <deal.II/base/symmetric_tensor.h>

#include <array>
#include <optional>

namespace Debond
{
  /// Three planes of symmetry, normal to the material axes 1, 2 and 3. A force
  /// along axis i strains the body by -nu_ij times as much along axis j.
  struct Orthotropy
  {
    using Three = std::array<double, 3>;

    Three young_moduli   = {}; ///< E_1, E_2, E_3
    Three poisson_ratios = {}; ///< nu_12, nu_13, nu_23
    Three shear_moduli   = {}; ///< G_12, G_13, G_23

    bool
    operator==(const Orthotropy &other) const
    {
      return young_moduli == other.young_moduli &&
             poisson_ratios == other.poisson_ratios &&
             shear_moduli == other.shear_moduli;
    }
  };



  /// A linearly elastic material, isotropic unless it has an orthotropy, in
  /// place of E and nu.
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

    /// alpha along the material axes, per temperature.
    std::array<double, 3> thermal_expansions = {};

    std::optional<Orthotropy> orthotropy = {};

    /// Degrees, from x to material axis 1 about z, which is axis 3.
    double axis_angle = 0.;

    bool
    operator==(const Material &other) const;

    /// Throws std::invalid_argument with the allowed range if E <= 0 or nu is
    /// outside (-1, 1) in plane stress, (-1, 1/2) otherwise, or if strains have
    /// a negative energy.
    template <int dim>
    void
    validate() const;

    /// Lame's lambda; in plane stress the one of the plane problem. Of an
    /// orthotropic material, for estimates, the one with which lambda + 2 mu is
    /// the largest stiffness along an axis.
    template <int dim>
    double
    lame_lambda() const;

    /// Lame's mu, of an orthotropic material the least shear modulus.
    double
    shear_modulus() const;

    /// The least and the largest modulus; E twice of an isotropic material.
    std::array<double, 2>
    extreme_moduli() const;

    /// E' of a crack, E / (1 - nu^2) but in plane stress; of an orthotropic
    /// material about that.
    template <int dim>
    double
    plane_modulus() const
    {
      if (!orthotropy)
        return dim == 2 && hypothesis == Hypothesis::plane_stress ?
                 young_modulus :
                 young_modulus / (1. - poisson_ratio * poisson_ratio);
      const double mu     = shear_modulus();
      const double lambda = lame_lambda<dim>();
      return 4. * mu * (lambda + mu) / (lambda + 2. * mu);
    }

    /// The stress that a temperature change of one gives a body that cannot
    /// move is minus this: of an isotropic one (3 lambda + 2 mu) alpha times
    /// the identity with the lambda of the solid, in plane stress E alpha / (1
    /// - nu) in the plane.
    template <int dim>
    dealii::SymmetricTensor<2, 3>
    thermal_stress() const;

    /// The tensor that takes the strain of the solid to its stress. In plane
    /// stress the component across the plane is zero, whatever its strain is
    /// given as.
    template <int dim>
    dealii::SymmetricTensor<4, 3>
    solid_tensor() const;

    /// The tensor of sigma = E(epsilon), eq. (3), in the plane or in 3D.
    template <int dim>
    dealii::SymmetricTensor<4, dim>
    elasticity_tensor() const;

    /// The least of epsilon : E(epsilon) over strains of the norm 1.
    template <int dim>
    double
    least_stiffness() const;

    /// The strain energy per volume of a stress of the solid.
    double
    energy_density(const dealii::SymmetricTensor<2, 3> &stress) const;

    /// A stress of the solid in the material axes.
    dealii::SymmetricTensor<2, 3>
    along_axes(const dealii::SymmetricTensor<2, 3> &stress) const;

  private:
    /// The strains of stresses in the orthotropic solid, in its axes.
    dealii::SymmetricTensor<4, 3>
    compliance_along_axes() const;

    /// The strain that a temperature change of one makes of the free solid.
    dealii::SymmetricTensor<2, 3>
    thermal_strain() const;
  };

  /// The components that both dimensions have; the others are zero.
  template <int to, int from>
  dealii::SymmetricTensor<2, to>
  resized(const dealii::SymmetricTensor<2, from> &tensor)
  {
    constexpr unsigned int         n = to < from ? to : from;
    dealii::SymmetricTensor<2, to> result;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = i; j < n; ++j)
        result[i][j] = tensor[i][j];
    return result;
  }

  /// Von Mises' equivalent stress.
  double
  von_mises(const dealii::SymmetricTensor<2, 3> &stress);
} // namespace Debond

#endif
