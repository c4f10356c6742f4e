// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_run_output_h
#define debond_program_run_output_h

#include <debond/base/directory_lock.h>
#include <debond/input/parameters.h>
#include <debond/output/load_path_output.h>
#include <debond/program/companion.h>
#include <debond/program/run_state.h>

namespace Debond
{
  /// The file of the directory from which --restart goes on.
  std::string
  state_file(const std::string &directory);

  /**
   * The output directory of a run, which is locked as long as the object
   * exists. What cannot be written does not end a run; error() says what it
   * was. To be used by all ranks.
   */
  template <int dim>
  class RunOutput
  {
  public:
    /// Locks the directory, removes what an earlier run left and writes the
    /// effective scene. What a run needs that goes on after @p begun stays.
    /// Throws std::runtime_error if it cannot. Keeps references.
    RunOutput(const Parameters        &parameters,
              const Scene<dim>        &scene,
              const RunCompanion<dim> &companion,
              const RunState<dim>     *begun);

    /// The next steps of the load path are on this mesh, after those that are
    /// done there.
    void
    begin_path(const Scene<dim>                     &scene,
               const std::vector<LoadPathStep<dim>> &done = {});

    /// The next steps are on a mesh that is to be refined: the files of the
    /// steps before are of another mesh.
    void
    begin_mesh(const Scene<dim> &scene);

    /// Writes the files of the last step.
    void
    add(const PathProgress<dim> &path, const Verification<dim> &verification);

    /// Writes what is done, for --restart.
    void
    save(const Answer<dim> &answer);

    /// Removes all of this run: its scene turned out to be wrong.
    void
    withdraw();

    /// Writes all files but the summary. Returns false if it cannot.
    bool
    write(const RunResult<dim> &result);

    void
    write_summary(const Record &record);

    /// All that this run has written.
    std::vector<std::string>
    files_written() const;

    /// The last thing that could not be written; empty if all could.
    const std::string &
    error() const
    {
      return message;
    }

  private:
    std::string
    path(const std::string &name) const;

    std::vector<OutputFile>
    files(const Scene<dim> &scene, const RunResult<dim> &result);

    /// Does @p action, and notes what it throws. Returns false then.
    template <typename Action>
    bool
    attempt(const Action &action);

    const std::string                 &effective_scene;
    const OutputParameters            &output;
    const RunCompanion<dim>           &companion;
    std::unique_ptr<DirectoryLock>     lock; ///< of the first rank
    std::optional<LoadPathOutput<dim>> path_output;
    std::vector<std::string>           written;
    bool                               has_state = false;
    std::string                        message;
  };
} // namespace Debond

#endif
