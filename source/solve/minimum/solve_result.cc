// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/solve/minimum/solve_result.h>

namespace Debond
{
  void
  add_bundle_result(const ProximalBundleResult &bundle, SolveResult &result)
  {
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
  }



  void
  add_majorise_result(const MajoriseMinimiseResult &minimum,
                      SolveResult                  &result)
  {
    result.status    = minimum.status;
    result.message   = minimum.message;
    result.criterion = minimum.residual;
    // Iterations are numbered through, as a result may have been minimised more
    // than once.
    for (MajoriseMinimiseIteration iteration : minimum.history)
      {
        iteration.iteration = ++result.iterations;
        result.linear_iterations += iteration.linear_iterations;
        result.majorise_history.push_back(iteration);
      }
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
