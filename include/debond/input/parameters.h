// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_parameters_h
#define debond_input_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>
#include <debond/elasticity/material.h>
#include <debond/input/load_parameters.h>
#include <debond/input/load_path_parameters.h>
#include <debond/mesh/body.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace Debond
{
  /// A command line or a scene that cannot be used: one line an error.
  class BadInput : public std::invalid_argument
  {
  public:
    explicit BadInput(const std::vector<std::string> &errors);

    const std::vector<std::string> lines;
  };



  struct OutputParameters
  {
    std::string directory;
    bool        body_vtu         = true;
    bool        contact_vtu      = true;
    bool        contact_profile  = true;
    bool        history          = true;
    bool        displacement     = false;
    bool        path_plots       = true;
    bool        path_body_vtu    = false;
    bool        path_contact_vtu = true;
    bool        machine_details  = true;
  };



  /// How much a better minimum is searched for.
  enum class BondSearchChoice
  {
    automatic, ///< what it takes if the method is automatic, else none
    none,
    quick,
    full
  };



  /// The proof's tolerance is relative to what the bonds can change in J.
  inline BranchAndBoundParameters
  proof_defaults()
  {
    BranchAndBoundParameters parameters;
    parameters.tolerance       = 1e-9;
    parameters.maximum_seconds = 600.;
    return parameters;
  }



  /// In the energy norm the method needs few iterations and little choice.
  inline ProximalBundleParameters
  energy_bundle_defaults()
  {
    ProximalBundleParameters parameters;
    parameters.epsilon_s          = 1e-13;
    parameters.bundle_size        = 50;
    parameters.maximum_iterations = 1000;
    return parameters;
  }



  /// A scene: what each module is given.
  struct Parameters
  {
    std::string                            scene; ///< path of the file
    unsigned int                           dimension = 2;
    std::shared_ptr<const BodyDescription> body;
    Material                               material;
    std::set<std::string>                  clamped_boundaries;
    std::set<std::string>                  contact_boundaries;
    bool                                   tangential_displacement_fixed = true;
    LoadParameters                         loads;
    LoadPathParameters                     load_path;
    ContactLawParameters                   law;
    ContactQuadratureParameters            quadrature;
    std::string                            quadrature_name;
    std::string                            method;
    std::string                            linear_solver;
    double                   memory_limit = 0.; ///< bytes, 0: what is there
    ProximalBundleParameters bundle;

    /// File with the first iterate of the Euclidean bundle; empty for zero.
    std::string start;

    /// epsilon_s relative to the energy of the body without contact; u is
    /// not used.
    ProximalBundleParameters energy_bundle = energy_bundle_defaults();

    MajoriseMinimiseParameters majorise_minimise;
    double                     checkpoint_interval = 0.; ///< s, 0 for none
    bool                       restart = false;          ///< from a checkpoint
    BondSearchChoice           search  = BondSearchChoice::automatic;
    BranchSearchParameters     full_search;
    bool                       prove = false;
    BranchAndBoundParameters   proof = proof_defaults();
    OutputParameters           output;

    /// Largest Verification::error() of a result that counts.
    double verification_tolerance = 1e-3;

    /// An expression with the constants of the loads; empty if unknown.
    std::string exact_displacement;

    /// The scene with all entries that it leaves to their defaults.
    std::string effective_scene;

    /// The same by path, and where they were set.
    std::map<std::string, std::string> values, locations;
  };

  /// Declares all entries with defaults (the paper's benchmark on the mesh
  /// 40x4), patterns and documentation.
  void
  declare_parameters(ParameterTable &table);

  /// Reads the file @p scene over the defaults into a table from
  /// declare_parameters(). Throws BadInput if the file cannot be read at all;
  /// errors in it are left in the table.
  void
  read_scene(const std::string &scene, ParameterTable &table);

  /// Takes the values out of the table. Throws BadInput with the errors of the
  /// table and those of values that do not fit together.
  Parameters
  to_parameters(const std::string &scene, ParameterTable &table);
} // namespace Debond

#endif
