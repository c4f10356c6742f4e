// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/parameters.h>
#include <debond/program/ranks.h>
#include <debond/program/report_errors.h>
#include <debond/study/cases.h>
#include <debond/study/command_line.h>
#include <debond/study/reference.h>
#include <debond/study/run_study.h>

#include <boost/program_options.hpp>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <thread>

namespace Debond
{
  namespace
  {
    namespace study_options = boost::program_options;

    const char *const study_usage =
      "Usage: debond --study STUDY.prm [OPTIONS]\n"
      "\n"
      "Runs a scene with several values of its parameters, and compares the\n"
      "results in tables and plots. Interrupted with Ctrl-C, the same command\n"
      "goes on where it stopped.\n\n";

    const char *const study_exit_codes =
      "\nExit codes:\n"
      "  0  success\n"
      "  1  internal error\n"
      "  2  bad input: command line, study or scene; nothing is written\n"
      "  3  a case failed; the others are in the tables\n"
      "  4  interrupted by SIGINT or SIGTERM\n"
      "  5  the output could not be written, or gnuplot failed\n";



    study_options::options_description
    visible_study_options()
    {
      study_options::options_description options("Options");
      options.add_options()("help", "print this text")(
        "jobs",
        study_options::value<unsigned int>()->value_name("N"),
        "cases at a time; as many as there are cores if not given")(
        "print-parameters",
        "print all parameters of a study with their documentation")(
        "validate", "read and check the study and its cases, then stop")(
        "set",
        study_options::value<std::vector<std::string>>()->value_name(
          "\"SECTION/PARAMETER=VALUE\""),
        "give a parameter of the study another value; can be repeated");
      return options;
    }



    /// Throws BadInput.
    study_options::variables_map
    parse_study_options(const int argc, const char *const argv[])
    {
      study_options::options_description all = visible_study_options();
      all.add_options()("study", "")("file",
                                     study_options::value<std::string>());
      study_options::positional_options_description positional;
      positional.add("file", 1);
      const int style = study_options::command_line_style::default_style &
                        ~study_options::command_line_style::allow_guessing;
      try
        {
          study_options::variables_map values;
          study_options::store(study_options::command_line_parser(argc, argv)
                                 .options(all)
                                 .positional(positional)
                                 .style(style)
                                 .run(),
                               values);
          study_options::notify(values);
          return values;
        }
      catch (const study_options::error &error)
        {
          throw BadInput(
            {std::string(error.what()) + "; see debond --study --help"});
        }
    }



    StudyParameters
    read_study(const study_options::variables_map &options)
    {
      if (options.count("file") == 0)
        throw BadInput({"no study is given; see debond --study --help"});
      const std::string file = options["file"].as<std::string>();
      StudyTable        table;
      read_scene(file, table);
      if (options.count("set") > 0)
        for (const std::string &assignment :
             options["set"].as<std::vector<std::string>>())
          table.assign(assignment);
      return table.parameters(file);
    }



    ExitCode
    execute_study(const study_options::variables_map &options)
    {
      if (options.count("help") > 0)
        {
          std::cout << study_usage << visible_study_options()
                    << study_exit_codes;
          return ExitCode::success;
        }
      if (options.count("print-parameters") > 0)
        {
          StudyTable().print(std::cout, true);
          return ExitCode::success;
        }

      const StudyParameters study = read_study(options);
      if (n_started_ranks() > 1)
        throw BadInput({"--study: a study starts its cases itself; use --jobs "
                        "in place of mpirun"});
      if (options.count("validate") > 0)
        {
          const Cases cases = make_cases(study);
          if (!study.reference.file.empty())
            const Reference reference(study.reference);
          std::cout << study.file << ": valid, " << cases.cases.size()
                    << " cases" << std::endl;
          return ExitCode::success;
        }
      const unsigned int jobs = options.count("jobs") > 0 ?
                                  options["jobs"].as<unsigned int>() :
                                  std::thread::hardware_concurrency();
      return run_study(study,
                       std::max(1U, jobs),
                       std::cout,
                       isatty(STDOUT_FILENO) == 1);
    }
  } // namespace



  bool
  is_study_command_line(const int argc, const char *const argv[])
  {
    return argc > 1 && std::string(argv[1]) == "--study";
  }



  ExitCode
  execute_study_command_line(const int argc, const char *const argv[])
  {
    return report_errors("debond", [&]() {
      return execute_study(parse_study_options(argc, argv));
    });
  }
} // namespace Debond
