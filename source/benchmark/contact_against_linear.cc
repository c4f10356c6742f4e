// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/benchmark/contact_against_linear.h>
#include <debond/benchmark/linear_baselines.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve.h>
#include <debond/study/convergence.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>

namespace Debond
{
  namespace
  {
    template <int dim>
    Job
    contact_job(const MethodChoice     &choice,
                const SolverParameters &solver,
                const Scene<dim>       &scene)
    {
      const auto result = std::make_shared<SolveResult>();
      return {"contact",
              [&choice, &solver, &scene, result] {
                *result = SolveResult();
                *result = solve(choice, solver, scene);
              },
              [result]() -> nlohmann::json {
                return {{"status", to_string(result->status)},
                        {"iterations", result->iterations},
                        {"cg_steps", result->linear_iterations},
                        {"J", result->functional}};
              }};
    }



    template <int dim>
    Job
    linear_job(const std::string &solver, const Scene<dim> &scene)
    {
      const auto result = std::make_shared<LinearSolve>();
      return {solver,
              [&scene, solver, result] {
                *result = LinearSolve();
                *result = solver == "cholesky" ?
                            solve_by_cholesky(scene.problem().matrix(),
                                              scene.problem().load()) :
                            solve_by_multigrid(scene.problem());
              },
              [&scene, result]() -> nlohmann::json {
                return {{"iterations", result->iterations},
                        {"energy", 0.5 * (result->u * scene.problem().load())}};
              }};
    }
  } // namespace



  template <int dim>
  BenchmarkRow
  measure_contact_against_linear(const std::string    &name,
                                 const Parameters     &parameters,
                                 const BenchmarkStudy &study)
  {
    const MethodChoice choice = choose_method(parameters, parameters.solver);

    // The same scene once or twice, as the solvers need its matrix.
    std::map<MatrixStorage, std::unique_ptr<Scene<dim>>> scenes;
    const auto scene = [&](const MatrixStorage storage) -> const Scene<dim> & {
      if (scenes[storage] == nullptr)
        scenes[storage] = std::make_unique<Scene<dim>>(parameters,
                                                       storage,
                                                       parameters.start_file());
      return *scenes[storage];
    };
    const ElasticProblem<dim> &problem =
      scene(matrix_storage(choice)).problem();

    std::vector<Job> jobs = {
      contact_job(choice, parameters.solver, scene(matrix_storage(choice)))};
    for (const std::string &solver : study.linear_solvers)
      jobs.push_back(
        linear_job(solver,
                   scene(solver == "cholesky" ? MatrixStorage::serial :
                                                MatrixStorage::trilinos)));
    for (Job &job : jobs)
      job.name = name + ", " + job.name;
    const auto results = measure_alternating(jobs, study.repetitions);

    BenchmarkRow row;
    row["scene"]    = name;
    row["path"]     = choice.linear_solver + " " + std::to_string(dim) + "D";
    row["method"]   = choice.method;
    row["unknowns"] = problem.unknowns().n_free_dofs();
    row["contact_nodes"] = problem.unknowns().contact().boundary().nodes.size();
    row["status"]        = results[0].front().facts["status"];
    row["iterations"]    = results[0].front().facts["iterations"];
    row["cg_steps"]      = results[0].front().facts["cg_steps"];
    row["J"]             = results[0].front().facts["J"];
    auto linear_results  = results.begin() + 1;
    for (const std::string &solver : study.linear_solvers)
      {
        const auto &linear = *linear_results++;
        add_spread("time_over_" + solver,
                   spread_of_ratios(results[0], linear, &Measurement::seconds),
                   row);
        add_spread("cpu_time_over_" + solver,
                   spread_of_ratios(results[0],
                                    linear,
                                    &Measurement::cpu_seconds),
                   row);
        add_spread("memory_over_" + solver,
                   spread_of_ratios(results[0],
                                    linear,
                                    &Measurement::peak_bytes),
                   row);
        row[solver + "_iterations"] = linear.front().facts["iterations"];
        row[solver + "_energy"]     = linear.front().facts["energy"];
        add_spread(solver + "_seconds",
                   spread(linear, &Measurement::seconds),
                   row);
        add_spread(solver + "_cpu_seconds",
                   spread(linear, &Measurement::cpu_seconds),
                   row);
        add_spread(solver + "_peak_bytes",
                   spread(linear, &Measurement::peak_bytes),
                   row);
      }
    add_spread("seconds", spread(results[0], &Measurement::seconds), row);
    add_spread("cpu_seconds",
               spread(results[0], &Measurement::cpu_seconds),
               row);
    add_spread("first_seconds",
               spread(results[0], &Measurement::first_seconds),
               row);
    add_spread("peak_bytes", spread(results[0], &Measurement::peak_bytes), row);
    return row;
  }



  std::vector<BenchmarkRow>
  fit_growth(const std::vector<BenchmarkRow> &rows, const unsigned int smallest)
  {
    std::vector<std::string> paths;
    for (const BenchmarkRow &row : rows)
      if (std::find(paths.begin(), paths.end(), row["path"]) == paths.end())
        paths.push_back(row["path"]);

    std::vector<BenchmarkRow> result;
    for (const std::string &path : paths)
      {
        std::vector<double> unknowns, seconds, bytes;
        for (const BenchmarkRow &row : rows)
          if (row["path"] == path && row["unknowns"] >= smallest)
            {
              unknowns.push_back(row["unknowns"]);
              seconds.push_back(row["seconds"]);
              bytes.push_back(row["peak_bytes"]);
            }
        const auto time   = fit_power_law(unknowns, seconds);
        const auto memory = fit_power_law(unknowns, bytes);
        if (!time || !memory)
          continue;
        BenchmarkRow row;
        row["path"]            = path;
        row["scenes"]          = unknowns.size();
        row["unknowns_from"]   = static_cast<unsigned int>(unknowns.front());
        row["unknowns_to"]     = static_cast<unsigned int>(unknowns.back());
        row["time_exponent"]   = time->exponent;
        row["memory_exponent"] = memory->exponent;
        result.push_back(row);
      }
    return result;
  }



  template decltype(measure_contact_against_linear<2>)
    measure_contact_against_linear<2>;
  template decltype(measure_contact_against_linear<3>)
    measure_contact_against_linear<3>;
} // namespace Debond
