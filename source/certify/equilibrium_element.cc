// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/certify/equilibrium_element.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>

namespace Debond
{
  namespace
  {
    template <int dim>
    using Corners = std::vector<dealii::Point<dim>>;

    template <int dim>
    constexpr int n_stress_components =
      dealii::SymmetricTensor<2, dim>::n_independent_components;

    /// The stresses of a simplex.
    template <int dim>
    constexpr int n_of_simplex = LinearStress<dim>::RowsAtCompileTime;

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
    stress_index(const int simplex, const int corner, const int component)
    {
      return n_of_simplex<dim> * simplex + n_stress_components<dim> * corner +
             component;
    }



    dealii::Tensor<1, 2>
    turned(const dealii::Tensor<1, 2> &vector)
    {
      return dealii::Tensor<1, 2>({vector[1], -vector[0]});
    }



    /// Adds @p weight times the traction sigma n at a corner to dim rows.
    template <int dim>
    void
    add_traction(const int                     simplex,
                 const int                     corner,
                 const dealii::Tensor<1, dim> &normal,
                 const double                  weight,
                 const int                     row,
                 Eigen::MatrixXd              &matrix)
    {
      for (int k = 0; k < n_stress_components<dim>; ++k)
        {
          const auto [a, b] = row_and_column<dim>(k);
          const int column  = stress_index<dim>(simplex, corner, k);
          matrix(row + a, column) += weight * normal[b];
          if (a != b)
            matrix(row + b, column) += weight * normal[a];
        }
    }



    template <int dim>
    dealii::Point<dim>
    mean(const Corners<dim> &corners)
    {
      dealii::Point<dim> sum;
      for (const dealii::Point<dim> &corner : corners)
        sum += corner;
      return dealii::Point<dim>(sum / static_cast<double>(corners.size()));
    }



    /// The corners of the simplex above a side: those of the side, the centre.
    template <int dim>
    std::array<dealii::Point<dim>, dim + 1>
    simplex_above(const Corners<dim>       &corners,
                  const dealii::Point<dim> &centre,
                  const int                 side)
    {
      const auto local =
        corners_of_side<dim>(static_cast<unsigned int>(corners.size()),
                             static_cast<unsigned int>(side));
      std::array<dealii::Point<dim>, dim + 1> result;
      for (unsigned int k = 0; k < dim; ++k)
        result[k] = corners[local[k]];
      result[dim] = centre;
      return result;
    }



    /// Adds the divergence of a simplex, up to a factor, to dim rows.
    template <int dim>
    void
    add_divergence(const int                                      simplex,
                   const std::array<dealii::Point<dim>, dim + 1> &points,
                   const int                                      row,
                   Eigen::MatrixXd                               &matrix)
    {
      // The gradients of the barycentric coordinates are normals of the
      // opposite sides.
      for (unsigned int k = 0; k <= dim; ++k)
        {
          std::array<dealii::Point<dim>, dim> side;
          if constexpr (dim == 2)
            side = {{points[(k + 1) % 3], points[(k + 2) % 3]}};
          else
            {
              const auto local = corners_of_side<dim>(4, k);
              for (unsigned int i = 0; i < dim; ++i)
                side[i] = points[local[i]];
            }
          add_traction<dim>(simplex,
                            static_cast<int>(k),
                            scaled_normal<dim>(side),
                            1.,
                            row,
                            matrix);
        }
    }



    /// What is zero for stresses with continuous tractions and no divergence.
    Eigen::MatrixXd
    equilibrium_conditions(const Corners<2> &corners)
    {
      const int              n      = static_cast<int>(corners.size());
      const dealii::Point<2> centre = mean(corners);
      Eigen::MatrixXd        result =
        Eigen::MatrixXd::Zero(6 * n, n_of_simplex<2> * n);
      for (int i = 0; i < n; ++i)
        {
          // Between the triangles before and after corner i.
          const dealii::Tensor<1, 2> normal   = turned(corners[i] - centre);
          const int                  previous = (i + n - 1) % n;
          add_traction(i, 0, normal, 1., 6 * i, result);
          add_traction(previous, 1, normal, -1., 6 * i, result);
          add_traction(i, 2, normal, 1., 6 * i + 2, result);
          add_traction(previous, 2, normal, -1., 6 * i + 2, result);
          add_divergence(i,
                         simplex_above(corners, centre, i),
                         6 * i + 4,
                         result);
        }
      return result;
    }



