// SPDX-License-Identifier: LGPL-2.1-or-later
// Mutations of the shipped studies and benchmarks: each is rejected with the
// entry or the line named, or read, with all its cases and scenes. An argument
// gives the number of cases.

#include <debond/benchmark/benchmark_study.h>
#include <debond/study/cases.h>
#include <debond/study/study_parameters.h>

#include <functional>
#include <iostream>
#include <regex>

#include "../check.h"
#include "../program/mutator.h"

using namespace Debond;
using namespace Fuzz;

namespace
{
  const std::vector<std::string> hostile_values = {
    "",
    "0",
    "-1",
    "1.5",
    "1e308",
    "nan",
    "4294967297",
    "99999999999999999999",
    "true",
    "\"\"",
    "\"x\"",
    "|",
    " | | ",
    "1 | 1",
    "0.1 | nan",
    "geometric 1 10 3",
    "geometric 1 10",
    "geometric 0 10 3",
    "geometric 1 10 -3",
    "geometric 1 10 4000000000",
    "geometric 1 1e400 3",
    "Mesh/Cells",
    "Mesh/Cells=40, 4",
    "Mesh/Cells=40",
    "Mesh/Cells = 40, 4 | Mesh/Cells = 80, 8",
    "Study/Scene=x",
    "Solver/Method",
    "euclidean bundle | energy bundle",
    "{preparation}",
    "{study}",
    "status",
    "status | status",
    "1, 2",
    "2, 1",
    "../benchmark-40x4.prm",
    "..",
    "/",
    "end",
    "#",
    std::string(5000, '|'),
    std::string(5000, '[')};



  struct Counts
  {
    unsigned int rejected = 0, read = 0, unnamed = 0, failed = 0;
  };



  /// Whether an error says where the mistake is: the line, an entry, or for
  /// JSON the place or the key.
  bool
  is_named(const std::string &error)
  {
    static const std::regex named(
      "^[^ ]*fuzz\\.(prm:[0-9]+|json): [^]*|"
      "[^]*(Dimension|[A-Z][A-Za-z ]*/[A-Z][a-z]+|[a-z]\\.prm: )[^]*|"
      "benchmark \"[^]*");
    return std::regex_match(error, named);
  }



  void
  try_case(const std::function<void()> &read, Counts &counts)
  {
    try
      {
        read();
        ++counts.read;
      }
    catch (const BadInput &error)
      {
        ++counts.rejected;
        for (const std::string &line : error.lines)
          if (!is_named(line))
            {
              ++counts.unnamed;
              std::cout << "no entry is named: " << line << '\n';
            }
      }
    catch (const std::exception &error)
      {
        ++counts.failed;
        std::cout << "exception " << error.what() << "\nin the case\n"
                  << current_case;
      }
  }



  /// Runs @p read on mutations of the texts.
  void
  fuzz(const std::string              &what,
       const std::vector<std::string> &texts,
       const unsigned int              n_cases,
       const std::function<void()>    &read)
  {
    Mutator mutator(hostile_values);
    Counts  counts;
    for (unsigned int k = 0; k < n_cases; ++k)
      {
        current_case = mutator(texts[mutator.below(texts.size())]);
        alarm(seconds_for_a_case);
        try_case(read, counts);
        alarm(0);
      }
    std::cout << what << ": failures: " << counts.failed
              << ", rejections that name nothing: " << counts.unnamed
              << ", some of each: "
              << verdict(counts.rejected > 0 && counts.read > 0) << '\n';
    if (print_figures)
      std::cout << n_cases << " cases: " << counts.rejected << " rejected, "
                << counts.read << " read\n";
  }
} // namespace



int
main(int argc, char *argv[])
{
  const unsigned int n_cases = argc > 1 ? std::stoul(argv[1]) : 300;
  print_figures              = argc > 1;
  catch_signals();

  const std::filesystem::path prm(SOURCE_DIR "/../../prm");
  fuzz("studies", read_files(prm / "studies", ".prm"), n_cases, [&]() {
    const std::string  file = (prm / "studies" / "fuzz.prm").string();
    StudyTable         table;
    std::istringstream input(current_case);
    table.read(input, file);
    make_cases(table.parameters(file));
  });
  fuzz("benchmarks", read_files(prm / "benchmarks", ".prm"), n_cases, [&]() {
    const std::string  file = (prm / "benchmarks" / "fuzz.prm").string();
    BenchmarkTable     table;
    std::istringstream input(current_case);
    table.read(input, file);
    for (const BenchmarkScene &scene : table.benchmark(file).scenes)
      scene.parameters();
  });
}
