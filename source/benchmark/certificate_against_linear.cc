// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/benchmark/certificate_against_linear.h>
#include <debond/benchmark/linear_baselines.h>
#include <debond/solve/certificate.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve.h>

#include <memory>
#include <string>

namespace Debond
{
  BenchmarkRow
  measure_certificate_against_linear(const std::string    &name,
                                     const Parameters     &parameters,
                                     const BenchmarkStudy &study)
  {
    const MethodChoice choice = choose_method(parameters, parameters.solver);
    const auto         scene =
      std::make_shared<const Scene<2>>(parameters,
                                       matrix_storage(choice),
                                       parameters.solver.start);
    const SolveResult        solved  = solve(choice, parameters.solver, *scene);
    const ElasticProblem<2> &problem = scene->problem();

    const auto             certificate = std::make_shared<Certificate>();
    const std::vector<Job> jobs        = {
             {name + ", certificate",
              [&]() {
         *certificate =
           Certifier(parameters.certificate.kind, scene)
             .certify(*scene, solved.u, parameters.solver.proof, []() {
               return true;
             });
       },
              [certificate]() -> nlohmann::json {
         return {{"unknowns", certificate->n_unknowns},
                 {"width", certificate->width()},
                 {"boxes", certificate->proof_nodes}};
       }},
             {name + ", CHOLMOD",
              [&problem]() { solve_by_cholesky(problem.matrix(), problem.load()); },
              []() { return nlohmann::json(); }},
             {name + ", assembly and CHOLMOD",
              [&]() {
         ElasticProblem<2> assembled(
           problem.unknowns().dof_handler().get_triangulation(),
           scene->conditions(),
           scene->supports(),
           problem.unknowns().degree());
         assembled.assemble(scene->materials(), scene->loads());
         solve_by_cholesky(assembled.matrix(), assembled.load());
       },
              []() { return nlohmann::json(); }}};
    const auto results =
      measure_alternating(jobs, study.repetitions, study.seconds);

    BenchmarkRow row;
    row["scene"]    = name;
    row["unknowns"] = problem.unknowns().n_free_dofs();
    row["kind"]     = parameters.certificate.kind == CertificateKind::global ?
                        "global" :
                        "fixed state";
    std::vector<std::string> errors;
    for (const Measurements &job : results)
      if (!job.error.empty())
        errors.push_back(job.error);
    if (!errors.empty())
      {
        row["failed"] = join(errors, "; ");
        return row;
      }
    const auto &own        = results[0].values;
    row["stress_unknowns"] = own.front().facts["unknowns"];
    row["width"]           = own.front().facts["width"];
    row["boxes"]           = own.front().facts["boxes"];
    row["repetitions"]     = own.size();
    const auto seconds     = &Measurement::cpu_seconds;
    add_spread("cpu_seconds", spread(own, seconds), row);
    add_spread("cholesky_cpu_seconds", spread(results[1].values, seconds), row);
    add_spread("assembled_cpu_seconds",
               spread(results[2].values, seconds),
               row);
    add_spread("cpu_time_over_cholesky",
               spread_of_ratios(own, results[1].values, seconds),
               row);
    add_spread("cpu_time_over_assembled",
               spread_of_ratios(own, results[2].values, seconds),
               row);
    return row;
  }
} // namespace Debond
