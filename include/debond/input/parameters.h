// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_parameters_h
#define debond_input_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/contact/law.h>
#include <debond/contact/quadrature.h>
#include <debond/input/accuracy_parameters.h>
#include <debond/input/certificate_parameters.h>
#include <debond/input/load_parameters.h>
#include <debond/input/load_path_parameters.h>
#include <debond/input/material_parameters.h>
#include <debond/input/output_parameters.h>
#include <debond/input/solver_parameters.h>
#include <debond/input/support_parameters.h>
#include <debond/mesh/make_body.h>

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



  struct VerificationParameters
  {
    /// Largest Verification::error() of a result that counts.
    double tolerance = 1e-3;

    /// An expression with the constants of the loads; empty if unknown.
    std::string exact_displacement;
  };



  /// A scene: what each module is given.
  struct Parameters
  {
    std::string                            scene; ///< path of the file
    unsigned int                           dimension = 2;
    std::shared_ptr<const BodyDescription> body;
    unsigned int                           degree = 1; ///< of displacements
    MaterialParameters                     materials;
    std::set<std::string> clamped_boundaries            = {"left", "right"};
    std::set<std::string> contact_boundaries            = {"bottom"};
    bool                  tangential_displacement_fixed = true;

    /// By the names of contact boundaries: "fixed" or "free".
    std::map<std::string, std::string> tangential_displacements;
    SupportParameters                  supports;
    LoadParameters                     loads;
    LoadPathParameters                 load_path;
    std::map<std::string, std::string> probes; ///< texts by name
    ContactLawParameters               law;
    ContactQuadratureParameters        quadrature;
    std::string                        quadrature_name = "nodal";
    SolverParameters                   solver;
    CheckpointParameters               checkpoints;
    AccuracyParameters                 accuracy;
    VerificationParameters             verification;
    CertificateParameters              certificate;
    OutputParameters                   output;

    /// The scene with all entries that it leaves to their defaults.
    std::string effective_scene;

    /// What is odd in the scene, for its user.
    std::vector<std::string> notes;

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
    Parameters                         p;
    BodyParameters                     body;
    std::map<std::string, std::string> parts; ///< texts by name
    LawSection                         laws;
  };

  /// Reads the file @p scene over the values that the table has. Throws
  /// BadInput if the file cannot be read at all; errors in it are left in the
  /// table.
  void
  read_scene(const std::string &scene, ParameterTable &table);
} // namespace Debond

#endif
