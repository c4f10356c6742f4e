// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/equilibrium_element.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace Debond
{
  namespace
  {
    using Corners = std::vector<dealii::Point<2>>;

    /// The stresses of a triangle in the order of EquilibriumElement::stress().
    constexpr int stresses_of_a_triangle = 9;

    int
    stress_index(const int triangle, const int corner, const int component)
    {
      return stresses_of_a_triangle * triangle + 3 * corner + component;
    }



    dealii::Tensor<1, 2>
    turned(const dealii::Tensor<1, 2> &vector)
    {
      return dealii::Tensor<1, 2>({vector[1], -vector[0]});
    }



    /// Adds @p weight times the traction sigma n at a corner to two rows.
    void
    add_traction(const int                   triangle,
                 const int                   corner,
                 const dealii::Tensor<1, 2> &normal,
                 const double                weight,
                 const int                   row,
                 Eigen::MatrixXd            &matrix)
    {
      matrix(row, stress_index(triangle, corner, 0)) += weight * normal[0];
      matrix(row, stress_index(triangle, corner, 2)) += weight * normal[1];
      matrix(row + 1, stress_index(triangle, corner, 2)) += weight * normal[0];
      matrix(row + 1, stress_index(triangle, corner, 1)) += weight * normal[1];
    }



    dealii::Point<2>
    mean(const Corners &corners)
    {
      dealii::Point<2> sum;
      for (const dealii::Point<2> &corner : corners)
        sum += corner;
      return dealii::Point<2>(sum / static_cast<double>(corners.size()));
    }



    /// A basis of the stresses with continuous tractions and no divergence, in
    /// columns.
    Eigen::MatrixXd
    divergence_free(const Corners &corners)
    {
      const int              n      = static_cast<int>(corners.size());
      const dealii::Point<2> centre = mean(corners);
      Eigen::MatrixXd        conditions =
        Eigen::MatrixXd::Zero(6 * n, stresses_of_a_triangle * n);
      for (int i = 0; i < n; ++i)
        {
          // Between the triangles before and after corner i.
          const dealii::Tensor<1, 2> normal   = turned(corners[i] - centre);
          const int                  previous = (i + n - 1) % n;
          add_traction(i, 0, normal, 1., 6 * i, conditions);
          add_traction(previous, 1, normal, -1., 6 * i, conditions);
          add_traction(i, 2, normal, 1., 6 * i + 2, conditions);
          add_traction(previous, 2, normal, -1., 6 * i + 2, conditions);

          // Twice the area times the gradients are the turned opposite edges.
          const dealii::Point<2> next = corners[(i + 1) % n];
          add_traction(i, 0, turned(centre - next), 1., 6 * i + 4, conditions);
          add_traction(
            i, 1, turned(corners[i] - centre), 1., 6 * i + 4, conditions);
          add_traction(
            i, 2, turned(next - corners[i]), 1., 6 * i + 4, conditions);
        }
      // The null space is what is orthogonal to the range of the transpose.
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
        conditions.transpose());
      const Eigen::MatrixXd Q = qr.matrixQ();
      return Q.rightCols(Q.cols() - qr.rank());
    }



    /// The basis of a polygon that is the affine image of a reference polygon:
    /// x = a + B y maps sigma to B sigma B', which keeps tractions continuous
    /// and the divergence zero.
    Eigen::MatrixXd
    mapped_basis(const Corners &corners)
    {
      static const Eigen::MatrixXd triangle =
        divergence_free({{0., 0.}, {1., 0.}, {0., 1.}});
      static const Eigen::MatrixXd square =
        divergence_free({{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}});

      const dealii::Tensor<1, 2> x = corners[1] - corners[0];
      const dealii::Tensor<1, 2> y = corners.back() - corners[0];
      // Without it the basis would grow with the size of the cell.
      const double    scale = 1. / (x * x + y * y);
      Eigen::Matrix3d map;
      map << x[0] * x[0], y[0] * y[0], 2. * x[0] * y[0], //
        x[1] * x[1], y[1] * y[1], 2. * x[1] * y[1],      //
        x[0] * x[1], y[0] * y[1], x[0] * y[1] + y[0] * x[1];
      map *= scale;
      Eigen::MatrixXd basis = corners.size() == 3 ? triangle : square;
      for (int i = 0; i < basis.rows(); i += 3)
        basis.middleRows<3>(i) = map * basis.middleRows<3>(i).eval();
      return basis;
    }



    /// sigma : C^{-1} sigma for xx, yy and xy.
    Eigen::Matrix3d
    compliance(const Material &material)
    {
      const double    mu      = material.shear_modulus();
      const double    lambda  = material.lame_lambda<2>();
      const double    coupled = lambda / (2. * (lambda + mu));
      Eigen::Matrix3d result;
      result << 1. - coupled, -coupled, 0., //
        -coupled, 1. - coupled, 0.,         //
        0., 0., 2.;
      return result / (2. * mu);
    }



    /// int sigma : C^{-1} sigma of linear stresses of a triangle.
    Eigen::Matrix<double, 9, 9>
    compliance_matrix(const double area, const Material &material)
    {
      const Eigen::Matrix3d       pointwise = compliance(material);
      Eigen::Matrix<double, 9, 9> result;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          result.block<3, 3>(3 * i, 3 * j) =
            area / (i == j ? 6. : 12.) * pointwise;
      return result;
    }



    double
    triangle_area(const dealii::Point<2> &a,
                  const dealii::Point<2> &b,
                  const dealii::Point<2> &c)
    {
      return 0.5 * (turned(b - a) * (a - c));
    }
  } // namespace



  double
  complementary_energy(const Eigen::Matrix<double, 9, 1> &stress,
                       const double                       area,
                       const Material                    &material)
  {
    return stress.dot(compliance_matrix(area, material) * stress);
  }



  EquilibriumElement::EquilibriumElement(
    const std::vector<dealii::Point<2>> &corners,
    const Material                      &material,
    const dealii::Tensor<1, 2>          &body_force,
    const double                         thermal_stress)
    : corners(corners)
    , centre(mean(corners))
    , area(0.)
  {
    const int n          = static_cast<int>(corners.size());
    const int n_stresses = stresses_of_a_triangle * n;

    // Moments of the tractions on the sides, and the flexibility.
    Eigen::MatrixXd T = Eigen::MatrixXd::Zero(4 * n, n_stresses);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n_stresses, n_stresses);
    // A stress with the given divergence, and the thermal stress.
    Eigen::VectorXd balance = Eigen::VectorXd::Zero(n_stresses);
    Eigen::VectorXd thermal = Eigen::VectorXd::Zero(n_stresses);
    for (int i = 0; i < n; ++i)
      {
        const dealii::Point<2> &a = corners[i];
        const dealii::Point<2> &b = corners[(i + 1) % n];
        // As long as the side.
        const dealii::Tensor<1, 2> normal = turned(b - a);
        add_traction(i, 0, normal, 0.5, 4 * i, T);
        add_traction(i, 1, normal, 0.5, 4 * i, T);
        add_traction(i, 0, normal, -1. / 6., 4 * i + 2, T);
        add_traction(i, 1, normal, 1. / 6., 4 * i + 2, T);

        const double part = triangle_area(a, b, centre);
        area += part;
        M.block<9, 9>(stresses_of_a_triangle * i, stresses_of_a_triangle * i) =
          compliance_matrix(part, material);

        const dealii::Point<2> points[] = {a, b, centre};
        for (int corner = 0; corner < 3; ++corner)
          for (int d = 0; d < 2; ++d)
            {
              const int k = stress_index(i, corner, d);
              balance(k)  = -body_force[d] * (points[corner] - centre)[d];
              thermal(k)  = thermal_stress;
            }
      }

    const Eigen::MatrixXd             Z = mapped_basis(corners);
    const Eigen::LLT<Eigen::MatrixXd> factor(Z.transpose() * M * Z);
    const Eigen::VectorXd             given   = balance + thermal;
    const Eigen::VectorXd             b       = Z.transpose() * (M * given);
    const Eigen::VectorXd             lifting = factor.solve(b);

    const Eigen::MatrixXd B = T * Z;
    const Eigen::MatrixXd Y = factor.matrixL().solve(B.transpose());
    K                       = Y.transpose() * Y;
    F                       = B * lifting - T * balance;
    constant                = 0.5 * b.dot(lifting) - 0.5 * given.dot(M * given);
    to_stress               = Z * factor.solve(B.transpose());
    particular              = balance - Z * lifting;
  }



  EquilibriumElement
  EquilibriumElement::moved_to(
    const std::vector<dealii::Point<2>> &other_corners) const
  {
    EquilibriumElement result = *this;
    result.corners            = other_corners;
    result.centre             = mean(other_corners);
    return result;
  }



  Eigen::VectorXd
  EquilibriumElement::stress(const Eigen::VectorXd &displacements,
                             const double           weight) const
  {
    return weight * (to_stress * displacements) + particular;
  }
} // namespace Debond
