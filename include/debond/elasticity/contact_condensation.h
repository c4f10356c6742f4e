// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_condensation_h
#define debond_elasticity_contact_condensation_h

#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>

namespace Debond
{
  /// The problem condensed onto the normal displacements of its contact nodes,
  /// in their order.
  template <int dim>
  Condensation
  condense_to_contact(const ElasticProblem<dim> &problem)
  {
    const auto &normals = problem.unknowns().contact().normals();
    return Condensation(problem.matrix(),
                        problem.load(),
                        {normals.begin(), normals.end()},
                        [&](const unsigned int i) {
                          return problem.unknowns().is_constrained(i);
                        });
  }
} // namespace Debond

#endif
