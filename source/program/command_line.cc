// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/multithread_info.h>

#include <debond/base/blas_threads.h>
#include <debond/base/processes.h>
#include <debond/base/version.h>
#include <debond/linear_algebra/elimination_factor.h>
#include <debond/program/command_line.h>
#include <debond/program/run.h>

#include <boost/program_options.hpp>

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <new>

namespace Debond
{
  namespace
  {
    namespace po = boost::program_options;

    const char *const usage =
      "Usage: debond SCENE.prm... [OPTIONS]\n"
      "\n"
      "Solves the unilateral contact of an elastic body with an adhesive\n"
      "foundation as the scene describes it. Several scenes are solved one\n"
      "after the other, whatever becomes of the others, and the last lines\n"
      "say how each has ended; each needs an output directory of its own. The\n"
      "exit code is then that of the first one that is no success.\n\n";

    const char *const exit_codes =
      "\nExit codes:\n"
      "  0  success, or the body comes off, see the status in summary.json\n"
      "  1  internal error\n"
      "  2  bad input: command line or scene; nothing is written,\n"
      "     unless only the solve shows it\n"
      "  3  not converged: the stop criterion or the verification was not met\n"
      "  4  interrupted by SIGINT or SIGTERM; the last iterate is written if\n"
      "     there is one\n"
      "  5  the output could not be written, or another run writes to its "
      "directory\n";



    po::options_description
    visible_options()
    {
      // These are the texts of --help; parse() adds the scenes, which have no
      // name there. The JSON form of --print-parameters is an option of its
      // own, whose name contains the '='. The empty comments keep each option
      // on lines of its own.
      po::options_description options("Options");
      options.add_options()                              //
        ("help", "print this text")                      //
        ("version", "print versions and the build type") //
        ("print-parameters",
         "print all parameters with their documentation as a scene, with the "
         "defaults or the values of SCENE.prm and --set") //
        ("print-parameters=json",
         "likewise as JSON, for editors and scripts")       //
        ("validate", "read and check the scene, then stop") //
        ("set",
         po::value<std::vector<std::string>>()->value_name(
           "\"SECTION/PARAMETER=VALUE\""),
         "give a parameter another value than the scene; can be repeated") //
        ("restart",
         "go on from the state in the output directory that an earlier run of "
         "the scene left after each load step and mesh, or when it was "
         "interrupted, on any number of ranks");
      return options;
    }



    /// Throws BadInput.
    po::variables_map
    parse(const int                      argc,
          const char *const              argv[],
          const po::options_description &visible)
    {
      // All words without a dash in front of them are scenes, as many as there
      // are and in their order.
      po::options_description all;
      all.add(visible);
      all.add_options()("scene", po::value<std::vector<std::string>>());
      po::positional_options_description positional;
      positional.add("scene", -1);

      // Abbreviations would make every new option a breaking change.
      const int style = po::command_line_style::default_style &
                        ~po::command_line_style::allow_guessing;
      // A study is a scene for another program. Boost's message would only say
      // that it does not know the option.
      if (argc > 1 && std::string(argv[1]) == "--study")
        throw BadInput({"studies are run by scripts/study STUDY.prm"});
      try
        {
          po::variables_map values;
          po::store(po::command_line_parser(argc, argv)
                      .options(all)
                      .positional(positional)
                      .style(style)
                      .extra_parser([](const std::string &word) {
                        // A value could be taken for the scene otherwise.
                        const std::string json = "print-parameters=json";
                        return std::make_pair(word == "--" + json ? json : "",
                                              std::string());
                      })
                      .run(),
                    values);
          po::notify(values);
          return values;
        }
      catch (const po::error &error)
        {
          throw BadInput({std::string(error.what()) + "; see debond --help"});
        }
    }



    /// The options for each scene.
    struct SceneOptions
    {
      const MakeCompanion     &make_companion;
      std::vector<std::string> assignments = {};
      bool                     validate    = false;
      bool                     restart     = false;
    };



    template <int dim>
    ExitCode
    run_or_validate(const Parameters   &parameters,
                    const Companion    &companion,
                    const SceneOptions &options)
    {
      // A launcher of ranks gives them a terminal even if it writes to a file.
      const bool is_on_terminal =
        n_started_ranks() == 1 && isatty(STDOUT_FILENO) == 1;
      if (!options.validate)
        return run<dim>(parameters,
                        companion,
                        std::cout,
                        {is_on_terminal, options.restart});

      // To be valid a scene has to have a mesh, supports, loads and a method
      // that go together, all of which is found out by making it.
      validate<dim>(parameters, companion);
      std::cout << parameters.scene << ": valid" << std::endl;
      return ExitCode::success;
    }



