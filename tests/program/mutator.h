// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef tests_application_mutator_h
#define tests_application_mutator_h

// Mutations of text files, and the end of a test that one of them crashes.

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace Fuzz
{
#ifdef DEBUG
  constexpr unsigned int seconds_for_a_case = 600; // a tenth of the speed
#else
  constexpr unsigned int seconds_for_a_case = 60;
#endif

  inline std::string current_case;



  /// Only what is allowed in a signal handler.
  extern "C" inline void
  report_signal(const int number)
  {
    const char *const text =
      number == SIGALRM ? "HANG in the case\n" : "CRASH in the case\n";
    ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
    written = write(STDERR_FILENO, current_case.data(), current_case.size());
    _exit(written < 0 ? 2 : 1);
  }



  inline void
  catch_signals()
  {
    for (const int number : {SIGSEGV, SIGFPE, SIGABRT, SIGBUS, SIGILL, SIGALRM})
      std::signal(number, report_signal);
  }



  /// The files in the directory with this ending, in the order of their names.
  inline std::vector<std::string>
  read_files(const std::filesystem::path &directory, const std::string &ending)
  {
    std::vector<std::string> files, texts;
    for (const auto &entry : std::filesystem::directory_iterator(directory))
      if (entry.path().extension() == ending)
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    for (const std::string &file : files)
      {
        std::ostringstream text;
        text << std::ifstream(file).rdbuf();
        texts.push_back(text.str());
      }
    return texts;
  }



  class Mutator
  {
  public:
    /// @p hostile: values that entries may be given.
    explicit Mutator(const std::vector<std::string> &hostile)
      : values(hostile)
    {}

    std::string
    operator()(const std::string &text)
    {
      std::vector<std::string> lines;
      std::istringstream       input(text);
      for (std::string line; std::getline(input, line);)
        lines.push_back(line);
      for (unsigned int k = below(3) + 1; k > 0 && !lines.empty(); --k)
        mutate(lines);
      std::string result;
      for (const std::string &line : lines)
        result += line + '\n';
      return result;
    }

    unsigned int
    below(const unsigned int n)
    {
      return std::uniform_int_distribution<unsigned int>(0, n - 1)(engine);
    }

    std::string
    value()
    {
      return values[below(values.size())];
    }

  private:
    void
    mutate(std::vector<std::string> &lines)
    {
      const unsigned int at   = below(lines.size());
      std::string       &line = lines[at];
      // What a value follows: in a .prm, in JSON.
      const std::size_t equals =
        line.find('=') != std::string::npos ? line.find('=') : line.find(':');
      switch (below(12))
        {
          case 0:
            lines.erase(lines.begin() + at);
            break;
          case 1:
            lines.insert(lines.begin() + at, lines[below(lines.size())]);
            break;
          case 2:
            if (!line.empty())
              line.erase(below(line.size()), 1);
            break;
          case 3:
            line.insert(below(line.size() + 1), 1, char(below(255) + 1));
            break;
          case 4:
            line.resize(below(line.size() + 1));
            break;
          case 5:
            std::swap(line, lines[below(lines.size())]);
            break;
          default:
            if (equals != std::string::npos)
              line = line.substr(0, equals + 2) + value();
        }
    }

    std::vector<std::string> values;
    std::mt19937             engine{20260702};
  };
} // namespace Fuzz

#endif
