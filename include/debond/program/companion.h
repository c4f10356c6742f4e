// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_companion_h
#define debond_program_companion_h

#include <debond/input/parameters.h>
#include <debond/output/output_files.h>
#include <debond/output/record.h>
#include <debond/solve/meshes/refinement_goal.h>

namespace Debond
{
  /// What comes after a run has solved its scene.
  template <int dim>
  class RunCompanion
  {
  public:
    virtual ~RunCompanion() = default;

    /// Returns what meshes are refined for beside an estimated error; null if
    /// nothing is asked for.
    virtual RefinementGoal<dim> *
    goal() = 0;

    /// Looks at the @p result on the last mesh, to which it may add a note.
    virtual void
    after(RunResult<dim> &result) = 0;

    virtual void
    report(Record &record) const = 0;

    /// Returns the files that it may write, to begin with those that an earlier
    /// run may have left. They keep references.
    virtual std::vector<OutputFile>
    files(const OutputParameters &output, const Scene<dim> &scene) const = 0;
  };



  /// A companion of the program. The core knows it by its entries, and by what
  /// it does with the scene on its first mesh. begin() throws BadInput if the
  /// scene cannot have it.
  class Companion : public CompanionEntries
  {
  public:
    virtual std::unique_ptr<RunCompanion<2>>
    begin(const SolverParameters                &solver,
          const std::shared_ptr<const Scene<2>> &scene) const = 0;

    virtual std::unique_ptr<RunCompanion<3>>
    begin(const SolverParameters                &solver,
          const std::shared_ptr<const Scene<3>> &scene) const = 0;
  };

  /// Makes one for each scene.
  using MakeCompanion = std::function<std::unique_ptr<Companion>()>;
} // namespace Debond

#endif
