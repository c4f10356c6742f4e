// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_rigid_motions_h
#define debond_elasticity_rigid_motions_h

#include <deal.II/base/tensor.h>

#include <debond/mesh/symmetry.h>

#include <string>
#include <vector>

namespace Debond
{
  /// The component of the displacement along `direction` is zero at
  /// `position`. The direction has length of order one.
  template <int dim>
  struct Support
  {
    dealii::Point<dim>     position;
    dealii::Tensor<1, dim> direction;
    unsigned int           node = 0; ///< that has it

    /// The body that has it, and the one to which the displacement is relative,
    /// if there is one.
    unsigned int body  = 0;
    unsigned int other = dealii::numbers::invalid_unsigned_int;
  };



  /// An infinitesimal rigid motion.
  template <int dim>
  struct RigidMotion
  {
    dealii::Point<dim>     centre;
    dealii::Tensor<1, dim> translation; ///< of the centre

    /// About the centre, about z in 2D.
    dealii::Tensor<1, dim *(dim - 1) / 2> rotation;

    /// The displacement at a point.
    dealii::Tensor<1, dim>
    operator()(const dealii::Point<dim> &point) const;
  };



  template <int dim>
  struct FreeRigidMotions
  {
    /// "translation in y", "rotation about z" (about the supports' centre), or,
    /// if none of these is free by itself, the ones that a free motion is
    /// composed of.
    std::vector<std::string> names = {};

    /// All free motions are combinations of these, of which each has one for
    /// each body.
    std::vector<std::vector<RigidMotion<dim>>> motions = {};
  };



  /// The rigid motions that the supports leave free; none if the body is held.
  /// Lengths are measured in units of @p diameter, the body's size; motions
  /// that the supports resist by less than 1e-6 of full clamping count as free.
  /// A body of revolution has no motion but that along its axis. @p bodies:
  /// where they are, for names; nothing of a single one.
  template <int dim>
  FreeRigidMotions<dim>
  free_rigid_motions(const std::vector<Support<dim>> &supports,
                     const Symmetry                   symmetry,
                     const double                     diameter,
                     const std::vector<std::string>  &bodies = {""});
} // namespace Debond

#endif
