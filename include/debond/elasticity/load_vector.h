// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_load_vector_h
#define debond_elasticity_load_vector_h

#include <deal.II/base/function.h>
#include <deal.II/base/quadrature.h>
#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>

#include <debond/base/dof_vector.h>
#include <debond/base/entry_error.h>
#include <debond/mesh/symmetry.h>

#include <map>
#include <memory>

namespace Debond
{
  /// A force on a boundary, per area (per length in 2D).
  template <int dim>
  struct Traction
  {
    /// A field with dim components, or with one: a pressure p, whose traction
    /// is -p n.
    std::shared_ptr<const dealii::Function<dim>> value;

    std::string entry = "Loads/Traction"; ///< of the scene

    /// The traction on a face with this outward unit normal. Throws EntryError
    /// with the place if it is not finite there.
    dealii::Tensor<1, dim>
    operator()(const dealii::Point<dim>     &point,
               const dealii::Tensor<1, dim> &normal) const;
  };



  /// The loads f_0 and f_2 in global coordinates.
  template <int dim>
  struct Loads
  {
    /// The force per volume (per area of the plane in 2D), with dim components;
    /// may be null.
    std::shared_ptr<const dealii::Function<dim>> body_force;

    /// By boundary ids; tractions on one boundary add up.
    std::map<dealii::types::boundary_id, std::vector<Traction<dim>>> tractions;

    /// The change from the state without stresses; one component, may be null.
    std::shared_ptr<const dealii::Function<dim>> temperature_change = {};

    /// The sum of the tractions on a boundary, zero if there are none.
    dealii::Tensor<1, dim>
    traction(const dealii::types::boundary_id id,
             const dealii::Point<dim>        &point,
             const dealii::Tensor<1, dim>    &normal) const;

    /// The body force; throws EntryError as tractions do.
    dealii::Tensor<1, dim>
    force_at(const dealii::Point<dim> &point) const;
  };



  /// Gauss' rule on so many equal parts of a face in each direction: of degree
  /// 7 on intervals, of degree 5 on triangles.
  template <int dim>
  dealii::Quadrature<dim - 1>
  face_rule(const unsigned int n_parts);

  /// The number of parts with which tractions are integrated.
  template <int dim>
  constexpr unsigned int parts_of_a_face = dim == 2 ? 8 : 4;



  /**
   * The nodal forces int f_0 phi + int f_2 phi, as Cartesian components at
   * every degree of freedom of @p dof_handler, by face_rule() on each face and
   * for body forces by a rule of degree 2 on each cell, for quadratic
   * displacements more. So a load may jump between faces (between cells);
   * where a traction jumps inside of a face or is not smooth there, such that
   * this costs more than 1e-6 of all tractions of its entry, @p notes get one
   * line that names the worst face.
   *
   * Throws EntryError with the place if a load is not finite at a point of the
   * rules. To be called by all ranks that share the mesh.
   */
  template <int dim>
  DofVector
  load_vector(const dealii::DoFHandler<dim> &dof_handler,
              const Loads<dim>              &loads,
              const Symmetry                 symmetry,
              std::vector<std::string>      *notes = nullptr);
} // namespace Debond

#endif
