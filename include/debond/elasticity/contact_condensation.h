// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_condensation_h
#define debond_elasticity_contact_condensation_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>

namespace Debond
{
  /// What J is more than 1/2 <A w, w> - <load, w> and the change of @p
  /// adhesion: the energy of w = 0, of what is prescribed. It is zero if
  /// nothing is.
  template <int dim>
  double
  prescribed_energy(const ElasticProblem<dim>   &problem,
                    const AdhesionIntegral<dim> &adhesion,
                    const double                 load_factor = 1.)
  {
    return problem.lifting_energy(load_factor) +
           adhesion.energy_at_zero(load_factor);
  }



  /// The problem condensed onto the normal displacements of its contact nodes,
  /// in their order. Keeps references to both for the energy of what is
  /// prescribed.
  template <int dim>
  Condensation
  condense_to_contact(const ElasticProblem<dim>   &problem,
                      const AdhesionIntegral<dim> &adhesion)
  {
    const auto &normals = problem.unknowns().contact().normals();
    return Condensation(problem.matrix(),
                        problem.load(),
                        {normals.begin(), normals.end()},
                        [&](const unsigned int i) {
                          return problem.unknowns().is_constrained(i);
                        },
                        {problem.constant_load(),
                         [&problem, &adhesion](const double load_factor) {
                           return prescribed_energy(problem,
                                                    adhesion,
                                                    load_factor);
                         }});
  }
} // namespace Debond

#endif
