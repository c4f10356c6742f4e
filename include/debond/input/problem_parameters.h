// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_problem_parameters_h
#define debond_input_problem_parameters_h

#include <debond/contact/bond_field.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>
#include <debond/elasticity/boundary_conditions.h>
#include <debond/input/load_path_parameters.h>
#include <debond/input/material_parameters.h>

namespace Debond
{
  /// Bonds in shear, where tangential displacements are bonded.
  struct ShearParameters
  {
    /// A number as its text, empty if there is none, and those of boundaries by
    /// their names.
    struct Entry
    {
      std::string                        everywhere;
      std::map<std::string, std::string> boundaries;

      bool
      empty() const
      {
        return everywhere.empty() && boundaries.empty();
      }
    };

    Entry stiffness; ///< without one as along the normal
    Entry strength;  ///< without one it follows from the energies
    Entry energy;    ///< of bonds that break separately or by mode

    bool             breaks_separately = false;
    MixedMode        mixed_mode        = MixedMode::none;
    double           exponent          = 1.; ///< of the mode's formula
    std::string      mixed_mode_text   = "none";
    FailureCriterion criterion         = FailureCriterion::quadratic;

    bool is_somewhere = false; ///< or all are fixed or free
  };



  /// Friction on the contact boundary: expressions.
  struct FrictionParameters
  {
    struct Entry
    {
      std::string                        everywhere; ///< empty without
      std::map<std::string, std::string> boundaries; ///< by their names

      bool
      empty() const
      {
        return everywhere.empty() && boundaries.empty();
      }
    };

    Entry bound; ///< a force per area
    Entry coefficient;
    bool  is_of_damage = false;

    bool
    is_somewhere() const
    {
      return !bound.empty() || !coefficient.empty();
    }
  };



  /// The problem whose least J is looked for: the body with its discretisation,
  /// its materials, what holds and loads it, and its bonds. Nothing about who
  /// finds it, how well and what is written.
  struct ProblemParameters
  {
    std::string                            scene; ///< path of the file
    unsigned int                           dimension = 2;
    Symmetry                               symmetry  = Symmetry::none;
    std::shared_ptr<const BodyDescription> body;
    unsigned int                           degree = 1; ///< of displacements
    MaterialParameters                     materials;
    std::set<std::string>  clamped_boundaries = {"left", "right"};
    std::set<std::string>  contact_boundaries = {"bottom"};
    TangentialDisplacement tangential_displacement =
      TangentialDisplacement::fixed;

    /// Their words by the names of contact boundaries.
    std::map<std::string, std::string> tangential_displacements;
    ShearParameters                    shear;
    FrictionParameters                 friction;
    SupportParameters                  supports;
    LoadParameters                     loads;
    LoadPathParameters                 load_path;
    std::map<std::string, std::string> probes; ///< texts by name
    ContactLawParameters               law;
    ContactQuadratureParameters        quadrature;
    std::string                        quadrature_name = "nodal";

    /// The places where entries were set, by path.
    std::map<std::string, std::string> locations;
  };
} // namespace Debond

#endif
