// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/certify/equilibrium_element.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <cmath>

namespace Debond
{
  namespace
  {
    template <int dim>
    constexpr int n_stresses = (dim + 1) * n_of_part<dim>;



    /// The row and the column of a component.
    template <int dim>
    std::array<int, 2>
    row_and_column(const int component)
    {
      const auto indices =
        dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(
          component);
      return {{static_cast<int>(indices[0]), static_cast<int>(indices[1])}};
    }



    template <int dim>
    int
    stress_index(const int part, const int corner, const int component)
    {
      return n_of_part<dim> * part + n_stress_components<dim> * corner +
             component;
    }



    template <int dim>
    dealii::Point<dim>
    centroid(const SimplexCorners<dim> &corners)
    {
      dealii::Point<dim> sum;
      for (const dealii::Point<dim> &corner : corners)
        sum += corner / (dim + 1.);
      return sum;
    }



    /// Returns the place of a corner of the simplex among those of the part
    /// above side @p part; dim + 1 for the centroid.
    int
    corner_of_part(const int part, const int corner)
    {
      return corner < part ? corner : corner - 1;
    }



    template <int dim>
    SimplexCorners<dim>
    corners_of_part(const SimplexCorners<dim> &corners, const int part)
    {
      SimplexCorners<dim> result;
      for (int corner = 0; corner <= dim; ++corner)
        if (corner != part)
          result[corner_of_part(part, corner)] = corners[corner];
      result[dim] = centroid<dim>(corners);
      return result;
    }



    /// Adds @p weight times the traction sigma n at a corner of a part to dim
    /// rows.
    template <int dim>
    void
    add_traction(const int                     stress_of_corner,
                 const dealii::Tensor<1, dim> &normal,
                 const double                  weight,
                 const int                     row,
                 Eigen::MatrixXd              &matrix)
    {
      // A component off the diagonal stands in two places of sigma, so that it
      // adds to two components of sigma n.
      for (int k = 0; k < n_stress_components<dim>; ++k)
        {
          const auto [a, b] = row_and_column<dim>(k);
          const int column  = stress_of_corner + k;
          matrix(row + a, column) += weight * normal[b];
          if (a != b)
            matrix(row + b, column) += weight * normal[a];
        }
    }



    /// A basis of the stresses with continuous tractions and no divergence, in
    /// columns.
    template <int dim>
    Eigen::MatrixXd
    divergence_free(const SimplexCorners<dim> &corners)
    {
      // What is zero for them: the divergence in each part, which is the sum of
      // sigma at the corners times the gradients of the barycentric
      // coordinates, normals of the opposite sides; the jump of the traction at
      // the dim corners of the side between two parts. They are independent: 18
      // for the 27 numbers of a triangle, 66 for the 96 of a tetrahedron, which
      // leaves 9 and 30.
      Eigen::MatrixXd conditions =
        Eigen::MatrixXd::Zero(dim * (dim + 1) * (2 + dim * dim) / 2,
                              n_stresses<dim>);
      int        row = 0;
      const auto add = [&](const int                     part,
                           const int                     corner,
                           const dealii::Tensor<1, dim> &normal,
                           const double                  sign) {
        add_traction<dim>(
          stress_index<dim>(part, corner, 0), normal, sign, row, conditions);
      };
      for (int i = 0; i <= dim; ++i)
        {
          // The divergence in part i. The gradient of a barycentric coordinate
          // is the normal of the opposite side but for a factor that all
          // corners of the part share.
          const auto &normals =
            SimplexGeometry<dim>(corners_of_part<dim>(corners, i)).normals;
          for (int corner = 0; corner <= dim; ++corner)
            add(i, corner, normals[corner], 1.);
          row += dim;
          for (int j = 0; j < i; ++j)
            for (int corner = 0; corner <= dim + 1; ++corner)
              if (corner != i && corner != j)
                {
                  // The side between parts i and j is opposite to corner j of
                  // the simplex in part i. Its traction is linear, so that it
                  // is continuous if it is so at its corners: the dim - 1
                  // corners of the simplex that both parts have, and the
                  // centroid.
                  const dealii::Tensor<1, dim> &normal =
                    normals[corner_of_part(i, j)];
                  add(i, corner_of_part(i, corner), normal, 1.);
                  add(j, corner_of_part(j, corner), normal, -1.);
                  row += dim;
                }
        }
      // The null space is what is orthogonal to the range of the transpose.
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
        conditions.transpose());
      const Eigen::MatrixXd Q = qr.matrixQ();
      return Q.rightCols(Q.cols() - qr.rank());
    }



