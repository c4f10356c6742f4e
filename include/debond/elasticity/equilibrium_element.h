// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_equilibrium_element_h
#define debond_elasticity_equilibrium_element_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/material.h>

#include <Eigen/Core>

#include <vector>

namespace Debond
{
  /**
   * The composite equilibrium element of Fraeijs de Veubeke and of Johnson and
   * Mercier (Numer. Math. 30, 1978): symmetric stresses that are linear on the
   * triangles between the sides of a polygon and its centre, with tractions
   * that are continuous inside. The polygon is a triangle cut at its centroid
   * or a parallelogram cut along its diagonals. With the divergence prescribed,
   * 9 or 13 stresses are left, as many as there are linear tractions on the
   * sides in equilibrium.
   *
   * The tractions of all stresses sigma with div sigma + f = 0 are reached by
   * the displacements l of the sides: with the strain that sigma and the
   * thermal stress p make,
   *
   *     max_sigma -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1) + l't(sigma)
   *         = 1/2 l'K l - F'l + constant.
   *
   * Side i from corner i to corner i+1 has four numbers in l: the mean of the
   * displacement's x and y components, and their slopes, the coefficients of xi
   * in [-1, 1] along the side; t are the work-conjugate moments of the traction
   * with 1 and xi.
   */
  struct EquilibriumElement
  {
    /// @p corners: counterclockwise, three, or four of a parallelogram.
    /// @p body_force: constant, force per area. @p thermal_stress: p, see
    /// Material::thermal_stress().
    EquilibriumElement(const std::vector<dealii::Point<2>> &corners,
                       const Material                      &material,
                       const dealii::Tensor<1, 2>          &body_force,
                       const double                         thermal_stress);

    /// The same at another place: @p other_corners are its corners but for a
    /// motion without rotation.
    EquilibriumElement
    moved_to(const std::vector<dealii::Point<2>> &other_corners) const;

    /// The stress that is reached for @p displacements l, with C made @p weight
    /// times as stiff: for each side the triangle above it, for each of its
    /// corners (those of the side, then the centre) xx, yy and xy.
    Eigen::VectorXd
    stress(const Eigen::VectorXd &displacements,
           const double           weight = 1.) const;

    std::vector<dealii::Point<2>> corners;
    dealii::Point<2>              centre;
    double                        area;

    /// With C made c times as stiff these are c K, F and constant / c.
    Eigen::MatrixXd K;
    Eigen::VectorXd F;
    double          constant;

  private:
    Eigen::MatrixXd to_stress;  ///< stress without loads for l
    Eigen::VectorXd particular; ///< stress for l = 0
  };



  /// int sigma : C^{-1} sigma over a triangle of the given area, C that of the
  /// material, with sigma as EquilibriumElement::stress() has it.
  double
  complementary_energy(const Eigen::Matrix<double, 9, 1> &stress,
                       const double                       area,
                       const Material                    &material);
} // namespace Debond

#endif
