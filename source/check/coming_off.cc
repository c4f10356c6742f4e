// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/coming_off.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/optimization/polar_cone.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Debond
{
  namespace
  {
    /// The part of the work that forces could do, had they all the same sign,
    /// below which what they do is rounding.
    constexpr double rounding_of_work = 1e-12;

    /// Of the displacements of contact nodes, in parts of the largest normal
    /// one.
    constexpr double rounding_of_motion = 1e-9;



    /// The sum with @p parts of the motions, of the displacement of @p centre
    /// and of rotations.
    template <int dim>
    RigidMotion<dim>
    combination(const std::vector<RigidMotion<dim>> &motions,
                const Eigen::VectorXd               &parts,
                const dealii::Point<dim>            &centre)
    {
      RigidMotion<dim> result;
      result.centre = centre;
      for (unsigned int k = 0; k < motions.size(); ++k)
        {
          result.translation += parts[k] * motions[k](centre);
          result.rotation += parts[k] * motions[k].rotation;
        }
      return result;
    }



    struct Work
    {
      /// Of the nodal forces along each of the motions.
      Eigen::VectorXd along;

      /// If no two of the terms had different signs.
      Eigen::VectorXd largest;
    };



    template <int dim>
    Work
    work_of_loads(const ElasticProblem<dim>           &problem,
                  const LoadFactors                    factors,
                  const std::vector<RigidMotion<dim>> &motions)
    {
      const DofVector forces = problem.fields().applied_nodal_forces(factors);
      const Eigen::Index n   = static_cast<Eigen::Index>(motions.size());
      Work work{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
      std::vector<bool> is_done(forces.size(), false);
      for (const auto &cell :
           problem.unknowns().dof_handler().active_cell_iterators())
        {
          const CellNodes<dim> nodes(cell);
          for (unsigned int i = 0; i < nodes.size; ++i)
            {
              if (is_done[nodes.dofs[i][0]])
                continue;
              is_done[nodes.dofs[i][0]]         = true;
              const dealii::Point<dim> position = node_position<dim>(cell, i);
              dealii::Tensor<1, dim>   force;
              for (unsigned int d = 0; d < dim; ++d)
                force[d] = forces(nodes.dofs[i][d]);
              for (Eigen::Index k = 0; k < n; ++k)
                {
                  const dealii::Tensor<1, dim> way = motions[k](position);
                  work.along[k] += force * way;
                  work.largest[k] += force.norm() * way.norm();
                }
            }
        }
      return work;
    }
  } // namespace



  template <int dim>
  std::optional<ComingOff<dim>>
  coming_off(const ElasticProblem<dim> &problem,
             const AdhesiveLaw         &law,
             const LoadFactors          factors)
  {
    const auto &nodes   = problem.unknowns().contact().boundary().nodes;
    const auto &motions = problem.unknowns().held_by_contact().motions;
    if (motions.empty() || nodes.empty() ||
        !law.is_loose(law.branches().size() - 1))
      return {};

    const Eigen::MatrixXd towards =
      free_motions_of_contact(problem.unknowns()).transpose();
    const Work work = work_of_loads(problem, factors, motions);
    // Twice, as its errors are relative to what it projects.
    std::optional<Eigen::VectorXd> projection =
      project_on_polar_cone(towards, work.along);
    if (projection)
      projection = project_on_polar_cone(towards, *projection);
    if (!projection)
      return {};
    Eigen::VectorXd &parts = *projection;
    const double     largest_normal =
      (towards.transpose() * parts).cwiseAbs().maxCoeff();
    if (!(largest_normal > 0.))
      return {};
    parts /= largest_normal;

    dealii::Point<dim> centre;
    for (const auto &node : nodes)
      centre += node.position / static_cast<double>(nodes.size());
    double radius = 0.;
    for (const auto &node : nodes)
      radius = std::max(radius, centre.distance(node.position));

    ComingOff<dim> result{combination(motions, parts, centre),
                          work.along.dot(parts),
                          (towards.transpose() * parts).maxCoeff()};
    for (unsigned int i = 0; i < result.motion.translation.dimension; ++i)
      if (std::abs(result.motion.translation[i]) <= rounding_of_motion)
        result.motion.translation[i] = 0.;
    for (unsigned int i = 0; i < result.motion.rotation.dimension; ++i)
      if (std::abs(result.motion.rotation[i]) * radius <= rounding_of_motion)
        result.motion.rotation[i] = 0.;
    if (!(result.work >
          rounding_of_work * work.largest.dot(parts.cwiseAbs())) ||
        result.towards_foundation > rounding_of_motion)
      return {};
    return result;
  }



  template decltype(coming_off<2>) coming_off<2>;
  template decltype(coming_off<3>) coming_off<3>;
} // namespace Debond