    Eigen::MatrixXd
    equilibrium_conditions(const Corners<3> &corners)
    {
      const dealii::Point<3> centre = mean(corners);
      Eigen::MatrixXd result = Eigen::MatrixXd::Zero(66, 4 * n_of_simplex<3>);
      int             row    = 0;
      for (int i = 0; i < 4; ++i)
        {
          add_divergence(i, simplex_above(corners, centre, i), row, result);
          row += 3;
          // Between the tetrahedra above the faces i and j, two corners of
          // which are in both, and the centre.
          const auto of_i = corners_of_side<3>(4, static_cast<unsigned int>(i));
          for (int j = 0; j < i; ++j)
            {
              const auto of_j =
                corners_of_side<3>(4, static_cast<unsigned int>(j));
              std::vector<std::array<int, 2>> common = {{{3, 3}}};
              for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                  if (of_i[a] == of_j[b])
                    common.push_back({{a, b}});
              const dealii::Tensor<1, 3> normal =
                scaled_normal<3>({{centre,
                                   corners[of_i[common[1][0]]],
                                   corners[of_i[common[2][0]]]}});
              for (const auto &[a, b] : common)
                {
                  add_traction(i, a, normal, 1., row, result);
                  add_traction(j, b, normal, -1., row, result);
                  row += 3;
                }
            }
        }
      return result;
    }



    /// A basis of the stresses with continuous tractions and no divergence, in
    /// columns.
    template <int dim>
    Eigen::MatrixXd
    divergence_free(const Corners<dim> &corners)
    {
      // The null space is what is orthogonal to the range of the transpose.
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(
        equilibrium_conditions(corners).transpose());
      const Eigen::MatrixXd Q = qr.matrixQ();
      return Q.rightCols(Q.cols() - qr.rank());
    }



    Eigen::MatrixXd
    reference_basis(const Corners<2> &corners)
    {
      static const Eigen::MatrixXd triangle =
        divergence_free<2>({{0., 0.}, {1., 0.}, {0., 1.}});
      static const Eigen::MatrixXd square =
        divergence_free<2>({{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}});
      return corners.size() == 3 ? triangle : square;
    }



    Eigen::MatrixXd
    reference_basis(const Corners<3> &)
    {
      static const Eigen::MatrixXd tetrahedron = divergence_free<3>(
        {{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}});
      return tetrahedron;
    }



    /// The basis of a cell that is the affine image of a reference cell:
    /// x = a + B y maps sigma to B sigma B', which keeps tractions continuous
    /// and the divergence zero.
    template <int dim>
    Eigen::MatrixXd
    mapped_basis(const Corners<dim> &corners)
    {
      dealii::Tensor<2, dim> B;
      double                 scale = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const dealii::Tensor<1, dim> edge =
            (d + 1 == dim ? corners.back() : corners[d + 1]) - corners[0];
          for (unsigned int e = 0; e < dim; ++e)
            B[e][d] = edge[e];
          scale += edge * edge;
        }
      using Map = Eigen::
        Matrix<double, n_stress_components<dim>, n_stress_components<dim>>;
      Map map;
      for (int k = 0; k < n_stress_components<dim>; ++k)
        for (int l = 0; l < n_stress_components<dim>; ++l)
          {
            const auto [a, b] = row_and_column<dim>(k);
            const auto [p, q] = row_and_column<dim>(l);
            map(k, l)         = B[a][p] * B[b][q];
            if (p != q)
              map(k, l) += B[a][q] * B[b][p];
          }
      // Without it the basis would grow with the size of the cell.
      map *= 1. / scale;
      Eigen::MatrixXd basis = reference_basis(corners);
      for (int i = 0; i < basis.rows(); i += n_stress_components<dim>)
        basis.middleRows<n_stress_components<dim>>(i) =
          map * basis.middleRows<n_stress_components<dim>>(i).eval();
      return basis;
    }



    /// sigma : C^{-1} sigma.
    template <int dim>
    Eigen::Matrix<double, n_stress_components<dim>, n_stress_components<dim>>
    compliance(const Material &material)
    {
      const double mu      = material.shear_modulus();
      const double lambda  = material.lame_lambda<dim>();
      const double coupled = lambda / (dim * lambda + 2. * mu);
      Eigen::Matrix<double, n_stress_components<dim>, n_stress_components<dim>>
        result;
      result.setZero();
      for (int k = 0; k < n_stress_components<dim>; ++k)
        for (int l = 0; l < n_stress_components<dim>; ++l)
          if (k < dim && l < dim)
            result(k, l) = k == l ? 1. - coupled : -coupled;
          else if (k == l)
            result(k, l) = 2.;
      return result / (2. * mu);
    }



