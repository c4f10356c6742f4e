// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/benchmark/speed_against_error.h>
#include <debond/check/verification.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    using Vector = dealii::Vector<double>;

    /// An iterate is good enough if J(x_k) - J_min is less than this part of
    /// the discretisation error of J.
    constexpr double small_part = 0.1;



    struct Iterate
    {
      unsigned int iteration;
      double       part; ///< of the wall time of the solve
      double       J;
    };

    NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Iterate, iteration, part, J)



    /// What is measured on one mesh.
    struct MeshResult
    {
      unsigned int unknowns;
      double       J_min;

      /// ||u_min - u_reference||_A / ||u_reference||_A, null for the reference.
      nlohmann::json energy_discretisation_error;

      /// By method and repetition.
      std::vector<std::vector<Measurement>> methods;
    };



    template <int dim>
    SolveResult
    solve_silently(const std::string &method,
                   const Parameters  &parameters,
                   const Scene<dim>  &scene)
    {
      std::ostringstream log;
      Parameters         with_method = parameters;
      with_method.solver.method      = method;
      return solve(choose_method(with_method),
                   with_method,
                   scene,
                   log,
                   /*terminal=*/false);
    }



    /// Throws std::runtime_error if it is not found.
    template <int dim>
    SolveResult
    find_minimum(const Parameters &parameters, const Scene<dim> &scene)
    {
      const SolveResult result =
        solve_silently(SolverMethod::majorise_minimise, parameters, scene);
      if (result.status != SolverStatus::success)
        throw std::runtime_error(result.message);
      return result;
    }



    /// See SpeedAgainstError.
    double
    extrapolate(const std::vector<double> &minima)
    {
      if (minima.size() < 3)
        throw std::runtime_error("the extrapolation of J needs three meshes");
      const double J   = minima[minima.size() - 1];
      const double d_2 = J - minima[minima.size() - 2];
      const double d_1 = minima[minima.size() - 2] - minima[minima.size() - 3];
      const double q   = d_2 / d_1;
      if (!(q > 0. && q < 1.))
        throw std::runtime_error(
          "J cannot be extrapolated: its differences between the last three "
          "meshes do not decrease");
      return J + d_2 * q / (1. - q);
    }



    double
    energy_norm(const dealii::SparseMatrix<double> &A, const Vector &v)
    {
      return std::sqrt(std::max(A.matrix_norm_square(v), 0.));
    }



    /// The iterates of the paper's method with the time of each.
    template <int dim>
    std::vector<Iterate>
    euclidean_iterates(const Parameters &parameters, const Scene<dim> &scene)
    {
      std::vector<Iterate> iterates;
      Vector               x(scene.problem().unknowns().n_dofs());
      dealii::Timer        timer;
      ProximalBundle<Vector>(parameters.solver.bundle)
        .minimize(scene.functional(),
                  scene.problem().unknowns().contact().bounds(),
                  x,
                  [&](const BundleIteration &iteration) {
                    iterates.push_back({iteration.iteration,
                                        timer.wall_time(),
                                        iteration.functional});
                    return true;
                  });
      const double seconds = timer.wall_time();
      for (Iterate &iterate : iterates)
        iterate.part /= seconds;
      return iterates;
    }



    /// The iterates of a method on the contact normals, which all take the same
    /// work after the condensation.
    std::vector<Iterate>
    condensed_iterates(const SolveResult &result)
    {
      const double condensation = result.parts.at("condensation");
      const double contact      = result.parts.at("contact");
      const double seconds =
        condensation + contact + result.parts.at("expansion");

      std::vector<Iterate> iterates;
      const auto           add = [&](const auto &history) {
        for (const auto &iteration : history)
          {
            const double done = static_cast<double>(iteration.iteration) /
                                static_cast<double>(history.size());
            iterates.push_back({iteration.iteration,
                                (condensation + done * contact) / seconds,
                                iteration.functional});
          }
      };
      add(result.bundle_history);
      add(result.majorise_history);
      return iterates;
    }



    /// Nothing is solved in this process: CHOLMOD's threads would not survive
    /// the next fork.
    template <int dim>
    Job
    method_job(const std::string &method,
               const Parameters  &parameters,
               const Scene<dim>  &scene)
    {
      const auto result = std::make_shared<SolveResult>();
      return {
        parameters.scene + ", " + method,
        [&parameters, &scene, method, result] {
          *result = SolveResult();
          *result = solve_silently(method, parameters, scene);
        },
        [&parameters, &scene, method, result]() -> nlohmann::json {
          const SolveResult minimum    = find_minimum(parameters, scene);
          Vector            difference = result->u;
          difference -= minimum.u;
          const auto &A = scene.problem().matrix();
          return {
            {"status", to_string(result->status)},
            {"iterations", result->iterations},
            {"J", result->functional},
            {"J_min", minimum.functional},
            {"distance",
             energy_norm(A, difference) / energy_norm(A, minimum.u)},
            {"law_violation",
             verify(scene.problem(), scene.adhesion(), scene.law(), result->u)
               .law_violation},
            {"iterates",
             method == SolverMethod::euclidean_bundle ?
               euclidean_iterates(parameters, scene) :
               condensed_iterates(*result)}};
        }};
    }



    /// Those that a logarithmic plot can show apart, and the last one.
    std::vector<Iterate>
    thinned(const std::vector<Iterate> &iterates)
    {
      std::vector<Iterate> result;
      double               next = 1.;
      for (const Iterate &iterate : iterates)
        if (iterate.iteration >= next ||
            iterate.iteration == iterates.back().iteration)
          {
            result.push_back(iterate);
            next = std::max(next + 1., 1.02 * iterate.iteration);
          }
      return result;
    }



    std::optional<Iterate>
    first_good_enough(const std::vector<Iterate> &iterates,
                      const double                J_min,
                      const double                J_discretisation_error)
    {
      for (const Iterate &iterate : iterates)
        if (iterate.J - J_min < small_part * J_discretisation_error)
          return iterate;
      return {};
    }



    /// The distance of the minima of two meshes in the energy norm of the finer
    /// one, on which P1 displacements of the other one can be written exactly.
    template <int dim>
    double
    distance_to_reference(const Parameters &parameters,
                          const Scene<dim> &scene,
                          const Parameters &reference_parameters,
                          const Scene<dim> &reference)
    {
      double     distance = 0.;
      const auto run      = [&] {
        const Vector u = find_minimum(reference_parameters, reference).u;
        Vector       difference =
          interpolate_displacement(scene.body(),
                                   scene.problem(),
                                   find_minimum(parameters, scene).u,
                                   reference.problem());
        difference -= u;
        const auto &A = reference.problem().matrix();
        distance      = energy_norm(A, difference) / energy_norm(A, u);
      };
      const Job job = {parameters.scene + ", distance to the reference",
                       run,
                       [&]() -> nlohmann::json { return distance; }};
      return measure(job).facts;
    }



    template <int dim>
    MeshResult
    measure_mesh(const BenchmarkSuite::Mesh &mesh,
                 const Parameters           &reference_parameters,
                 const Scene<dim>           &reference)
    {
      const Parameters parameters = mesh.scene.parameters();
      const Scene<dim> scene(parameters);
      std::vector<Job> jobs;
      for (const std::string &method : mesh.methods)
        jobs.push_back(method_job(method, parameters, scene));

      MeshResult result;
      result.unknowns = scene.problem().unknowns().n_free_dofs();
      result.methods  = measure_alternating(jobs, mesh.repetitions);
      result.J_min    = result.methods.front().front().facts["J_min"];
      if (scene.n_cells() != reference.n_cells())
        result.energy_discretisation_error = distance_to_reference(
          parameters, scene, reference_parameters, reference);
      return result;
    }



    BenchmarkRow
    method_row(const MeshResult               &mesh,
               const std::vector<Measurement> &measurements,
               const double                    J_discretisation_error)
    {
      const nlohmann::json &facts = measurements.front().facts;
      const double          J     = facts["J"];

      BenchmarkRow row;
      row["unknowns"]   = mesh.unknowns;
      row["status"]     = facts["status"];
      row["iterations"] = facts["iterations"];
      add_spread("time_over_last_method",
                 spread_of_ratios(measurements,
                                  mesh.methods.back(),
                                  &Measurement::seconds),
                 row);
      add_spread("seconds", spread(measurements, &Measurement::seconds), row);
      row["J"]                      = J;
      row["J_optimisation_error"]   = std::max(J - mesh.J_min, 0.);
      row["J_discretisation_error"] = J_discretisation_error;
      row["J_total_error"]          = J - mesh.J_min + J_discretisation_error;
      row["energy_optimisation_error"]   = facts["distance"];
      row["energy_discretisation_error"] = mesh.energy_discretisation_error;
      row["law_violation"]               = facts["law_violation"];
      if (const std::optional<Iterate> iterate = first_good_enough(
            facts["iterates"], mesh.J_min, J_discretisation_error))
        {
          row["iteration_good_enough"] = iterate->iteration;
          row["seconds_good_enough"] =
            iterate->part * row["seconds"].get<double>();
        }
      return row;
    }
  } // namespace



  template <int dim>
  SpeedAgainstError
  measure_speed_against_error(const std::vector<BenchmarkSuite::Mesh> &meshes)
  {
    const Parameters reference_parameters = meshes.back().scene.parameters();
    const Scene<dim> reference(reference_parameters);

    std::vector<MeshResult> measured;
    std::vector<double>     minima;
    for (const BenchmarkSuite::Mesh &mesh : meshes)
      {
        measured.push_back(measure_mesh(mesh, reference_parameters, reference));
        minima.push_back(measured.back().J_min);
      }
    const double J = extrapolate(minima);

    SpeedAgainstError result;
    for (unsigned int k = 0; k < meshes.size(); ++k)
      {
        const BenchmarkRow name  = {{"mesh", meshes[k].scene.name}};
        const double       error = minima[k] - J;

        BenchmarkRow row              = name;
        row["unknowns"]               = measured[k].unknowns;
        row["J_min"]                  = minima[k];
        row["J_discretisation_error"] = error;
        row["energy_discretisation_error"] =
          measured[k].energy_discretisation_error;
        result.meshes.push_back(row);

        for (unsigned int m = 0; m < meshes[k].methods.size(); ++m)
          {
            const std::vector<Measurement> &measurements =
              measured[k].methods[m];
            row           = name;
            row["method"] = meshes[k].methods[m];
            row.update(method_row(measured[k], measurements, error));
            result.methods.push_back(row);

            for (const Iterate &iterate :
                 thinned(measurements.front().facts["iterates"]))
              {
                BenchmarkRow point = name;
                point["method"]    = meshes[k].methods[m];
                point["iteration"] = iterate.iteration;
                point["seconds"] = iterate.part * row["seconds"].get<double>();
                point["J_distance"] = iterate.J - minima[k];
                result.convergence.push_back(point);
              }
          }
      }
    return result;
  }



  template SpeedAgainstError
  measure_speed_against_error<2>(const std::vector<BenchmarkSuite::Mesh> &);
  template SpeedAgainstError
  measure_speed_against_error<3>(const std::vector<BenchmarkSuite::Mesh> &);
} // namespace Debond
