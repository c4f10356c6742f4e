// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
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
    // u(x) = t + omega x (x - c), linear in the rotation: displacements are
    // small.
    const dealii::Tensor<1, dim> x = point - centre;
    if constexpr (dim == 2)
      return translation + rotation[0] * dealii::Tensor<1, dim>({-x[1], x[0]});
    else
      return translation + dealii::cross_product_3d(rotation, x);
  }



  namespace
  {
    template <int dim>
    constexpr unsigned int n_of_body = dim *(dim + 1) / 2;



    /// Body by body translations and rotations about the centre, these with a
    /// displacement of one at a distance of `length`.
    template <int dim>
    struct UnitMotions
    {
      dealii::Point<dim> centre;
      double             length;

      /// The sum of the motions of one body with these @p parts.
      RigidMotion<dim>
      sum(const Eigen::VectorXd &parts) const
      {
        // A rotation with the parameter 1 moves a point at the distance
        // `length` by 1. With it translations and rotations are comparable
        // numbers.
        RigidMotion<dim> motion;
        motion.centre = centre;
        for (unsigned int d = 0; d < dim; ++d)
          motion.translation[d] = parts[d];
        for (unsigned int d = dim; d < n_of_body<dim>; ++d)
          motion.rotation[d - dim] = parts[d] / length;
        return motion;
      }

      /// What a support resists of each of @p n motions.
      Eigen::VectorXd
      resisted(const Support<dim> &support, const unsigned int n) const
      {
        // The displacement along the support's direction at its position under
        // each unit motion of its body. A support of a jump holds one body
        // relative to another, whose motions have the opposite sign.
        Eigen::VectorXd row   = Eigen::VectorXd::Zero(n);
        const auto      first = n_of_body<dim> * support.body;
        for (unsigned int k = 0; k < n_of_body<dim>; ++k)
          row[first + k] =
            sum(Eigen::VectorXd::Unit(n_of_body<dim>, k))(support.position) *
            support.direction;
        // Nothing if both are the same, as beside a cut that ends inside.
        if (support.other != dealii::numbers::invalid_unsigned_int)
          row.segment<n_of_body<dim>>(n_of_body<dim> * support.other) -=
            Eigen::VectorXd(row.segment<n_of_body<dim>>(first));
        return row;
      }
    };



    template <int dim>
    std::string
    name_of(const unsigned int motion, const std::vector<std::string> &bodies)
    {
      const char *const  axes[] = {"x", "y", "z"};
      const unsigned int d      = motion % n_of_body<dim>;
      return (d < dim ?
                std::string("translation in ") + axes[d] :
                std::string("rotation about ") + axes[dim == 2 ? 2 : d - dim]) +
             bodies[motion / n_of_body<dim>];
    }
  } // namespace



  template <int dim>
  FreeRigidMotions<dim>
  free_rigid_motions(const std::vector<Support<dim>> &supports,
                     const Symmetry                   symmetry,
                     const double                     diameter,
                     const std::vector<std::string>  &bodies)
  {
    // A motion is free if no support resists it: the null space of the matrix R
    // with a row for each support. It is found from the eigenvectors of R'R,
    // which has 3 or 6 rows for each body however many supports there are. An
    // eigenvalue is the sum of the squared displacements that a unit motion
    // makes at the supports, so that it is compared with their number.
    const unsigned int n =
      n_of_body<dim> * static_cast<unsigned int>(bodies.size());
    dealii::Tensor<1, dim> centre;
    for (const Support<dim> &support : supports)
      centre += support.position / double(supports.size());
    // A side can be much smaller than the body that it holds. Its levers are
    // measured by its own size, so that a rotation that it resists does not
    // look free. Supports at one point have no levers, and the size of the body
    // is taken.
    double spread = 0.;
    for (const Support<dim> &support : supports)
      spread = std::max(spread, (support.position - centre).norm());
    const UnitMotions<dim> motions = {
      dealii::Point<dim>(centre),
      spread > Tolerance::one_support * diameter ? spread : diameter};

    // Gram matrix of the supports' displacements under unit motions; its null
    // space holds the free motions.
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
    for (const Support<dim> &support : supports)
      {
        const Eigen::VectorXd row = motions.resisted(support, n);
        gram += row * row.transpose();
      }
    // The section of a body of revolution moves as a rigid body along its axis
    // only, which is y, the number 1. All other motions are resisted as by more
    // than all supports.
    if (symmetry == Symmetry::axis)
      for (unsigned int k = 0; k < n; ++k)
        if (k % n_of_body<dim> != 1)
          gram(k, k) += 1. + static_cast<double>(supports.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
    const double                                         threshold =
      Tolerance::free_motion * static_cast<double>(supports.size());

    // Of the projector on the null space, and the last vector of its basis.
    Eigen::VectorXd       diagonal = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd       last     = Eigen::VectorXd::Zero(n);
    FreeRigidMotions<dim> result;
    for (unsigned int k = 0; k < n; ++k)
      if (eigen.eigenvalues()[k] <= threshold)
        {
          last = eigen.eigenvectors().col(k);
          // The null space has no preferred basis, but its projector has a
          // diagonal that does not depend on it: the entry k is 1 if the unit
          // motion k is free by itself.
          diagonal += last.cwiseAbs2();
          result.motions.emplace_back();
          for (unsigned int first = 0; first < n; first += n_of_body<dim>)
            result.motions.back().push_back(
              motions.sum(last.segment<n_of_body<dim>>(first)));
        }

    std::vector<std::string> components;
    for (unsigned int k = 0; k < n; ++k)
      {
        // Of several bodies those that nothing holds have one name for all.
        const unsigned int body = k / n_of_body<dim>;
        if (bodies.size() > 1 &&
            diagonal.segment<n_of_body<dim>>(n_of_body<dim> * body).minCoeff() >
              1. - Tolerance::pure_motion)
          {
            if (k % n_of_body<dim> == 0)
              result.names.push_back("all motions" + bodies[body]);
          }
        else if (diagonal[k] > 1. - Tolerance::pure_motion)
          result.names.push_back(name_of<dim>(k, bodies));
        // If no unit motion is free by itself, the message names the ones of
        // which a free motion is composed with more than a tenth.
        if (std::abs(last[k]) > 0.1)
          components.push_back(name_of<dim>(k, bodies));
      }
    if (result.names.empty())
      result.names = components;
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(RigidMotion);
  DEBOND_INSTANTIATE(free_rigid_motions);
} // namespace Debond
