// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/numbers.h>
#include <deal.II/physics/notation.h>
#include <deal.II/physics/transformations.h>

#include <debond/base/text.h>
#include <debond/elasticity/material.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    template <int rank>
    using Solid = dealii::SymmetricTensor<rank, 3>;



    /// The rotation from the material axes to those of the body, or back.
    dealii::Tensor<2, 3>
    rotation(const double degrees)
    {
      // The material's axis 3 is the z axis, so that the rotation is about it
      // in 2D and 3D.
      return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
        dealii::Point<3>(0., 0., 1.), degrees * dealii::numbers::PI / 180.);
    }



    Solid<2>
    rotated(const Solid<2> &tensor, const double degrees)
    {
      // Axes that are not turned keep their numbers exactly.
      return degrees == 0. ?
               tensor :
               dealii::Physics::Transformations::basis_transformation(
                 tensor, rotation(degrees));
    }



    /// The components in the plane, or all of them.
    template <int dim>
    dealii::SymmetricTensor<4, dim>
    part_of(const Solid<4> &solid)
    {
      // In plane strain the plane part of the solid's tensor is that of the
      // plane problem, as strains across the plane are zero. In plane stress
      // solid_tensor() has been condensed already.
      dealii::SymmetricTensor<4, dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = i; j < dim; ++j)
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int l = k; l < dim; ++l)
              result[i][j][k][l] = solid[i][j][k][l];
      return result;
    }



    /// The reason why energies are not positive; empty if they are.
    std::string
    fault(const Orthotropy &material)
    {
      // Energies are positive if the compliance is positive definite. Its shear
      // part is diagonal, and the normal part is tested by its principal
      // minors, in terms of the material constants: positive moduli; nu_ij^2 <
      // E_i / E_j, that is nu_ij nu_ji < 1, for each pair; and the determinant.
      // The comparisons are written so that numbers that are not finite fail
      // them.
      const Orthotropy::Three &E = material.young_moduli;
      const Orthotropy::Three &G = material.shear_moduli;
      for (const Orthotropy::Three &moduli : {E, G})
        for (const double modulus : moduli)
          if (!(modulus > 0. && std::isfinite(modulus)))
            return "three Young moduli and three shear moduli must be positive "
                   "and finite";
      const Orthotropy::Three &nu = material.poisson_ratios;
      for (unsigned int i = 0, pair = 0; i < 3; ++i)
        for (unsigned int j = i + 1; j < 3; ++j, ++pair)
          if (!(nu[pair] * nu[pair] < E[i] / E[j]))
            return words("nu_",
                         i + 1,
                         j + 1,
                         " = ",
                         nu[pair],
                         " must be nearer to 0 than sqrt(E_",
                         i + 1,
                         " / E_",
                         j + 1,
                         ") = ",
                         std::sqrt(E[i] / E[j]));
      // The determinant of the normal part of the compliance times E_1 E_2 E_3.
      // With nu_ji = nu_ij E_j / E_i it is 1 - nu_12 nu_21 - nu_13 nu_31 -
      // nu_23 nu_32 - 2 nu_12 nu_23 nu_31.
      const double rest =
        1. - nu[0] * nu[0] * E[1] / E[0] - nu[1] * nu[1] * E[2] / E[0] -
        nu[2] * nu[2] * E[2] / E[1] - 2. * nu[0] * nu[1] * nu[2] * E[2] / E[0];
      return rest > 0. ?
               "" :
               words("nu_12, nu_13 and nu_23 together make energies negative: "
                     "1 - nu_12 nu_21 - nu_13 nu_31 - nu_23 nu_32 - 2 nu_12 "
                     "nu_23 nu_31 = ",
                     rest,
                     " must be positive");
    }
  } // namespace



  bool
  Material::operator==(const Material &other) const
  {
    return young_modulus == other.young_modulus &&
           poisson_ratio == other.poisson_ratio &&
           hypothesis == other.hypothesis &&
           thermal_expansions == other.thermal_expansions &&
           orthotropy == other.orthotropy && axis_angle == other.axis_angle;
  }



  template <int dim>
  void
  Material::validate() const
  {
    if (orthotropy)
      {
        if (const std::string reason = fault(*orthotropy); !reason.empty())
          throw std::invalid_argument(reason);
        return;
      }
    if (!(young_modulus > 0. && std::isfinite(young_modulus)))
      throw std::invalid_argument(words(
        "Young modulus = ", young_modulus, " must be positive and finite."));

    // In plane stress lambda' = E nu / (1 - nu^2), and lambda' + mu > 0 allows
    // all nu below 1. Otherwise the bulk modulus is infinite at nu = 1/2.
    const bool is_plane_stress =
      dim == 2 && hypothesis == Hypothesis::plane_stress;
    const double largest = is_plane_stress ? 1. : 0.5;
    if (!(poisson_ratio > -1. && poisson_ratio < largest))
      throw std::invalid_argument(words("Poisson ratio = ",
                                        poisson_ratio,
                                        " must lie in (-1, ",
                                        largest,
                                        ") in ",
                                        dim == 3        ? "3D" :
                                        is_plane_stress ? "plane stress" :
                                                          "plane strain",
                                        "."));
  }



  template <int dim>
  double
  Material::lame_lambda() const
  {
    if (orthotropy)
      {
        // This serves estimates that know isotropic materials alone: mu is the
        // least shear modulus, and lambda + 2 mu the largest stiffness along an
        // axis of the material. The angle is taken away so that it does not
        // depend on how the axes are turned.
        Material unturned    = *this;
        unturned.axis_angle  = 0.;
        const auto stiffness = unturned.elasticity_tensor<dim>();
        double     largest   = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          largest = std::max(largest, stiffness[d][d][d][d]);
        return largest - 2. * shear_modulus();
      }
    // In plane stress sigma_zz = 0 is eliminated from the law of the solid:
    // lambda' = 2 lambda mu / (lambda + 2 mu) = E nu / (1 - nu^2), with the
    // same mu.
    const double E  = young_modulus;
    const double nu = poisson_ratio;
    return dim == 2 && hypothesis == Hypothesis::plane_stress ?
             E * nu / (1. - nu * nu) :
             E * nu / ((1. + nu) * (1. - 2. * nu));
  }



  double
  Material::shear_modulus() const
  {
    return orthotropy ? *std::min_element(orthotropy->shear_moduli.begin(),
                                          orthotropy->shear_moduli.end()) :
                        young_modulus / (2. * (1. + poisson_ratio));
  }



  std::array<double, 2>
  Material::extreme_moduli() const
  {
    if (!orthotropy)
      return {{young_modulus, young_modulus}};
    // Shear moduli count as well, since they can be far below all Young moduli.
    const auto &E = orthotropy->young_moduli;
    const auto &G = orthotropy->shear_moduli;
    return {{std::min(*std::min_element(E.begin(), E.end()),
                      *std::min_element(G.begin(), G.end())),
             std::max(*std::max_element(E.begin(), E.end()),
                      *std::max_element(G.begin(), G.end()))}};
  }



  template <int dim>
  dealii::SymmetricTensor<2, 3>
  Material::thermal_stress() const
  {
    // A body that cannot move has the elastic strain -alpha theta and the
    // stress -C alpha theta. In plane stress the component across the plane is
    // zero, as the tensor has been condensed.
    return solid_tensor<dim>() * thermal_strain();
  }



  template <int dim>
  dealii::SymmetricTensor<4, 3>
  Material::solid_tensor() const
  {
    const bool is_plane_stress =
      dim == 2 && hypothesis == Hypothesis::plane_stress;
    Solid<4> result;
    if (orthotropy)
      {
        // The compliance is known along the material axes. It is turned to the
        // axes of the body and inverted there; its inverse is the stiffness.
        result =
          dealii::invert(dealii::Physics::Transformations::basis_transformation(
            compliance_along_axes(), rotation(axis_angle)));
        // In plane stress the strain across the plane is whatever makes
        // sigma_zz zero. Eliminating it is a rank-one change, C - (C e)(C e)' /
        // C_zzzz with the strain e = e_z e_z: afterwards the row and the column
        // of zz are zero, and the strain eps_zz that is given has no effect.
        // Without shear between plane and z, as the material is turned about z,
        // nothing else has to be eliminated.
        Solid<2> across;
        across[2][2] = 1.;
        if (is_plane_stress)
          {
            const Solid<2> stress = result * across;
            result -= dealii::outer_product(stress, stress) / stress[2][2];
          }
        return result;
      }
    // The isotropic law 2 mu eps + lambda tr(eps) I. In plane stress the
    // component zz is taken out of both parts, and lambda is that of the plane
    // problem.
    Solid<2> identity = dealii::unit_symmetric_tensor<3>();
    result            = 2. * shear_modulus() * dealii::identity_tensor<3>();
    if (is_plane_stress)
      identity[2][2] = result[2][2][2][2] = 0.;
    return result +
           lame_lambda<dim>() * dealii::outer_product(identity, identity);
  }



  template <int dim>
  dealii::SymmetricTensor<4, dim>
  Material::elasticity_tensor() const
  {
    return part_of<dim>(solid_tensor<dim>());
  }



  template <int dim>
  double
  Material::least_stiffness() const
  {
    // The isotropic tensor has the eigenvalues 2 mu and, in the direction of
    // the identity, 2 mu + dim lambda. Which of them is less depends on the
    // sign of lambda.
    if (!orthotropy)
      return 2. * shear_modulus() + dim * std::min(0., lame_lambda<dim>());
    // In Kelvin's notation shear strains have the factor sqrt(2), so that the
    // norm of the vector is that of the tensor and the eigenvalues of the
    // matrix are those of the tensor. In Voigt's notation, with the factor 2,
    // they would not be.
    const dealii::FullMatrix<double> kelvin =
      dealii::Physics::Notation::Kelvin::to_matrix(elasticity_tensor<dim>());
    Eigen::MatrixXd matrix(kelvin.m(), kelvin.n());
    for (unsigned int k = 0; k < kelvin.m(); ++k)
      for (unsigned int l = 0; l < kelvin.n(); ++l)
        matrix(k, l) = kelvin(k, l);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
             matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()(0);
  }



  double
  Material::energy_density(const dealii::SymmetricTensor<2, 3> &stress) const
  {
    if (orthotropy)
      {
        // The energy 1/2 sigma : S sigma from the compliance S, for the stress
        // of the solid: with it plane stress and plane strain are one formula.
        const Solid<2> along = along_axes(stress);
        return 0.5 * (along * (compliance_along_axes() * along));
      }
    // The same with S sigma = ((1 + nu) sigma - nu tr(sigma) I) / E.
    const double trace = dealii::trace(stress);
    return ((1. + poisson_ratio) * (stress * stress) -
            poisson_ratio * trace * trace) /
           (2. * young_modulus);
  }



  dealii::SymmetricTensor<2, 3>
  Material::along_axes(const dealii::SymmetricTensor<2, 3> &stress) const
  {
    return rotated(stress, -axis_angle);
  }



  dealii::SymmetricTensor<4, 3>
  Material::compliance_along_axes() const
  {
    // S_iiii = 1 / E_i, S_iijj = -nu_ij / E_i for i < j, which is symmetric by
    // definition, and 1 / (4 G_ij) for shear: the strain eps_ij is half of the
    // angle sigma_ij / G_ij, and as a tensor both sigma_ij and sigma_ji take
    // part in it with half of that each. The pairs are in the order 12, 13, 23
    // of the constants.
    Solid<4> result;
    for (unsigned int i = 0, pair = 0; i < 3; ++i)
      {
        result[i][i][i][i] = 1. / orthotropy->young_moduli[i];
        for (unsigned int j = i + 1; j < 3; ++j, ++pair)
          {
            result[i][i][j][j] = result[j][j][i][i] =
              -orthotropy->poisson_ratios[pair] / orthotropy->young_moduli[i];
            result[i][j][i][j] = 0.25 / orthotropy->shear_moduli[pair];
          }
      }
    return result;
  }



  dealii::SymmetricTensor<2, 3>
  Material::thermal_strain() const
  {
    // The expansions are along the axes of the material and have no shear
    // there; turned axes give the strain a shear component.
    Solid<2> along_axes;
    for (unsigned int d = 0; d < 3; ++d)
      along_axes[d][d] = thermal_expansions[d];
    return rotated(along_axes, axis_angle);
  }



  double
  von_mises(const dealii::SymmetricTensor<2, 3> &stress)
  {
    // sqrt(3/2 s : s) with the deviator s, which is |sigma| under uniaxial
    // stress.
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
  template dealii::SymmetricTensor<2, 3>
  Material::thermal_stress<2>() const;
  template dealii::SymmetricTensor<2, 3>
  Material::thermal_stress<3>() const;
  template dealii::SymmetricTensor<4, 3>
  Material::solid_tensor<2>() const;
  template dealii::SymmetricTensor<4, 3>
  Material::solid_tensor<3>() const;
  template dealii::SymmetricTensor<4, 2>
  Material::elasticity_tensor<2>() const;
  template dealii::SymmetricTensor<4, 3>
  Material::elasticity_tensor<3>() const;
  template double
  Material::least_stiffness<2>() const;
  template double
  Material::least_stiffness<3>() const;
} // namespace Debond