    /// int sigma : C^{-1} sigma of linear stresses of a simplex.
    template <int dim>
    Eigen::Matrix<double, n_of_simplex<dim>, n_of_simplex<dim>>
    compliance_matrix(const double measure, const Material &material)
    {
      constexpr int n         = n_stress_components<dim>;
      const auto    pointwise = compliance<dim>(material);
      Eigen::Matrix<double, n_of_simplex<dim>, n_of_simplex<dim>> result;
      for (int i = 0; i <= dim; ++i)
        for (int j = 0; j <= dim; ++j)
          result.template block<n, n>(n * i, n * j) =
            measure / ((dim + 1) * (dim + 2) / (i == j ? 2. : 1.)) * pointwise;
      return result;
    }



    /// The value at a corner of a side of the function that the k-th vector of
    /// a side's unknowns is the moment with, times the weight of the corner.
    template <int dim>
    double
    moment_weight(const int k, const int corner)
    {
      if (dim == 3)
        return k == corner ? 1. / 3. : 0.;
      if (k == 0)
        return 0.5;
      return corner == 0 ? -1. / 6. : 1. / 6.;
    }
  } // namespace



  template <int dim>
  std::array<unsigned int, dim>
  corners_of_side(const unsigned int n_corners, const unsigned int side)
  {
    if constexpr (dim == 2)
      return {{side, (side + 1) % n_corners}};
    else
      {
        constexpr std::array<std::array<unsigned int, 3>, 4> faces = {
          {{{1, 2, 3}}, {{0, 3, 2}}, {{0, 1, 3}}, {{0, 2, 1}}}};
        return faces[side];
      }
  }



  template <int dim>
  dealii::Tensor<1, dim>
  scaled_normal(const std::array<dealii::Point<dim>, dim> &side)
  {
    if constexpr (dim == 2)
      return turned(side[1] - side[0]);
    else
      return 0.5 *
             dealii::cross_product_3d(side[1] - side[0], side[2] - side[0]);
  }



  template <int dim>
  double
  complementary_energy(const LinearStress<dim> &stress,
                       const double             measure,
                       const Material          &material)
  {
    constexpr int n       = n_stress_components<dim>;
    const double  mu      = material.shear_modulus();
    const double  lambda  = material.lame_lambda<dim>();
    const double  coupled = lambda / (dim * lambda + 2. * mu);
    // 2 mu sigma : C^{-1} sigma.
    const auto density = [coupled](const auto &sigma) {
      const double trace = sigma.template head<dim>().sum();
      return sigma.squaredNorm() +
             sigma.template tail<n - dim>().squaredNorm() -
             coupled * trace * trace;
    };
    Eigen::Matrix<double, n, 1> sum = Eigen::Matrix<double, n, 1>::Zero();
    double                      own = 0.;
    for (int corner = 0; corner <= dim; ++corner)
      {
        const auto sigma = stress.template segment<n>(n * corner);
        sum += sigma;
        own += density(sigma);
      }
    return measure / ((dim + 1) * (dim + 2)) * (own + density(sum)) / (2. * mu);
  }



  template <int dim>
  class EquilibriumElement<dim>::Shape
  {
  public:
    Shape(const std::vector<dealii::Point<dim>> &corners,
          const Material                        &material);

    double          measure;
    Eigen::MatrixXd K;
    Eigen::MatrixXd to_stress; ///< stress without loads for l

    /// For loads of 1: F, and the stress for l = 0. The constant is a quadratic
    /// form.
    Eigen::Matrix<double, Eigen::Dynamic, dim + 1> F;
    Eigen::Matrix<double, Eigen::Dynamic, dim + 1> particular;
    Eigen::Matrix<double, dim + 1, dim + 1>        constant;
  };



  template <int dim>
  EquilibriumElement<dim>::Shape::Shape(
    const std::vector<dealii::Point<dim>> &corners,
    const Material                        &material)
    : measure(0.)
  {
    const int                n          = static_cast<int>(corners.size());
    const int                n_stresses = n_of_simplex<dim> * n;
    const dealii::Point<dim> centre     = mean(corners);

    // Moments of the tractions on the sides, and the flexibility.
    Eigen::MatrixXd T =
      Eigen::MatrixXd::Zero(unknowns_of_a_side * n, n_stresses);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n_stresses, n_stresses);
    // Stresses with a divergence of -1 in each direction, and the thermal one.
    Eigen::Matrix<double, Eigen::Dynamic, dim + 1> balance, given;
    balance.setZero(n_stresses, dim + 1);
    given.setZero(n_stresses, dim + 1);
    for (int i = 0; i < n; ++i)
      {
        const auto points = simplex_above(corners, centre, i);
        std::array<dealii::Point<dim>, dim> side;
        std::copy_n(points.begin(), dim, side.begin());
        const dealii::Tensor<1, dim> normal = scaled_normal<dim>(side);
        for (int k = 0; k < dim; ++k)
          for (int corner = 0; corner < dim; ++corner)
            add_traction(i,
                         corner,
                         normal,
                         moment_weight<dim>(k, corner),
                         unknowns_of_a_side * i + dim * k,
                         T);

        const double part = normal * (side[0] - centre) / dim;
        measure += part;
        M.block<n_of_simplex<dim>, n_of_simplex<dim>>(n_of_simplex<dim> * i,
                                                      n_of_simplex<dim> * i) =
          compliance_matrix<dim>(part, material);

        for (int corner = 0; corner <= dim; ++corner)
          for (int d = 0; d < dim; ++d)
            {
              const int k   = stress_index<dim>(i, corner, d);
              balance(k, d) = -(points[corner] - centre)[d];
              given(k, dim) = 1.;
            }
      }
    given += balance;

    const Eigen::MatrixXd             Z = mapped_basis(corners);
    const Eigen::LLT<Eigen::MatrixXd> factor(Z.transpose() * M * Z);
    const Eigen::MatrixXd             b       = Z.transpose() * (M * given);
    const Eigen::MatrixXd             lifting = factor.solve(b);

    const Eigen::MatrixXd B = T * Z;
    const Eigen::MatrixXd Y = factor.matrixL().solve(B.transpose());
    K                       = Y.transpose() * Y;
    F                       = B * lifting - T * balance;
    constant =
      0.5 * (b.transpose() * lifting) - 0.5 * (given.transpose() * M * given);
    to_stress  = Z * factor.solve(B.transpose());
    particular = balance - Z * lifting;
  }



  template <int dim>
  std::shared_ptr<const typename EquilibriumElement<dim>::Shape>
  EquilibriumElement<dim>::make_shape(
    const std::vector<dealii::Point<dim>> &corners,
    const Material                        &material)
  {
    return std::make_shared<const Shape>(corners, material);
  }



  template <int dim>
  EquilibriumElement<dim>::EquilibriumElement(
    const std::vector<dealii::Point<dim>> &corners,
    const std::shared_ptr<const Shape>    &shape,
    const dealii::Tensor<1, dim>          &body_force,
    const double                           thermal_stress)
    : corners(corners)
    , centre(mean(corners))
    , measure(shape->measure)
    , shape(shape)
  {
    for (unsigned int d = 0; d < dim; ++d)
      load(d) = body_force[d];
    load(dim) = thermal_stress;
  }



  template <int dim>
  const Eigen::MatrixXd &
  EquilibriumElement<dim>::K() const
  {
    return shape->K;
  }



  template <int dim>
  Eigen::VectorXd
  EquilibriumElement<dim>::F() const
  {
    return shape->F * load;
  }



  template <int dim>
  double
  EquilibriumElement<dim>::constant() const
  {
    return load.dot(shape->constant * load);
  }



  template <int dim>
  Eigen::VectorXd
  EquilibriumElement<dim>::stress(const Eigen::VectorXd &displacements,
                                  const double           weight) const
  {
    return weight * (shape->to_stress * displacements) +
           shape->particular * load;
  }



  template decltype(corners_of_side<2>)      corners_of_side<2>;
  template decltype(corners_of_side<3>)      corners_of_side<3>;
  template decltype(scaled_normal<2>)        scaled_normal<2>;
  template decltype(scaled_normal<3>)        scaled_normal<3>;
  template decltype(complementary_energy<2>) complementary_energy<2>;
  template decltype(complementary_energy<3>) complementary_energy<3>;
  template struct EquilibriumElement<2>;
  template struct EquilibriumElement<3>;
} // namespace Debond
