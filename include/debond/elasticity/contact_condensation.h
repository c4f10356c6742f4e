// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_condensation_h
#define debond_elasticity_contact_condensation_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>

#include <Eigen/Core>

namespace Debond
{
  /// What J is more than 1/2 <A w, w> - <load, w> and the change of @p
  /// adhesion: the energy of w = 0, of what is prescribed. It is zero if
  /// nothing is.
  template <int dim>
  double
  prescribed_energy(const ElasticProblem<dim>   &problem,
                    const AdhesionIntegral<dim> &adhesion,
                    const LoadFactors            factors = 1.)
  {
    return problem.lifting_energy(factors) +
           adhesion.energy_at_zero(factors.displacements);
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
    return Condensation(
      problem.matrix(),
      problem.load(),
      {normals.begin(), normals.end()},
      [&](const unsigned int i) {
        return problem.unknowns().is_constrained(i);
      },
      {problem.constant_load(),
       problem.displacement_load(),
       [&problem, &adhesion](const double loads, const double displacements) {
         return prescribed_energy(problem,
                                  adhesion,
                                  LoadFactors(loads, displacements));
       }},
      !problem.unknowns().held_by_contact().motions.empty());
  }



  /// The normal displacements of the contact nodes under the rigid motions that
  /// only bonds and foundation hold, a column for each: S times them is zero.
  template <int dim>
  Eigen::MatrixXd
  free_motions_of_contact(const ElasticUnknowns<dim> &unknowns)
  {
    const auto     &nodes   = unknowns.contact().boundary().nodes;
    const auto     &motions = unknowns.held_by_contact().motions;
    Eigen::MatrixXd result(nodes.size(), motions.size());
    for (unsigned int k = 0; k < motions.size(); ++k)
      for (unsigned int i = 0; i < nodes.size(); ++i)
        result(i, k) = motions[k](nodes[i].position) * nodes[i].normal;
    return result;
  }



  /// The mean stiffness of the body at its contact normals while all else is
  /// held.
  template <int dim>
  double
  stiffness_at_contact(const ElasticProblem<dim> &problem)
  {
    const auto &normals = problem.unknowns().contact().normals();
    double      sum     = 0.;
    for (const dealii::types::global_dof_index normal : normals)
      sum += problem.matrix().diag_element(normal);
    return normals.empty() ? 0. : sum / static_cast<double>(normals.size());
  }
} // namespace Debond

#endif
