// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_boundary_conditions_h
#define debond_elasticity_boundary_conditions_h

#include <deal.II/base/function.h>
#include <deal.II/base/types.h>

#include <debond/mesh/body.h>
#include <debond/mesh/symmetry.h>

#include <algorithm>

namespace Debond
{
  /// What holds of the displacement along the contact boundary.
  enum class TangentialDisplacement
  {
    fixed, ///< the paper's simplification (7), u_tau = 0
    free,  ///< sigma_tau = 0
    bonded ///< bonds shear
  };



  /// The boundaries where something is prescribed, by their ids.
  struct BoundaryConditions
  {
    std::set<dealii::types::boundary_id> clamped; ///< Gamma_D, u = 0
    std::set<dealii::types::boundary_id> contact; ///< Gamma_C

    /// On all of Gamma_C but the boundaries that have their own below.
    TangentialDisplacement tangential_displacement =
      TangentialDisplacement::fixed;

    /// The names that messages and reactions use.
    BoundaryNames names = {};

    Symmetry symmetry = Symmetry::none;

    /// The contact boundaries that are sides of interfaces between bodies.
    std::set<dealii::types::boundary_id> low_sides  = {};
    std::set<dealii::types::boundary_id> high_sides = {};

    struct Interface
    {
      std::string                          name;
      std::set<dealii::types::boundary_id> high, low;
    };
    std::vector<Interface> interfaces = {};

    std::map<dealii::types::boundary_id, TangentialDisplacement>
      own_tangential_displacements = {};

    /// The contact boundaries with friction.
    std::set<dealii::types::boundary_id> with_friction = {};

    TangentialDisplacement
    tangential(const dealii::types::boundary_id id) const
    {
      const auto own = own_tangential_displacements.find(id);
      return own == own_tangential_displacements.end() ?
               tangential_displacement :
               own->second;
    }

    /// Returns whether bonds shear on some contact boundary.
    bool
    has_shear() const
    {
      return std::any_of(contact.begin(),
                         contact.end(),
                         [this](const dealii::types::boundary_id id) {
                           return tangential(id) ==
                                  TangentialDisplacement::bonded;
                         });
    }

    /// Returns whether bonds or friction depend on the displacement along this
    /// contact boundary.
    bool
    has_tangents(const dealii::types::boundary_id id) const
    {
      return with_friction.count(id) > 0 ||
             tangential(id) == TangentialDisplacement::bonded;
    }

    /// Returns whether the tangential displacement is fixed on this contact
    /// boundary.
    bool
    fixes_tangential(const dealii::types::boundary_id id) const
    {
      return tangential(id) == TangentialDisplacement::fixed;
    }
  };



  /// A displacement that is prescribed on a piece of the boundary; clamps are
  /// none.
  template <int dim>
  struct PrescribedDisplacement
  {
    std::string                          name; ///< of the piece
    std::set<dealii::types::boundary_id> boundaries;

    /// The normal displacement alone is zero, on a flat piece (a roller, or a
    /// plane of symmetry); otherwise these Cartesian components have values.
    bool                                         is_roller  = false;
    std::array<bool, dim>                        components = {};
    std::shared_ptr<const dealii::Function<dim>> values     = {};
  };



  /// A function of the place on contact boundaries.
  template <int dim>
  struct FoundationField
  {
    std::string name; ///< of the boundary; empty if it is that of all others
    std::shared_ptr<const dealii::Function<dim>> value;
  };



  template <int dim>
  struct Supports
  {
    std::vector<PrescribedDisplacement<dim>> displacements = {};

    using FoundationFields =
      std::map<dealii::types::boundary_id, FoundationField<dim>>;

    /// The distances g >= 0 between the body at rest and the foundation, of the
    /// contact boundaries that have one. Where they meet the least holds.
    FoundationFields gaps = {};

    /// The directions, out of the body, along which u_nu, gap and bonds are
    /// where that is not the body's own normal.
    FoundationFields normals = {};
  };



  /// A prescribed displacement or a gap that cannot be.
  class SupportError : public EntryError
  {
  public:
    enum class Subject
    {
      displacement,
      roller,
      gap
    };

    SupportError(const Subject      subject,
                 const std::string &name,
                 const std::string &message)
      : EntryError(subject == Subject::roller ?
                     "Boundary conditions/Roller boundaries" :
                   subject == Subject::displacement ?
                     "Boundary conditions/Displacement " + name :
                   name.empty() ? "Contact law/Initial gap" :
                                  "Contact law/Initial gap " + name,
                   message)
      , name(name)
    {}

    const std::string name; ///< of the piece of the boundary
  };
} // namespace Debond

#endif
