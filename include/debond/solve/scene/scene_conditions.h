// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_scene_scene_conditions_h
#define debond_solve_scene_scene_conditions_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/unknowns.h>
#include <debond/input/problem_parameters.h>
#include <debond/mesh/by_region.h>

namespace Debond
{
  /// Returns what is clamped and in contact, on a mesh whose pieces have these
  /// names. Throws EntryError, also if bodies at an interface are not in
  /// contact.
  BoundaryConditions
  make_conditions(const ProblemParameters &given, const PieceNames &names);

  /// Throws EntryError if regions with materials of their own overlap.
  ByRegion<Material>
  make_materials(const MaterialParameters &parameters,
                 const RegionNames        &regions);

  /// Prescribed displacements and gaps. Throws EntryError.
  template <int dim>
  Supports<dim>
  make_supports(const ProblemParameters  &given,
                const BoundaryConditions &conditions);

  /// The bonds that vary. Throws EntryError.
  template <int dim>
  std::unique_ptr<BondField<dim>>
  make_bond_field(const ProblemParameters  &given,
                  const AdhesiveLaw        &law,
                  const BoundaryConditions &conditions);

  /// Empty without friction. Throws EntryError.
  template <int dim>
  Friction
  make_friction(const ProblemParameters    &given,
                const BoundaryConditions   &conditions,
                const ContactBoundary<dim> &boundary);

  /// Returns the factors of prescribed displacements at all steps.
  std::vector<double>
  displacement_factors(const LoadPathParameters &load_path);

  /// Throws SupportError if a support pushes a vertex into the foundation.
  template <int dim>
  void
  check_held_vertices(const ElasticUnknowns<dim> &unknowns,
                      const std::vector<double>  &load_factors);
} // namespace Debond

#endif
