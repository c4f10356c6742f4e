// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/append.h>
#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/program/run_output.h>
#include <debond/solve/minimum/displacement.h>

#include <filesystem>

namespace Debond
{
  std::string
  state_file(const std::string &directory)
  {
    return (std::filesystem::path(directory) / "restart.state").string();
  }



  template <int dim>
  RunOutput<dim>::RunOutput(const Parameters        &parameters,
                            const Scene<dim>        &scene,
                            const RunCompanion<dim> &companion,
                            const RunState<dim>     *begun)
    : effective_scene(parameters.effective_scene)
    , output(parameters.output)
    , companion(companion)
  {
    // The first rank holds the lock for all of them. If it does not get it the
    // others throw its error too, instead of waiting for the first rank in the
    // next collective call.
    on_all_ranks(scene.ranks(), [this]() {
      if (is_first_rank())
        lock = std::make_unique<DirectoryLock>(output.directory);
    });
    // The lock comes before anything is removed: another run may be writing to
    // this directory.
    begin_path(scene);
    // Only the names of these files are needed, for which any result will do.
    // They are removed whether this run writes them or not: a file that the
    // scene no longer asks for would otherwise look like one of its results.
    // The files of steps stay if the run continues after steps.
    remove_files(files(scene, {}), output.directory);
    remove_files({{"summary.json", {}, {}}}, output.directory);
    if (begun == nullptr || begun->path.steps.empty())
      path_output->remove_steps();
    // An old state would otherwise be taken up by a later --restart that means
    // this run.
    if (begun == nullptr)
      remove_files({{"restart.state", {}, {}}}, output.directory);
    written.push_back(path("parameters.prm"));
    write_atomically(written.back(),
                     [&](std::ostream &file) { file << effective_scene; });
  }



  template <int dim>
  void
  RunOutput<dim>::begin_path(const Scene<dim>                     &scene,
                             const std::vector<LoadPathStep<dim>> &done)
  {
    // The new object knows of no steps; those that are done are given to it so
    // that the records for ParaView and load_path.csv have them as well.
    path_output.emplace(output, scene.problem());
    if (!done.empty())
      path_output->go_on_after(done);
  }



  template <int dim>
  void
  RunOutput<dim>::begin_mesh(const Scene<dim> &scene)
  {
    // Steps are numbered from 1 on each mesh, and the new path may be shorter,
    // so that old files would remain beside the new ones.
    begin_path(scene);
    path_output->remove_steps();
  }



  template <int dim>
  void
  RunOutput<dim>::add(const PathProgress<dim> &path,
                      const Verification<dim> &verification)
  {
    path_output->add(path.steps.back(), path.u, verification);
  }



  template <int dim>
  void
  RunOutput<dim>::save(const Answer<dim> &answer)
  {
    // The effective scene has all entries with their values. A later run
    // compares them with its own to see whether the state belongs to it.
    RunState<dim> state = {effective_scene,
                           mesh_checksum(*answer.scene),
                           answer.meshes,
                           answer.path};
    // Displacements in the file have the order of one rank.
    for (DofVector *const u : displacements_of(state))
      *u = in_serial_order(answer.scene->problem().unknowns(), *u);
    attempt([&]() {
      write_state(state, state_file(output.directory));
      has_state = true;
    });
  }



  template <int dim>
  void
  RunOutput<dim>::withdraw()
  {
    // The rank that holds the lock removes the files for all of them. The state
    // is on the list whether or not it was saved, for it is no error to remove
    // what is not there.
    if (!lock)
      return;
    remove_files(path_output->files({}, {}), output.directory);
    path_output->remove_steps();
    written.push_back(state_file(output.directory));
    // An exception here would hide the error that is the reason.
    std::error_code error;
    for (const std::string &file : written)
      std::filesystem::remove(file, error);
    lock->withdraw();
  }



  template <int dim>
  bool
  RunOutput<dim>::write(const RunResult<dim> &result)
  {
    // The first file that cannot be written ends the list. Those before it are
    // complete, stay, and are listed in the log; there is no summary then, and
    // the exit code is 5.
    return attempt([&]() {
      write_files(files(*result.scene, result), output.directory, written);
    });
  }



  template <int dim>
  void
  RunOutput<dim>::write_summary(const Record &record)
  {
    attempt([&]() {
      record.write(path("summary.json"));
      written.push_back(path("summary.json"));
    });
  }



  template <int dim>
  std::vector<std::string>
  RunOutput<dim>::files_written() const
  {
    std::vector<std::string> all = written;
    if (has_state)
      all.push_back(state_file(output.directory));
    return all;
  }



  template <int dim>
  std::string
  RunOutput<dim>::path(const std::string &name) const
  {
    return (std::filesystem::path(output.directory) / name).string();
  }



  template <int dim>
  std::vector<OutputFile>
  RunOutput<dim>::files(const Scene<dim> &scene, const RunResult<dim> &result)
  {
    // The order is that in which files are written: what every scene has, then
    // the tables and records of the path, then what the companion adds. The
    // summary is in no list, because it comes after all of them.
    std::vector<OutputFile> all = output_files(output, scene, result);
    append(path_output->files(result.path.steps, result.arc), all);
    append(companion.files(output, scene), all);
    return all;
  }



  template <int dim>
  template <typename Action>
  bool
  RunOutput<dim>::attempt(const Action &action)
  {
    // write_atomically() throws on all ranks alike, so that all of them return
    // the same value here.
    try
      {
        action();
        return true;
      }
    catch (const std::runtime_error &error)
      {
        message = error.what();
        return false;
      }
  }



  DEBOND_INSTANTIATE_CLASS(RunOutput);
} // namespace Debond
