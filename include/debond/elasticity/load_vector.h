// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_load_vector_h
#define debond_elasticity_load_vector_h

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>

#include <debond/linear_algebra/dof_vector.h>
#include <debond/mesh/body.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace Debond
{
  /// f_0 and f_2, in global coordinates. Functions have dim components.
  template <int dim>
  struct Loads
  {
    /// Force per volume (per area of the plane in 2D); may be null.
    std::shared_ptr<const dealii::Function<dim>> body_force;

    /// Force per area (per length in 2D).
    std::map<dealii::types::boundary_id,
             std::shared_ptr<const dealii::Function<dim>>>
      tractions;

    /// From the state without stresses; one component, may be null.
    std::shared_ptr<const dealii::Function<dim>> temperature_change = {};

    /// For messages.
    BoundaryNames boundary_names = {};

    /// Of whole boundaries, if the mesh is a piece of a larger one, where some
    /// have less of them or none.
    std::map<dealii::types::boundary_id, unsigned int> n_faces = {};
  };



  /// A load that cannot be used.
  class LoadError : public std::invalid_argument
  {
  public:
    LoadError(const std::string                               &message,
              const std::optional<dealii::types::boundary_id> &boundary);

    /// Of the traction; none for a body force.
    const std::optional<dealii::types::boundary_id> boundary;
  };



  /**
   * The nodal forces int f_0 phi + int f_2 phi, as Cartesian components at
   * every degree of freedom of @p dof_handler, whose degree is 1 or 2: phi is a
   * function of the Bernstein basis, see bernstein().
   *
   * Tractions are integrated adaptively on each face: the Gauss-Lobatto rule
   * of degree 5 on intervals that are halved until that changes the integral
   * by less than 1e-13 (1e-11 in 3D, where the rule is applied in both
   * directions) of the face's measure times its largest traction. So a
   * traction may jump anywhere inside of a face. At the edge of a face it is
   * the limit from within that counts. The side is sampled in at least 64
   * intervals in each direction, however coarse the mesh is; a patch of load
   * that is narrower than 0.14 of such an interval can be missed. In 3D a
   * smooth traction on a fine mesh takes 144 evaluations a face, one that jumps
   * along a line in the order of 1e5 on each face the line crosses.
   *
   * Body forces are integrated by a rule of degree 2 on each cell, for
   * quadratic displacements 3 or more: let a jump of theirs follow the mesh.
   * Where the values in a cell differ by a factor of two, it is bisected
   * towards the largest ones, to see whether they grow.
   *
   * Throws LoadError, naming the boundary or the body force, the
   * point and the component, if a load cannot be evaluated, is not finite or is
   * not piecewise smooth; if it grows without bound such that a 1e-10th of a
   * face (of a cell) has more than a thousandth of its load (1/x on a face or
   * in a body, but not 1/sqrt(x); 1/r around a point of a face in 3D is refused
   * as well, although it has an integral); if the number of its components is
   * not dim; and if the mesh has no boundary of that number.
   */
  template <int dim>
  DofVector
  load_vector(const dealii::DoFHandler<dim> &dof_handler,
              const Loads<dim>              &loads);

  /// The means on a face with these corners of a traction times each
  /// barycentric coordinate, integrated as in load_vector(). @p n_faces: of the
  /// side that the face is of.
  template <int dim>
  std::array<dealii::Tensor<1, dim>, dim>
  traction_moments(const dealii::Function<dim>               &traction,
                   const std::array<dealii::Point<dim>, dim> &corners,
                   const unsigned int                         n_faces);
} // namespace Debond

#endif
