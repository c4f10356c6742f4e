// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_equilibrium_element_h
#define debond_certify_equilibrium_element_h

#include <deal.II/base/point.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/material.h>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <vector>

namespace Debond
{
  /// Linear stresses on a simplex: for each corner the components xx, yy, xy,
  /// in 3D xx, yy, zz, xy, xz, yz.
  template <int dim>
  using LinearStress =
    Eigen::Matrix<double,
                  (dim + 1) *
                    dealii::SymmetricTensor<2, dim>::n_independent_components,
                  1>;



  /**
   * The composite equilibrium element of Fraeijs de Veubeke and of Johnson and
   * Mercier (Numer. Math. 30, 1978), in 3D that of Krizek (Numer. Math. 40,
   * 1982): symmetric stresses that are linear on the simplices between the
   * sides of a cell and its centre, with tractions that are continuous inside.
   * The cell is a triangle or a tetrahedron cut at its centroid, or a
   * parallelogram cut along its diagonals. With the divergence prescribed, 9,
   * 30 or 13 stresses are left, as many as there are linear tractions on the
   * sides in equilibrium.
   *
   * The tractions of all stresses sigma with div sigma + f = 0 are reached by
   * the displacements l of the sides: with the strain that sigma and the
   * thermal stress p make,
   *
   *     max_sigma -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1) + l't(sigma)
   *         = 1/2 l'K l - F'l + constant.
   *
   * Each side has dim^2 numbers in l, component by component of dim vectors. In
   * 2D these are the mean of the displacement and its slope, the coefficient of
   * xi in [-1, 1] from the first to the second end; t are the work-conjugate
   * moments of the traction with 1 and xi. In 3D they are the means of the
   * displacement with the weights 3 lambda_k, lambda the barycentric
   * coordinates of the side; t are a third of its area times the tractions at
   * its corners.
   */
  template <int dim>
  struct EquilibriumElement
  {
    static constexpr int unknowns_of_a_side = dim * dim;

    /// What does not depend on the loads: the same for all cells of a material
    /// that are the same polygon or tetrahedron at different places.
    class Shape;

    /// Of the cell with @p corners, those of a triangle or a parallelogram
    /// counterclockwise, those of a tetrahedron such that its volume is not
    /// negative.
    static std::shared_ptr<const Shape>
    make_shape(const std::vector<dealii::Point<dim>> &corners,
               const Material                        &material);

    /// @p shape: of a cell with @p corners but for a motion without rotation.
    /// @p body_force: constant, force per volume (per area of the plane in 2D).
    /// @p thermal_stress: p, see Material::thermal_stress().
    EquilibriumElement(const std::vector<dealii::Point<dim>> &corners,
                       const std::shared_ptr<const Shape>    &shape,
                       const dealii::Tensor<1, dim>          &body_force,
                       const double                           thermal_stress);

    /// With C made c times as stiff these are c K, F and constant / c.
    const Eigen::MatrixXd &
    K() const;

    Eigen::VectorXd
    F() const;

    double
    constant() const;

    /// The stress that is reached for @p displacements l, with C made @p weight
    /// times as stiff: a LinearStress for each side, of the simplex above it
    /// with the corners of the side and the centre.
    Eigen::VectorXd
    stress(const Eigen::VectorXd &displacements,
           const double           weight = 1.) const;

    std::vector<dealii::Point<dim>> corners;
    dealii::Point<dim>              centre;
    double                          measure; ///< area or volume

  private:
    /// The body force, and p.
    using LoadValues = Eigen::Matrix<double, dim + 1, 1>;

    std::shared_ptr<const Shape> shape;
    LoadValues                   load;
  };



  /// The corners of a side of a cell with @p n_corners: of a polygon the side
  /// from a corner to the next one, of a tetrahedron the face opposite to a
  /// corner, counterclockwise seen from outside.
  template <int dim>
  std::array<unsigned int, dim>
  corners_of_side(const unsigned int n_corners, const unsigned int side);

  /// The outward normal of a side with these corners in the order of
  /// corners_of_side(), as long as its length or area.
  template <int dim>
  dealii::Tensor<1, dim>
  scaled_normal(const std::array<dealii::Point<dim>, dim> &side);

  /// int sigma : C^{-1} sigma over a simplex of the given area or volume, C
  /// that of the material.
  template <int dim>
  double
  complementary_energy(const LinearStress<dim> &stress,
                       const double             measure,
                       const Material          &material);
} // namespace Debond

#endif
