// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_parameters_h
#define debond_input_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>
#include <debond/elasticity/material.h>
#include <debond/input/load_parameters.h>
#include <debond/input/load_path_parameters.h>
#include <debond/input/output_parameters.h>
#include <debond/mesh/make_body.h>
#include <debond/optimization/bundle/proximal_bundle.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/majorise_minimise.h>

#include <map>
#include <memory>
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
    std::set<std::string>       clamped_boundaries = {"left", "right"};
    std::set<std::string>       contact_boundaries = {"bottom"};
    bool                        tangential_displacement_fixed = true;
    LoadParameters              loads;
    LoadPathParameters          load_path;
    ContactLawParameters        law;
    ContactQuadratureParameters quadrature;
    std::string                 quadrature_name = "nodal";
    std::string                 method          = "automatic";
    std::string                 linear_solver   = "automatic";
    double                      memory_limit = 0.; ///< bytes, 0: what is there
    ProximalBundleParameters    bundle;

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

    /// The values that have to be the same at a restart, by path.
    std::map<std::string, std::string> values_of_state;

    /// Where entries were set, by path.
    std::map<std::string, std::string> locations;
  };



  /**
   * The table of all entries of a scene, with the paper's benchmark on the mesh
   * 40x4 as defaults.
   */
  class SceneTable : public ParameterTable
  {
  public:
    SceneTable();

    /// The values of what has been read, @p scene being the path of its file.
    /// Throws BadInput with the errors of the table and those of values that
    /// do not fit together.
    Parameters
    parameters(const std::string &scene);

  private:
    Parameters     p;
    BodyParameters body;
    LawSection     laws;
  };

  /// Reads the file @p scene over the values that the table has. Throws
  /// BadInput if the file cannot be read at all; errors in it are left in the
  /// table.
  void
  read_scene(const std::string &scene, ParameterTable &table);
} // namespace Debond

#endif