    /// B in x = a + B y from the reference simplex.
    template <int dim>
    dealii::Tensor<2, dim>
    map_from_reference(const std::array<dealii::Point<dim>, dim + 1> &corners)
    {
      dealii::Tensor<2, dim> B;
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < dim; ++e)
          B[e][d] = corners[d + 1][e] - corners[0][e];
      return B;
    }



    /// Makes that basis from the reference simplex: x = a + B y maps sigma to
    /// B sigma B', which keeps tractions continuous and the divergence zero.
    template <int dim>
    Eigen::MatrixXd
    mapped_basis(const SimplexCorners<dim> &corners)
    {
      // The null space is found once for the reference simplex.
      static const Eigen::MatrixXd reference = [] {
        SimplexCorners<dim> unit;
        for (unsigned int d = 0; d < dim; ++d)
          unit[d + 1][d] = 1.;
        return divergence_free<dim>(unit);
      }();
      // B is constant, so that div_x (B sigma B') = B div_y sigma, and a normal
      // becomes B^{-T} n but for its length, so that (B sigma B') B^{-T} n = B
      // sigma n: what is zero or continuous on the reference simplex is so on
      // the cell.
      const dealii::Tensor<2, dim> B = map_from_reference<dim>(corners);
      // Without it the basis would grow with the size of the cell.
      const double scale = B.norm_square();
      using Map          = Eigen::
        Matrix<double, n_stress_components<dim>, n_stress_components<dim>>;
      Map map;
      for (int k = 0; k < n_stress_components<dim>; ++k)
        for (int l = 0; l < n_stress_components<dim>; ++l)
          {
            const auto [a, b] = row_and_column<dim>(k);
            // (B sigma B')_ab = sum_pq B_ap sigma_pq B_bq, where sigma_pq and
            // sigma_qp are one number.
            const auto [p, q] = row_and_column<dim>(l);
            map(k, l)         = B[a][p] * B[b][q] / scale;
            if (p != q)
              map(k, l) += B[a][q] * B[b][p] / scale;
          }
      Eigen::MatrixXd basis(reference.rows(), reference.cols());
      for (int i = 0; i < basis.rows(); i += n_stress_components<dim>)
        basis.middleRows<n_stress_components<dim>>(i) =
          map * reference.middleRows<n_stress_components<dim>>(i);
      return basis;
    }



    /// int sigma : C^{-1} sigma of linear stresses of a simplex.
    template <int dim>
    Eigen::Matrix<double, n_of_part<dim>, n_of_part<dim>>
    compliance_matrix(const double measure, const Material &material)
    {
      constexpr int n       = n_stress_components<dim>;
      const double  mu      = material.shear_modulus();
      const double  lambda  = material.lame_lambda<dim>();
      const double  coupled = lambda / (dim * lambda + 2. * mu);
      // 2 mu C^{-1} at a point, in which shear stresses count twice. The
      // integrals of products of barycentric coordinates come with it below.
      // For an isotropic material 2 mu C^{-1} sigma = sigma - lambda / (dim
      // lambda + 2 mu) tr(sigma) 1, with the lambda of the plane in 2D.
      Eigen::Matrix<double, n, n> pointwise;
      pointwise.setIdentity();
      pointwise.template topLeftCorner<dim, dim>().array() -= coupled;
      pointwise.diagonal().template tail<n - dim>() *= 2.;
      if (material.orthotropy)
        {
          const auto compliance =
            dealii::invert(material.elasticity_tensor<dim>());
          for (int k = 0; k < n; ++k)
            for (int l = 0; l < n; ++l)
              {
                const auto [a, b] = row_and_column<dim>(k);
                const auto [c, d] = row_and_column<dim>(l);
                pointwise(k, l)   = 2. * mu * (k < dim ? 1. : 2.) *
                                  (l < dim ? 1. : 2.) * compliance[a][b][c][d];
              }
        }
      // int lambda_i lambda_j = measure (1 + delta_ij) / ((dim + 1) (dim + 2)).
      Eigen::Matrix<double, n_of_part<dim>, n_of_part<dim>> result;
      for (int i = 0; i <= dim; ++i)
        for (int j = 0; j <= dim; ++j)
          result.template block<n, n>(n * i, n * j) =
            measure / ((dim + 1) * (dim + 2) / (i == j ? 2. : 1.)) / (2. * mu) *
            pointwise;
      return result;
    }
  } // namespace



  template <int dim>
  SimplexGeometry<dim>::SimplexGeometry(const SimplexCorners<dim> &corners)
  {
    const dealii::Tensor<2, dim> B = map_from_reference<dim>(corners);
    measure = std::abs(determinant(B)) / (dim == 2 ? 2. : 6.);
    // The rows are the gradients of the barycentric coordinates. |grad
    // lambda_k| = |side k| / (dim measure), and it points inwards. The normals
    // of a closed surface add up to zero.
    const dealii::Tensor<2, dim> inverse = invert(B);
    for (unsigned int d = 0; d < dim; ++d)
      {
        normals[d + 1] = -dim * measure * inverse[d];
        normals[0] -= normals[d + 1];
      }
  }



  template <int dim>
  double
  complementary_energy(const LinearStress<dim> &stress,
                       const double             measure,
                       const Material          &material)
  {
    return stress.dot(compliance_matrix<dim>(measure, material) * stress);
  }



  template <int dim>
  EquilibriumElement<dim>::EquilibriumElement(
    const SimplexCorners<dim> &corners,
    const Material            &material)
  {
    // The stress is sigma = balance f + Z y: one that is in equilibrium with
    // the body force f, and those without divergence, which leave the tractions
    // continuous. y is the maximiser of the complementary problem for the
    // displacements l of the sides, so that l ends up as the only unknowns.
    constexpr int            n      = n_stresses<dim>;
    const dealii::Point<dim> centre = centroid<dim>(corners);

    // Moments of the tractions on the sides, and the flexibility.
    Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n_unknowns, n);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
    // Stresses with a divergence of -1 in each direction, and the thermal one.
    Eigen::Matrix<double, Eigen::Dynamic, dim + 1> balance, given;
    balance.setZero(n, dim + 1);
    given.setZero(n, dim + 1);
    for (int i = 0; i <= dim; ++i)
      {
        const SimplexCorners<dim>  points = corners_of_part<dim>(corners, i);
        const SimplexGeometry<dim> part(points);
        for (int k = 0; k < dim; ++k)
          // The outer side of a part is opposite to the centroid. Its normal is
          // as long as the side or its area, so that 1 / dim makes the
          // tractions at the corners the work-conjugates of the means w_k.
          add_traction<dim>(stress_index<dim>(i, k, 0),
                            part.normals[dim],
                            1. / dim,
                            dim * (dim * i + k),
                            T);
        M.block<n_of_part<dim>, n_of_part<dim>>(n_of_part<dim> * i,
                                                n_of_part<dim> * i) =
          compliance_matrix<dim>(part.measure, material);
        for (int corner = 0; corner <= dim; ++corner)
          for (int d = 0; d < dim; ++d)
            {
              // sigma_dd = -(x - centre)_d has the divergence -1 in direction
              // d, and is linear on the whole simplex, so that its tractions
              // are continuous. The thermal stress p 1 counts in the energy and
              // not in the equilibrium.
              const int k   = stress_index<dim>(i, corner, d);
              balance(k, d) = -(points[corner] - centre)[d];
              given(k, dim) = 1.;
            }
      }
    given += balance;

    // With the load r = (f, p), given = balance + p 1, and the flexibility M,
    // the stress of least complementary energy less the work on l satisfies
    //
    //     Z'MZ y = (TZ)'l - Z'M given r,
    //
    // from which stiffness K = TZ (Z'MZ)^{-1} (TZ)', force F and energy follow
    // as for a displacement element. K is the product Y'Y with Y = L^{-1} (TZ)'
    // and Z'MZ = LL'.
    const Eigen::MatrixXd             Z = mapped_basis<dim>(corners);
    const Eigen::LLT<Eigen::MatrixXd> factor(Z.transpose() * M * Z);
    const Eigen::MatrixXd             b       = Z.transpose() * (M * given);
    const Eigen::MatrixXd             lifting = factor.solve(b);

    const Eigen::MatrixXd B = T * Z;
    const Eigen::MatrixXd Y = factor.matrixL().solve(B.transpose());
    K                       = Y.transpose() * Y;
    F_of_load               = B * lifting - T * balance;
    constant_of_load =
      0.5 * (b.transpose() * lifting) - 0.5 * (given.transpose() * M * given);
    stress_of_l    = Z * factor.solve(B.transpose());
    stress_of_load = balance - Z * lifting;
  }



  DEBOND_INSTANTIATE_CLASS(SimplexGeometry);
  DEBOND_INSTANTIATE(complementary_energy);
  DEBOND_INSTANTIATE_CLASS(EquilibriumElement);
} // namespace Debond
