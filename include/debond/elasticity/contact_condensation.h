// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_condensation_h
#define debond_elasticity_contact_condensation_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/linear_algebra/condensation.h>

#include <Eigen/QR>

namespace Debond
{
  /// The part of J beside 1/2 <A w, w> - <load, w> and the change of @p
  /// adhesion: the energy of w = 0, of what is prescribed. It is zero if
  /// nothing is. @p adhesion is that at these factors.
  template <int dim>
  double
  prescribed_energy(const ElasticProblem<dim>   &problem,
                    const AdhesionIntegral<dim> &adhesion,
                    const LoadFactors            factors = 1.)
  {
    return problem.lifting_energy(factors) + adhesion.value_at_zero();
  }



  /// The problem condensed onto the unknowns of ContactSpace, under its whole
  /// load.
  template <int dim>
  Condensation
  condense_to_contact(const ElasticProblem<dim>   &problem,
                      const AdhesionIntegral<dim> &adhesion)
  {
    const Stage stage("factorisation");
    const auto &normals = problem.unknowns().contact().dofs();
    return Condensation(
      {problem.matrix(),
       problem.unknowns().dof_handler().locally_owned_dofs(),
       problem.unknowns().communicator()},
      problem.load(),
      {normals.begin(), normals.end()},
      [&](const unsigned int i) {
        return problem.unknowns().is_constrained(i);
      },
      prescribed_energy(problem, adhesion),
      !problem.unknowns().is_held_by_supports());
  }



  /// Returns the condensed problem at other @p factors, at which @p adhesion
  /// is.
  template <int dim>
  Condensation
  at_factors(const Condensation          &condensed,
             const ElasticProblem<dim>   &problem,
             const AdhesionIntegral<dim> &adhesion,
             const LoadFactors            factors)
  {
    return condensed.with_load(problem.load(factors),
                               prescribed_energy(problem, adhesion, factors));
  }



  /// The condensed problem, in which @p adhesion is what its Condensation was
  /// made with; under @p load, or that of the whole problem.
  template <int dim>
  PiecewiseProblem
  condensed_problem(const Condensation          &condensed,
                    const AdhesionIntegral<dim> &adhesion,
                    const Eigen::VectorXd       &load)
  {
    return {condensed.schur_complement(),
            load,
            adhesion.contact_boundary().upper_bounds(),
            adhesion};
  }

  template <int dim>
  PiecewiseProblem
  condensed_problem(const Condensation          &condensed,
                    const AdhesionIntegral<dim> &adhesion)
  {
    return condensed_problem(condensed, adhesion, condensed.load());
  }



  /// The displacements s of the contact nodes under the rigid motions that
  /// only bonds and foundation hold, a column for each: S times them is zero.
  template <int dim>
  Eigen::MatrixXd
  free_motions_of_contact(const ElasticUnknowns<dim> &unknowns)
  {
    const auto     &motions = unknowns.held_by_contact().motions;
    Eigen::MatrixXd result(unknowns.contact().size(), motions.size());
    Eigen::Index    k = 0;
    for (const DofVector &u : unknowns.displacements_of(motions))
      result.col(k++) =
        unknowns.contact().trace(unknowns.basis().to_unknowns(u));
    return result;
  }



  /// The mean stiffness of the body at its contact normals while all else is
  /// held.
  template <int dim>
  double
  stiffness_at_contact(const ElasticProblem<dim> &problem)
  {
    const auto     &normals  = problem.unknowns().contact().normal_dofs();
    const DofVector diagonal = problem.diagonal();
    double          sum      = 0.;
    for (const dealii::types::global_dof_index normal : normals)
      sum += diagonal(normal);
    return normals.empty() ? 0. : sum / static_cast<double>(normals.size());
  }



  struct WorkOfLoads
  {
    /// The work of the nodal forces along each of the motions.
    Eigen::VectorXd along;

    /// The work if no two of its terms had different signs.
    Eigen::VectorXd largest;
  };



  template <int dim>
  WorkOfLoads
  work_of_loads(const ElasticProblem<dim>                        &problem,
                const LoadFactors                                 factors,
                const std::vector<std::vector<RigidMotion<dim>>> &motions)
  {
    const DofVector    forces = problem.fields().applied_nodal_forces(factors);
    const Eigen::Index n      = static_cast<Eigen::Index>(motions.size());
    WorkOfLoads        work{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    Eigen::Index       k = 0;
    for (const DofVector &u : problem.unknowns().displacements_of(motions))
      {
        work.along[k] = forces * u;
        for (unsigned int i = 0; i < u.size(); i += dim)
          {
            dealii::Tensor<1, dim> force, way;
            for (unsigned int d = 0; d < dim; ++d)
              {
                force[d] = forces(i + d);
                way[d]   = u(i + d);
              }
            work.largest[k] += force.norm() * way.norm();
          }
        ++k;
      }
    return work;
  }



  /// The load of the problem condensed at these @p factors. What it does along
  /// @p free_motions is the work of the applied forces: of what is prescribed,
  /// gaps too, elimination leaves rounding there, which would lift the body or
  /// press it on the foundation.
  template <int dim>
  Eigen::VectorXd
  load_at_contact(const ElasticProblem<dim> &problem,
                  const Condensation        &condensed,
                  const LoadFactors          factors,
                  const Eigen::MatrixXd     &free_motions)
  {
    const Eigen::VectorXd &g = condensed.load();
    if (free_motions.cols() == 0)
      return g;
    WorkOfLoads work =
      work_of_loads(problem,
                    factors,
                    problem.unknowns().held_by_contact().motions);
    for (Eigen::Index k = 0; k < work.along.size(); ++k)
      if (std::abs(work.along[k]) <= Tolerance::work * work.largest[k])
        work.along[k] = 0.;
    return g + free_motions.transpose().completeOrthogonalDecomposition().solve(
                 work.along - free_motions.transpose() * g);
  }
} // namespace Debond

#endif
