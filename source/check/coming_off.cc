// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/check/coming_off.h>
#include <debond/elasticity/contact_condensation.h>
#include <debond/optimization/polar_cone.h>

namespace Debond
{
  namespace
  {
    /// The sum with @p parts of the motions of a body, of the displacement of
    /// @p centre and of rotations.
    template <int dim>
    RigidMotion<dim>
    combination(const std::vector<std::vector<RigidMotion<dim>>> &motions,
                const Eigen::VectorXd                            &parts,
                const dealii::Point<dim>                         &centre,
                const unsigned int                                body)
    {
      RigidMotion<dim> result;
      result.centre = centre;
      for (unsigned int k = 0; k < motions.size(); ++k)
        {
          result.translation += parts[k] * motions[k][body](centre);
          result.rotation += parts[k] * motions[k][body].rotation;
        }
      return result;
    }



    /// The derivative of Phi where all bonds are open as far as can be: what
    /// curves that end with a traction pull with.
    template <int dim>
    Eigen::VectorXd
    pull_far_away(const AdhesionIntegral<dim> &adhesion)
    {
      Eigen::VectorXd s = Eigen::VectorXd::Zero(adhesion.n_unknowns());
      s.head(adhesion.n_nodes())
        .setConstant(-std::cbrt(std::numeric_limits<double>::max()));
      return adhesion.subgradient(s).head(adhesion.n_nodes());
    }
  } // namespace



  template <int dim>
  std::optional<ComingOff<dim>>
  coming_off(const ElasticProblem<dim>   &problem,
             const AdhesionIntegral<dim> &adhesion,
             const LoadFactors            factors)
  {
    // Along a rigid motion with the parts p the elastic energy does not change,
    // the normal displacements change by N p, and far enough along it Phi falls
    // or rises by pull'N p. So J falls by (R'f - N'pull)'p, R being the motions
    // of all nodes. Among the p with N p <= 0, which lead away from the
    // foundation, the projection of R'f - N'pull on their cone is the steepest
    // descent. If it is zero, no motion descends.
    const auto &nodes          = problem.unknowns().contact().boundary().nodes;
    const auto &motions        = problem.unknowns().held_by_contact().motions;
    const PiecewiseEnergy &law = adhesion.adhesive_law().pieces();
    if (motions.empty() || nodes.empty() || law[law.size() - 1].curvature != 0.)
      return {};
    const Eigen::VectorXd pull = pull_far_away(adhesion);
    if (adhesion.shears() && !pull.isZero(0.))
      return {};

    // Only the normal displacements are bounded: once bonds have broken,
    // nothing holds nodes along the boundary.
    const Eigen::MatrixXd all =
      free_motions_of_contact(problem.unknowns()).transpose();
    Eigen::MatrixXd towards = all.leftCols(nodes.size());
    // Of nodes that a rotation does not move only rounding remains. Its sign
    // would make them go towards the foundation, and so forbid the rotation.
    const double rounding = Tolerance::motion_off * all.cwiseAbs().maxCoeff();
    towards          = (towards.array().abs() < rounding).select(0., towards);
    WorkOfLoads work = work_of_loads(problem, factors, motions);
    work.along -= all.leftCols(nodes.size()) * pull;
    // The projection is repeated, since its errors are relative to what it
    // projects, which may be far larger than what remains.
    std::optional<Eigen::VectorXd> projection =
      project_on_polar_cone(towards, work.along);
    if (projection)
      projection = project_on_polar_cone(towards, *projection);
    if (!projection)
      return {};
    Eigen::VectorXd &parts   = *projection;
    const double     largest = (all.transpose() * parts).cwiseAbs().maxCoeff();
    if (!(largest > 0.))
      return {};
    // The work below is that for a unit of the largest displacement, and so a
    // force.
    parts /= largest;

    dealii::Point<dim> centre;
    for (const auto &node : nodes)
      centre += node.position / static_cast<double>(nodes.size());
    double radius = 0.;
    for (const auto &node : nodes)
      radius = std::max(radius, centre.distance(node.position));

    ComingOff<dim> result{combination(motions, parts, centre, 0),
                          work.along.dot(parts),
                          (towards.transpose() * parts).maxCoeff()};
    // Of several bodies the motion is that of the one that moves most, by its
    // translation and by what its rotation does at the farthest node. A body
    // has to move more by more than rounding to be preferred, so that equal
    // ones do not depend on the machine.
    const auto size = [radius](const RigidMotion<dim> &motion) {
      return motion.translation.norm() + radius * motion.rotation.norm();
    };
    for (unsigned int body = 1; body < motions[0].size(); ++body)
      if (const auto motion = combination(motions, parts, centre, body);
          size(motion) > (1. + Tolerance::motion_off) * size(result.motion))
        result.motion = motion;
    for (unsigned int i = 0; i < result.motion.translation.dimension; ++i)
      if (std::abs(result.motion.translation[i]) <= Tolerance::motion_off)
        result.motion.translation[i] = 0.;
    for (unsigned int i = 0; i < result.motion.rotation.dimension; ++i)
      if (std::abs(result.motion.rotation[i]) * radius <= Tolerance::motion_off)
        result.motion.rotation[i] = 0.;
    // The loads have to do work beyond the rounding of their own terms, and no
    // node may go towards the foundation. A comparison that fails for a NaN
    // refuses as well.
    if (!(result.work > Tolerance::work * work.largest.dot(parts.cwiseAbs())) ||
        result.towards_foundation > Tolerance::motion_off)
      return {};
    return result;
  }



  DEBOND_INSTANTIATE(coming_off);
} // namespace Debond
