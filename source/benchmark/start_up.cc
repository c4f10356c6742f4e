// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/benchmark/start_up.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// Runs a program without its output.
    void
    run_program(std::vector<std::string> arguments)
    {
      std::vector<char *> pointers;
      for (std::string &argument : arguments)
        pointers.push_back(argument.data());
      pointers.push_back(nullptr);

      posix_spawn_file_actions_t actions;
      posix_spawn_file_actions_init(&actions);
      posix_spawn_file_actions_addopen(
        &actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
      pid_t     child;
      const int error = posix_spawn(
        &child, pointers[0], &actions, nullptr, pointers.data(), environ);
      posix_spawn_file_actions_destroy(&actions);
      if (error != 0)
        throw std::runtime_error("cannot start " + arguments[0] + ": " +
                                 std::strerror(error));
      int status = 0;
      waitpid(child, &status, 0);
      if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw std::runtime_error(arguments[0] + " failed");
    }
  } // namespace



  BenchmarkRow
  measure_start_up(const BenchmarkScene &scene,
                   const std::string    &output,
                   const unsigned int    repetitions)
  {
    const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe").parent_path();
    std::vector<std::string> arguments = {(folder / "debond").string(),
                                          scene.scene,
                                          "--set",
                                          "Output/Directory=" + output};
    for (const std::string &setting : scene.settings)
      arguments.insert(arguments.end(), {"--set", setting});

    const auto results = measure_alternating(
      {{"the program on " + scene.name, [&] { run_program(arguments); }, {}},
       {"the empty program",
        [&] { run_program({(folder / "empty_program").string()}); },
        {}}},
      repetitions);

    for (const Measurements &job : results)
      if (!job.error.empty())
        throw std::runtime_error(job.error);
    const auto &of_program = results[0].values, &of_empty = results[1].values;

    BenchmarkRow row;
    row["scene"] = scene.name;
    add_spread("ratio",
               spread_of_ratios(of_program, of_empty, &Measurement::seconds),
               row);
    std::vector<double> differences;
    for (unsigned int r = 0; r < repetitions; ++r)
      differences.push_back(of_program[r].seconds - of_empty[r].seconds);
    add_spread("seconds_above_floor", spread(differences), row);
    add_spread("seconds", spread(of_program, &Measurement::seconds), row);
    add_spread("floor_seconds", spread(of_empty, &Measurement::seconds), row);
    return row;
  }
} // namespace Debond
