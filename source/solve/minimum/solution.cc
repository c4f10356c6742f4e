// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/append.h>
#include <debond/base/instantiate.h>
#include <debond/solve/minimum/solution.h>

namespace Debond
{
  void
  Solution::add(const Solution &later)
  {
    // The iterations of the later minimisation are numbered on behind those so
    // far, so that all of them make one history. How the whole has ended is
    // what the later one says.
    const auto add_iterations = [this](const auto &history, auto &all) {
      for (auto iteration : history)
        {
          iteration.iteration += iterations;
          all.push_back(iteration);
        }
    };
    add_iterations(later.bundle_history, bundle_history);
    add_iterations(later.majorise_history, majorise_history);
    iterations += later.iterations;
    long_steps += later.long_steps;
    short_steps += later.short_steps;
    null_steps += later.null_steps;
    linear_iterations += later.linear_iterations;
    largest_qp_residual =
      std::max(largest_qp_residual, later.largest_qp_residual);
    status    = later.status;
    message   = later.message;
    criterion = later.criterion;
    append(later.notes, notes);
    for (const auto &[part, seconds] : later.parts)
      parts[part] += seconds;
  }



  Solution
  solution_of(const ProximalBundleResult &bundle)
  {
    Solution result;
    result.status                     = bundle.status;
    result.message                    = bundle.message;
    result.iterations                 = bundle.iterations();
    result.long_steps                 = bundle.long_steps;
    result.short_steps                = bundle.short_steps;
    result.null_steps                 = bundle.null_steps;
    result.criterion                  = bundle.v;
    result.largest_qp_residual        = bundle.largest_qp_residual;
    result.bundle_history             = bundle.history;
    result.parts["quadratic program"] = bundle.qp_seconds;
    result.parts["functional"]        = bundle.objective_seconds;
    result.parts["linear algebra"]    = bundle.linear_algebra_seconds;
    return result;
  }



  Solution
  solution_of(const MajoriseMinimiseResult &minimum)
  {
    Solution result;
    result.status           = minimum.status;
    result.message          = minimum.message;
    result.criterion        = minimum.residual;
    result.iterations       = static_cast<unsigned int>(minimum.history.size());
    result.majorise_history = minimum.history;
    // Each iteration minimises one majorant, by linear systems of which those
    // of multigrid take conjugate gradients.
    for (const MajoriseMinimiseIteration &iteration : minimum.history)
      result.linear_iterations += iteration.linear_iterations;
    return result;
  }



  template <int dim>
  double
  functional_of(const Scene<dim> &scene, const DofVector &u)
  {
    const ElasticProblem<dim> &problem = scene.problem();
    // From the strains, in the sum over cells, which keeps the digits that a
    // product with A loses.
    return problem.fields().elastic_functional(u) +
           scene.adhesion().value(scene.contact_trace(u));
  }



  DEBOND_INSTANTIATE(functional_of);
} // namespace Debond