    /// Reads the scene, if there is one, and what --set says. Throws BadInput.
    void
    read_table(const std::string              &scene,
               const std::vector<std::string> &assignments,
               SceneTable                     &table)
    {
      // Assignments come after the file, so that they replace what it says.
      // Values are taken at the end: expressions may use constants that stand
      // further down or in an assignment.
      if (!scene.empty())
        read_scene(scene, table);
      for (const std::string &assignment : assignments)
        table.assign(assignment);
      table.evaluate();
    }



    /// The output directories of scenes that have been read, with the scenes.
    using Directories = std::map<std::filesystem::path, std::string>;

    ExitCode
    execute_scene(const std::string  &scene,
                  const SceneOptions &options,
                  SignalWatch        &watch,
                  Directories        &directories)
    {
      // A table and a companion of its own keep what one scene says from the
      // next one. From begin_run() on a signal belongs to this scene, which has
      // no result yet. That comes before parameters(), which makes the body and
      // may take long; whether progress may be printed is known by then.
      const std::unique_ptr<Companion> companion = options.make_companion();
      SceneTable                       table(companion.get());
      read_table(scene, options.assignments, table);
      watch.begin_run(!table.has_machine_details());
      const Parameters parameters = table.parameters(scene);

      // Two names may mean one directory, by a link or a detour, therefore
      // canonical names are compared. The second scene would replace the
      // results of the first one. It is refused before anything is written; to
      // validate both is harmless.
      const auto [other, is_new] = directories.emplace(
        std::filesystem::weakly_canonical(
          std::filesystem::absolute(parameters.output.directory)),
        scene);
      if (!is_new && !options.validate)
        throw BadInput({scene + ": the output directory " +
                        parameters.output.directory + " is that of " +
                        other->second + " as well; set Output/Directory"});
      return parameters.dimension == 2 ?
               run_or_validate<2>(parameters, *companion, options) :
               run_or_validate<3>(parameters, *companion, options);
    }



    /// Does @p action and returns its exit code. What it throws is reported on
    /// std::cerr: each error of bad input, too little memory, and faults of the
    /// program. Of ranks that throw together one speaks for all; what happens
    /// to one alone ends them all.
    ExitCode
    guard(const std::function<ExitCode()> &action)
    {
      // An exception of any other kind than the three below is a fault of the
      // program. Matrices that are not positive definite and too little memory
      // count as bad input: another scene, or the same with fewer cells, can be
      // solved by the same program. A message of several lines, one for each
      // error of a scene, is printed line by line.
      ExitCode                 code = ExitCode::internal_error;
      std::vector<std::string> lines;
      bool                     is_own = true;
      try
        {
          return action();
        }
      catch (const BadInput &error)
        {
          lines = error.lines;
          code  = ExitCode::bad_input;
        }
      catch (const IndefiniteMatrix &error)
        {
          lines = {error.what()};
          code  = ExitCode::bad_input;
        }
      catch (const std::bad_alloc &)
        {
          lines = {"there is not enough memory for this scene; try fewer cells "
                   "or a smaller bundle"};
          code  = ExitCode::bad_input;
        }
      catch (const std::exception &error)
        {
          is_own = dynamic_cast<const ErrorElsewhere *>(&error) == nullptr;
          lines  = {std::string("internal error: ") + error.what()};
        }
      // If all ranks have thrown, the first one with an error of its own
      // prints, and all return its exit code. If only some have, the others
      // wait for a message that never comes. end_together() notices that after
      // some seconds and has no value; then this rank prints what it knows and
      // ends all of them.
      const std::optional<EndOfRanks> end =
        end_together(is_own, static_cast<int>(code));
      if (!end || end->is_speaker)
        for (const std::string &line : lines)
          print_error(line);
      if (!end)
        end_all_ranks(static_cast<int>(code));
      return static_cast<ExitCode>(end->exit_code);
    }



