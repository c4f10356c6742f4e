// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/base/version.h>
#include <debond/input/bad_input.h>
#include <debond/solve/run_checkpoints.h>

#include <filesystem>

namespace Debond
{
  namespace
  {
    std::string
    value_of(const CheckpointOrigin &origin, const std::string &name)
    {
      const auto setting = origin.settings.find(name);
      return setting == origin.settings.end() ? "nothing" :
             setting->second.empty()          ? "empty" :
                                                setting->second;
    }
  } // namespace



  RunCheckpoints::RunCheckpoints(const CheckpointParameters &parameters,
                                 const std::string          &directory,
                                 const MethodChoice         &choice)
    : path((std::filesystem::path(directory) / "checkpoint").string())
    , interval(parameters.interval)
    , method_has_states(choice.method != SolverMethod::majorise_minimise)
  {
    origin.settings = parameters.state;
    // What was chosen, not how.
    origin.settings["the method"] = choice.method;
    origin.revision               = git_revision();
    origin.iterations             = 0;
    if (!parameters.restart)
      return;

    if (!method_has_states)
      throw BadInput({"--restart: " + choice.method + " has no checkpoints"});
    try
      {
        reader = std::make_unique<CheckpointReader>(path);
      }
    catch (const std::invalid_argument &error)
      {
        throw BadInput({std::string("--restart: ") + error.what()});
      }
    check_origin(reader->origin());
    is_written = true;
  }



  void
  RunCheckpoints::check_origin(const CheckpointOrigin &found) const
  {
    std::map<std::string, std::string> names = origin.settings;
    names.insert(found.settings.begin(), found.settings.end());
    std::vector<std::string> errors;
    for (const auto &[name, unused] : names)
      if (value_of(found, name) != value_of(origin, name))
        errors.push_back("--restart: the checkpoint " + path +
                         " is of another scene: " + name + " is " +
                         value_of(found, name) + " there and " +
                         value_of(origin, name) + " here");
    if (!errors.empty())
      throw BadInput(errors);
  }



  std::string
  RunCheckpoints::description() const
  {
    if (reader != nullptr)
      return "goes on after iteration " +
             std::to_string(reader->origin().iterations) + " from " + path +
             (reader->origin().revision == origin.revision ?
                "" :
                ", written by revision " + reader->origin().revision);
    if (interval > 0. && !method_has_states)
      return "none: majorise minimise has no states to go on from";
    return "";
  }



  InArchive *
  RunCheckpoints::resume_from()
  {
    return reader != nullptr ? &reader->state() : nullptr;
  }



  void
  RunCheckpoints::offer(const std::function<void(OutArchive &)> &save,
                        const unsigned int                       iterations,
                        const bool                               last)
  {
    if (interval == 0. || (!last && since_last.wall_time() < interval))
      return;
    origin.iterations = iterations;
    try
      {
        write_checkpoint(path, origin, save);
        is_written = true;
        last_error.clear();
      }
    catch (const std::runtime_error &error)
      {
        if (last_error != error.what())
          print_error(std::string(error.what()) +
                      (last ? "" : "; the run goes on"));
        last_error = error.what();
      }
    since_last.restart();
  }



  void
  RunCheckpoints::remove() const
  {
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error))
      std::filesystem::remove(path, error);
  }



  const std::string &
  RunCheckpoints::error() const
  {
    return last_error;
  }



  bool
  RunCheckpoints::written() const
  {
    return is_written;
  }



  const std::string &
  RunCheckpoints::file_name() const
  {
    return path;
  }
} // namespace Debond
