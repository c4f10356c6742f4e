// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_parameters_h
#define debond_input_parameters_h

#include <debond/input/accuracy_parameters.h>
#include <debond/input/bad_input.h>
#include <debond/input/output_parameters.h>
#include <debond/input/problem_parameters.h>
#include <debond/input/solver_parameters.h>
#include <debond/mesh/make_body.h>

namespace Debond
{
  /// A scene: the problem, and what each module is given.
  struct Parameters : ProblemParameters
  {
    SolverParameters       solver;
    AccuracyParameters     accuracy;
    VerificationParameters verification;
    OutputParameters       output;

    /// The scene with all entries that it leaves to their defaults.
    std::string effective_scene;

    /// Notes for the user on what is odd in the scene.
    std::vector<std::string> notes;
  };



  /// Entries of what comes after a run, which the scene itself does not need.
  class CompanionEntries
  {
  public:
    virtual ~CompanionEntries() = default;

    virtual void
    bind(ParameterTable &table) = 0;

    /// Refuses what does not go together with the scene, and tells the scene
    /// what it has to know of it.
    virtual void
    check(Parameters &parameters, ParameterTable &table) const = 0;
  };



  /**
   * The table of all entries of a scene, with the paper's benchmark on the mesh
   * 40x4 as defaults.
   */
  class SceneTable : public ParameterTable
  {
  public:
    /// Keeps a pointer to the entries of a companion.
    explicit SceneTable(CompanionEntries *companion = nullptr);

    /// Gives the variables the values that have been read, with those of
    /// constants. Throws BadInput if a constant has none; other errors are
    /// left in the table.
    void
    evaluate();

    /// Returns the values of what has been read, @p scene being the path of its
    /// file. Throws BadInput with the errors of the table and those of values
    /// that do not fit together.
    Parameters
    parameters(const std::string &scene);

    /// Returns whether the log may say what depends on the machine.
    bool
    has_machine_details() const
    {
      return p.output.machine_details;
    }

  private:
    CompanionEntries                  *companion;
    Parameters                         p;
    BodyParameters                     body;
    std::map<std::string, std::string> constants, parts; ///< texts by name
    std::set<std::string>              unused_constants;
    LawSection                         laws;
  };

  /// Reads the file @p scene over the values that the table has. Throws
  /// BadInput if the file cannot be read at all; errors in it are left in the
  /// table.
  void
  read_scene(const std::string &scene, ParameterTable &table);
} // namespace Debond

#endif