    ExitCode
    execute_scenes(const std::vector<std::string> &scenes,
                   const SceneOptions             &options,
                   SignalWatch                    &watch)
    {
      // Each scene is on its own: an error in one is reported, and the next one
      // is solved. Two that write to one directory would destroy each other's
      // results.
      Directories           directories;
      std::vector<ExitCode> codes;
      for (const std::string &scene : scenes)
        {
          // After a signal the remaining scenes are not begun, and count as
          // interrupted. requested() agrees with the other ranks, so that all
          // of them skip the same scenes.
          if (scenes.size() > 1)
            std::cout << (codes.empty() ? "" : "\n") << "== " << scene
                      << std::endl;
          codes.push_back(
            Interruption::by_signal().requested() ?
              ExitCode::interrupted :
              guard([&]() {
                return execute_scene(scene, options, watch, directories);
              }));
        }

      // The exit code of several scenes is that of the first that is no
      // success; the table says which.
      ExitCode first_failure = ExitCode::success;
      if (scenes.size() > 1)
        std::cout << "\nexit code  scene\n";
      for (unsigned int i = 0; i < scenes.size(); ++i)
        {
          if (scenes.size() > 1)
            std::cout << std::setw(9) << static_cast<int>(codes[i]) << "  "
                      << scenes[i] << std::endl;
          if (first_failure == ExitCode::success)
            first_failure = codes[i];
        }
      return first_failure;
    }



    ExitCode
    execute(const int            argc,
            const char *const    argv[],
            const MakeCompanion &make_companion,
            SignalWatch         &watch)
    {
      // What ends without a scene comes first: whoever asks for help gets it
      // whatever else is on the line, as long as the line can be parsed.
      const po::options_description visible = visible_options();
      const po::variables_map       values  = parse(argc, argv, visible);
      if (values.count("help") > 0)
        {
          std::cout << usage << visible << exit_codes;
          return ExitCode::success;
        }
      if (values.count("version") > 0)
        {
          std::cout << "Debond " << version.program << "\nrevision "
                    << version.revision << "\ndeal.II " << version.deal_ii
                    << "\nbuild type " << version.build_type << std::endl;
          return ExitCode::success;
        }

      std::vector<std::string> scenes;
      if (values.count("scene") > 0)
        scenes = values["scene"].as<std::vector<std::string>>();
      SceneOptions options{make_companion};
      if (values.count("set") > 0)
        options.assignments = values["set"].as<std::vector<std::string>>();
      options.validate = values.count("validate") > 0;
      options.restart  = values.count("restart") > 0;

      // The table is read as for a run, but parameters() is not called: no mesh
      // is made, and entries are checked one by one and not against each other.
      // A table with errors is not printed, since a rejected entry has its
      // default there and the print would not be what the scene says.
      const bool as_json = values.count("print-parameters=json") > 0;
      if (values.count("print-parameters") > 0 || as_json)
        {
          if (scenes.size() > 1)
            throw BadInput({"--print-parameters is for one scene"});
          const std::unique_ptr<Companion> companion = make_companion();
          SceneTable                       table(companion.get());
          read_table(scenes.empty() ? "" : scenes[0],
                     options.assignments,
                     table);
          if (!table.errors.empty())
            throw BadInput(table.errors);
          if (as_json)
            table.print_json(std::cout);
          else
            table.print(std::cout, true);
          return ExitCode::success;
        }
      if (scenes.empty())
        throw BadInput({"no scene is given; see debond --help"});
      // An assignment without --set in front of it counts as the name of a
      // scene. That such a file does not exist is true, but does not say what
      // is wrong.
      for (const std::string &scene : scenes)
        if (scene.find('=') != std::string::npos &&
            !std::filesystem::exists(scene))
          throw BadInput({"there is no scene " + scene +
                          "; an entry is given by --set \"" + scene + "\""});
      return execute_scenes(scenes, options, watch);
    }
  } // namespace



  ExitCode
  execute_command_line(const int            argc,
                       const char *const    argv[],
                       const MakeCompanion &make_companion)
  {
    // The problem is solved on one core; more threads of deal.II's vector
    // operations would only change rounding.
    dealii::MultithreadInfo::set_thread_limit(1);
    use_one_blas_thread_by_default();
    // Signals are watched before MPI starts, since libraries that start with it
    // install handlers of their own and start_mpi() restores those that it
    // finds. A process that was started alone does without MPI until a solver
    // needs it.
    SignalWatch watch(std::cout, static_cast<int>(ExitCode::interrupted));
    if (n_started_ranks() > 1)
      start_mpi();
    // The first rank alone prints; the others run the same code with a stream
    // that takes nothing.
    if (!is_first_rank())
      std::cout.setstate(std::ios::failbit);
    // This guard is for errors of the command line. In execute_scenes() each
    // scene has one of its own, so that an error there does not keep the next
    // scene from being solved.
    const ExitCode code =
      guard([&]() { return execute(argc, argv, make_companion, watch); });
    end_mpi();
    return code;
  }
} // namespace Debond
