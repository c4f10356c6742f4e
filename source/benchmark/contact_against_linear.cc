// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
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
                const ElasticProblem<dim> &problem = scene.problem();

                *result = LinearSolve();
                *result =
                  solver == "cholesky" ?
                    solve_by_cholesky(problem.matrix(), problem.load()) :
                  solver == "hypre"  ? solve_by_hypre(problem) :
                  solver == "levels" ? solve_by_levels(scene.body(), problem) :
                                       solve_by_ml(problem);
              },
              [&scene, result]() -> nlohmann::json {
                return {{"iterations", result->iterations},
                        {"energy", 0.5 * (result->u * scene.problem().load())}};
              }};
    }



    void
    add_times(const std::string              &prefix,
              const std::vector<Measurement> &values,
              BenchmarkRow                   &row)
    {
      add_spread(prefix + "seconds",
                 spread(values, &Measurement::seconds),
                 row);
      add_spread(prefix + "cpu_seconds",
                 spread(values, &Measurement::cpu_seconds),
                 row);
      add_spread(prefix + "peak_bytes",
                 spread(values, &Measurement::peak_bytes),
                 row);
    }



    void
    add_ratios(const std::string              &solver,
               const std::vector<Measurement> &contact,
               const std::vector<Measurement> &linear,
               BenchmarkRow                   &row)
    {
      add_spread("time_over_" + solver,
                 spread_of_ratios(contact, linear, &Measurement::seconds),
                 row);
      add_spread("cpu_time_over_" + solver,
                 spread_of_ratios(contact, linear, &Measurement::cpu_seconds),
                 row);
      add_spread("memory_over_" + solver,
                 spread_of_ratios(contact, linear, &Measurement::peak_bytes),
                 row);
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
                                                       parameters.solver.start);
      return *scenes[storage];
    };
    const ElasticProblem<dim> &problem =
      scene(matrix_storage(choice)).problem();

    std::vector<std::string> solvers;
    for (const std::string &solver : study.linear_solvers)
      if (solver != "levels" || parameters.body->has_coarse_levels())
        solvers.push_back(solver);
    std::vector<Job> jobs = {
      contact_job(choice, parameters.solver, scene(matrix_storage(choice)))};
    for (const std::string &solver : solvers)
      jobs.push_back(linear_job(solver,
                                scene(solver == "ml" ? MatrixStorage::trilinos :
                                                       MatrixStorage::serial)));
    for (Job &job : jobs)
      job.name = name + ", " + job.name;
    const auto results =
      measure_alternating(jobs, study.repetitions, study.seconds);

    const unsigned int n_unknowns = problem.unknowns().n_free_dofs();
    BenchmarkRow       row;
    row["scene"]    = name;
    row["path"]     = choice.linear_solver + " " + std::to_string(dim) + "D";
    row["method"]   = choice.method;
    row["unknowns"] = n_unknowns;
    row["contact_nodes"] = problem.unknowns().contact().boundary().nodes.size();
    std::vector<std::string> errors;
    for (const Measurements &job : results)
      if (!job.error.empty())
        errors.push_back(job.error);
    if (!errors.empty())
      row["failed"] = join(errors, "; ");

    const auto &contact = results[0].values;
    if (!contact.empty())
      {
        const auto &facts  = contact.front().facts;
        row["repetitions"] = contact.size();
        row["status"]      = facts["status"];
        row["iterations"]  = facts["iterations"];
        row["cg_steps"]    = facts["cg_steps"];
        row["J"]           = facts["J"];
        row["bytes_per_unknown"] =
          spread(contact, &Measurement::peak_bytes).median / n_unknowns;
      }
    // What anyone would solve A u = f by: not the cycle of the contact solve.
    const std::vector<Measurement> *best = nullptr;
    for (std::size_t k = 0; k < solvers.size(); ++k)
      {
        const std::string &solver = solvers[k];
        const auto        &linear = results[k + 1].values;
        if (linear.empty())
          continue;
        const auto median = [](const std::vector<Measurement> &values) {
          return spread(values, &Measurement::cpu_seconds).median;
        };
        if (solver != "levels" &&
            (best == nullptr || median(linear) < median(*best)))
          {
            best               = &linear;
            row["best_linear"] = solver;
          }
        row[solver + "_iterations"] = linear.front().facts["iterations"];
        row[solver + "_energy"]     = linear.front().facts["energy"];
        add_times(solver + "_", linear, row);
        if (!contact.empty())
          add_ratios(solver, contact, linear, row);
        if (!contact.empty() && solver == "levels" && choice.has_levels)
          row["cycles_over_levels"] = row["cg_steps"].get<double>() /
                                      row["levels_iterations"].get<double>();
      }
    if (!contact.empty())
      {
        if (best != nullptr)
          add_ratios("best", contact, *best, row);
        add_times("", contact, row);
        add_spread("first_seconds",
                   spread(contact, &Measurement::first_seconds),
                   row);
      }
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
