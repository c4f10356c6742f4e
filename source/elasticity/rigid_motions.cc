// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/elasticity/rigid_motions.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace Debond
{
  template <int dim>
  dealii::Tensor<1, dim>
  RigidMotion<dim>::operator()(const dealii::Point<dim> &point) const
  {
    const dealii::Tensor<1, dim> x = point - centre;
    if constexpr (dim == 2)
      return translation + rotation[0] * dealii::Tensor<1, dim>({-x[1], x[0]});
    else
      return translation + dealii::cross_product_3d(rotation, x);
  }



  template <int dim>
  FreeRigidMotions<dim>
  free_rigid_motions(const std::vector<Support<dim>> &supports,
                     const double                     diameter,
                     const std::vector<std::string>  &bodies)
  {
    constexpr unsigned int n_of_body = dim * (dim + 1) / 2;
    using Motions                    = Eigen::VectorXd;
    const unsigned int n_motions =
      n_of_body * static_cast<unsigned int>(bodies.size());

    const char *const axes[] = {"x", "y", "z"};

    dealii::Tensor<1, dim> centre;
    for (const Support<dim> &support : supports)
      centre += support.position / double(supports.size());

    // A side can be much smaller than the body that it holds.
    double spread = 0.;
    for (const Support<dim> &support : supports)
      spread = std::max(spread, (support.position - centre).norm());
    const double length =
      spread > Tolerance::one_support * diameter ? spread : diameter;

    // Gram matrix of the supports' displacements under unit motions; its null
    // space holds the free motions.
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n_motions, n_motions);
    for (const Support<dim> &support : supports)
      {
        const dealii::Tensor<1, dim>  x = (support.position - centre) / length;
        const dealii::Tensor<1, dim> &d = support.direction;

        Motions            row   = Motions::Zero(n_motions);
        const unsigned int first = n_of_body * support.body;
        for (unsigned int i = 0; i < dim; ++i)
          row[first + i] = d[i];
        if constexpr (dim == 2)
          row[first + 2] = d[1] * x[0] - d[0] * x[1];
        else
          {
            const dealii::Tensor<1, 3> moment = dealii::cross_product_3d(x, d);
            for (unsigned int i = 0; i < 3; ++i)
              row[first + 3 + i] = moment[i];
          }
        // Nothing if both are the same, as beside a cut that ends inside.
        if (support.other != dealii::numbers::invalid_unsigned_int)
          row.segment<n_of_body>(n_of_body * support.other) -=
            Motions(row.segment<n_of_body>(first));
        gram += row * row.transpose();
      }

    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
    const double                                         threshold =
      Tolerance::free_motion * static_cast<double>(supports.size());

    Eigen::MatrixXd null_projector =
      Eigen::MatrixXd::Zero(n_motions, n_motions);
    Motions null_vector = Motions::Zero(n_motions);

    FreeRigidMotions<dim> result;
    for (unsigned int k = 0; k < n_motions; ++k)
      if (eigen.eigenvalues()[k] <= threshold)
        {
          null_vector = eigen.eigenvectors().col(k);
          null_projector += null_vector * null_vector.transpose();

          result.motions.emplace_back();
          for (unsigned int first = 0; first < n_motions; first += n_of_body)
            {
              RigidMotion<dim> motion;
              motion.centre = dealii::Point<dim>(centre);
              for (unsigned int d = 0; d < dim; ++d)
                motion.translation[d] = null_vector[first + d];
              for (unsigned int d = dim; d < n_of_body; ++d)
                motion.rotation[d - dim] = null_vector[first + d] / length;
              result.motions.back().push_back(motion);
            }
        }

    std::vector<std::string> pure;
    std::vector<std::string> components;
    for (unsigned int k = 0; k < n_motions; ++k)
      {
        const unsigned int d = k % n_of_body;
        const std::string  name =
          (d < dim ?
             std::string("translation in ") + axes[d] :
             std::string("rotation about ") + axes[dim == 2 ? 2 : d - dim]) +
          bodies[k / n_of_body];
        if (null_projector(k, k) > 1. - Tolerance::pure_motion)
          pure.push_back(name);
        if (std::abs(null_vector[k]) > 0.1)
          components.push_back(name);
      }
    result.names = pure.empty() ? components : pure;
    return result;
  }



  template struct RigidMotion<2>;
  template struct RigidMotion<3>;
  template decltype(free_rigid_motions<2>) free_rigid_motions<2>;
  template decltype(free_rigid_motions<3>) free_rigid_motions<3>;
} // namespace Debond
