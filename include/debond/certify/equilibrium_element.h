// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_equilibrium_element_h
#define debond_certify_equilibrium_element_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/material.h>

#include <Eigen/Core>

namespace Debond
{
  template <int dim>
  using SimplexCorners = std::array<dealii::Point<dim>, dim + 1>;

  /// The area or volume of a simplex, and the outward normal of the side
  /// opposite to each corner, as long as that side or its area.
  template <int dim>
  struct SimplexGeometry
  {
    explicit SimplexGeometry(const SimplexCorners<dim> &corners);

    double                                      measure;
    std::array<dealii::Tensor<1, dim>, dim + 1> normals;
  };



  template <int dim>
  constexpr int n_stress_components =
    dealii::SymmetricTensor<2, dim>::n_independent_components;

  /// Linear stresses on a simplex: for each corner the components xx, yy, xy,
  /// in 3D xx, yy, zz, xy, xz, yz.
  template <int dim>
  using LinearStress =
    Eigen::Matrix<double, (dim + 1) * n_stress_components<dim>, 1>;

  template <int dim>
  constexpr int n_of_part = LinearStress<dim>::RowsAtCompileTime;



  /**
   * The composite equilibrium element of Fraeijs de Veubeke and of Johnson and
   * Mercier (Numer. Math. 30, 1978), in 3D that of Krizek (Numer. Math. 40,
   * 1982): symmetric stresses that are linear on the dim + 1 simplices between
   * the sides of a triangle or a tetrahedron and its centroid, with tractions
   * that are continuous inside. With the divergence prescribed, 9 or 30
   * stresses are left, as many as there are linear tractions on the sides in
   * equilibrium.
   *
   * The tractions of all stresses sigma with div sigma + f = 0 are reached by
   * the displacements l of the sides: with the strain that sigma and the
   * thermal stress p make,
   *
   *     max_sigma -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1) + l't(sigma)
   *         = 1/2 l'K l - F'l + constant.
   *
   * Side i is opposite to corner i and has the others in their order. It has
   * dim^2 numbers in l, component by component of dim vectors: the means of the
   * displacement with the weights dim lambda_k, lambda the barycentric
   * coordinates of the side. Their work-conjugates t are the tractions at its
   * corners times measure / dim.
   *
   * One object serves all simplices of a material that are the same at
   * different places.
   */
  template <int dim>
  struct EquilibriumElement
  {
    static constexpr unsigned int unknowns_of_a_side = dim * dim;
    static constexpr unsigned int n_unknowns = (dim + 1) * unknowns_of_a_side;

    EquilibriumElement(const SimplexCorners<dim> &corners,
                       const Material            &material);

    /// The body force, constant, per volume (per area of the plane in 2D), and
    /// p, see Material::thermal_stress().
    using Load = Eigen::Matrix<double, dim + 1, 1>;

    /// With C made c times as stiff these are c K, F and constant / c.
    Eigen::MatrixXd K;

    Eigen::VectorXd
    F(const Load &load) const
    {
      return F_of_load * load;
    }

    double
    constant(const Load &load) const
    {
      return load.dot(constant_of_load * load);
    }

    /// The stress that is reached for l, with C made @p weight times as stiff:
    /// a LinearStress of each part, between side i and the centroid, with the
    /// corners of the side and the centroid.
    Eigen::VectorXd
    stress(const Eigen::VectorXd &l,
           const Load            &load,
           const double           weight = 1.) const
    {
      return weight * (stress_of_l * l) + stress_of_load * load;
    }

  private:
    Eigen::MatrixXd                                stress_of_l;
    Eigen::Matrix<double, Eigen::Dynamic, dim + 1> F_of_load, stress_of_load;
    Eigen::Matrix<double, dim + 1, dim + 1>        constant_of_load;
  };



  /// int sigma : C^{-1} sigma over a simplex of the given area or volume, C
  /// that of the material.
  template <int dim>
  double
  complementary_energy(const LinearStress<dim> &stress,
                       const double             measure,
                       const Material          &material);
} // namespace Debond

#endif
