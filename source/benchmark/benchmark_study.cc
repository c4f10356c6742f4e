// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/benchmark/benchmark_study.h>
#include <debond/study/cases.h>

#include <boost/algorithm/string/replace.hpp>

namespace Debond
{
  namespace
  {
    const std::set<std::string> known_linear_solvers = {"levels",
                                                        "ml",
                                                        "hypre",
                                                        "cholesky"};
  } // namespace



  Parameters
  BenchmarkScene::parameters() const
  {
    SceneTable table;
    read_scene(scene, table);
    for (const std::string &setting : settings)
      table.assign(setting);
    // No iterations in the log.
    table.assign("Output/Machine details=false");
    return table.parameters(scene);
  }



  BenchmarkTable::BenchmarkTable()
  {
    bind("Benchmark/Linear solvers",
         result.linear_solvers,
         "What solves A u = f beside the contact solve: levels (the cycle of "
         "the contact solve, where the body has levels), ml, hypre, cholesky");
    bind("Benchmark/Repetitions",
         result.repetitions,
         whole_number(1, 1000),
         "How often each time is measured at most",
         "none");
    bind("Benchmark/Seconds",
         result.seconds,
         positive_number(),
         "A case is not repeated once this time is over",
         "s");
    bind("Benchmark/Refined",
         result.is_refined,
         "Whether the cases are one scene on finer and finer meshes, to whose "
         "times and memory powers of the number of unknowns are fitted");
  }



  BenchmarkStudy
  BenchmarkTable::benchmark(const std::string &file)
  {
    const StudyParameters study = parameters(file);
    for (const std::string &name : result.linear_solvers)
      if (known_linear_solvers.count(name) == 0)
        reject("Benchmark/Linear solvers", "there is no solver " + name);
    if (!errors().empty())
      throw BadInput(errors());

    for (const Case &one : make_cases(study).cases)
      {
        // "80, 8" reads "80x8".
        std::string values = join(one.values, " ");
        boost::replace_all(values, ", ", "x");
        result.scenes.push_back(
          {values.empty() ? study.title : study.title + ' ' + values,
           study.scene,
           one.settings});
      }
    return result;
  }
} // namespace Debond
