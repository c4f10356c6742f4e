// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/check/force_balance.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    dealii::Tensor<1, dim>
    resultant(const DofVector &forces)
    {
      dealii::Tensor<1, dim> sum;
      for (unsigned int i = 0; i < forces.size(); ++i)
        sum[i % dim] += forces(i);
      return sum;
    }



    /// Sets the reaction of each support by its name. @p clamped: A u - f where
    /// supports exert it.
    template <int dim>
    void
    set_reactions(const ElasticUnknowns<dim> &unknowns,
                  const DofVector            &clamped,
                  Verification<dim>          &result)
    {
      const std::vector<std::string> &names = unknowns.support_names();
      for (const std::string &name : names)
        result.reactions[name];
      // A u - f at an unknown that a support holds is the force of this
      // support. One unknown is taken at a time, since each may be held by
      // another support; its force becomes a Cartesian one through the frame of
      // its node and, if the unknown is a jump, becomes forces on both nodes.
      std::map<unsigned int, unsigned int> of_node;
      for (const auto &[dof, support] : unknowns.supported())
        of_node[static_cast<unsigned int>(dof / dim)] = support;
      for (const auto &[dof, support] : unknowns.supported())
        {
          dealii::Tensor<1, dim> force;
          force[dof % dim] = clamped(dof);
          // What holds a jump acts on both nodes, which two supports may hold.
          for (const BasisStep step : {BasisStep::frames, BasisStep::jumps})
            if (const auto *row =
                  unknowns.basis().find(step,
                                        static_cast<unsigned int>(dof / dim)))
              {
                force = force * row->to_unknowns;
                // The axis holds nodes without being a support.
                for (const auto &[other, weight] : row->others)
                  if (const auto held = of_node.find(other);
                      held != of_node.end())
                    result.reactions[names[held->second]] -=
                      weight * force * row->of_others;
              }
          result.reactions[names[support]] += force;
        }
    }



    /// Bonds of vertices that a support moves pull at it with @p held_forces.
    template <int dim>
    void
    add_held_forces(const ElasticUnknowns<dim> &unknowns,
                    const std::vector<double>  &held_forces,
                    Verification<dim>          &result)
    {
      const std::vector<std::string> &names = unknowns.support_names();
      const auto &held = unknowns.contact().boundary().held_vertices;
      for (unsigned int k = 0; k < held.size(); ++k)
        {
          // The derivative of Phi by the normal displacement, so that the bonds
          // act on the body with minus this force, and the support that holds
          // the vertex has to bear it. Between two bodies the support of the
          // low side bears it the other way, and the sum over all supports does
          // not change.
          const dealii::Tensor<1, dim> force = held_forces[k] * held[k].normal;
          result.contact_reaction -= force;
          if (held[k].is_tangential)
            result.tangential_reaction -= force;
          if (held[k].low_support < names.size())
            result.reactions[names[held[k].low_support]] -= force;
          else
            result.clamped_reaction += force;
          if (held[k].support < names.size())
            result.reactions[names[held[k].support]] += force;
        }
    }
  } // namespace



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  at_contact_nodes(const DofVector            &vectors,
                   const ElasticUnknowns<dim> &unknowns)
  {
    // The unknowns of a node follow each other.
    std::vector<dealii::Tensor<1, dim>> result;
    for (const auto normal : unknowns.contact().normal_dofs())
      {
        result.emplace_back();
        for (unsigned int d = 0; d < dim; ++d)
          result.back()[d] = vectors(normal / dim * dim + d);
      }
    return result;
  }



  template <int dim>
  void
  compute_force_balance(const ElasticProblem<dim> &problem,
                        const DofVector           &residual,
                        const LoadFactors          factors,
                        const double               resolved,
                        const std::vector<double> &held_forces,
                        Verification<dim>         &result)
  {
    // The force balance is that of all forces on the body: loads, supports and
    // foundation. What supports and foundation exert is the residual A u - f at
    // their unknowns; what is held there and by no support is held by the
    // foundation. Residuals at free unknowns belong to none of these, so that
    // they make an imbalance.
    const ElasticUnknowns<dim> &unknowns = problem.unknowns();
    const auto                 &normals  = unknowns.contact().normal_dofs();
    DofVector                   clamped(unknowns.n_dofs());
    DofVector                   tangential(unknowns.n_dofs());
    for (const auto &line : unknowns.constraints().get_lines())
      if (unknowns.on_axis().count(line.index / dim) == 0)
        tangential(line.index) = residual(line.index);
    for (const auto &[dof, unused] : unknowns.supported())
      {
        clamped(dof)    = residual(dof);
        tangential(dof) = 0.;
      }
    const auto &dofs = unknowns.contact().dofs();
    for (std::size_t i = normals.size(); i < dofs.size(); ++i)
      tangential(dofs[i]) = residual(dofs[i]);
    DofVector contact = tangential;
    for (const auto normal : normals)
      contact(normal) = residual(normal);

    const DofVector applied = problem.fields().applied_nodal_forces(factors);
    result.applied_force    = resultant<dim>(applied);
    result.clamped_reaction =
      resultant<dim>(unknowns.cartesian_forces(clamped));
    result.contact_reaction = resultant<dim>(unknowns.contact_forces(contact));
    tangential              = unknowns.contact_forces(tangential);
    result.tangential_reaction = resultant<dim>(tangential);
    result.tangential_forces   = at_contact_nodes(tangential, unknowns);
    set_reactions(unknowns, clamped, result);
    add_held_forces(unknowns, held_forces, result);
    // Forces are those at contact nodes, and vertices whose normal displacement
    // is known are none. A tangent that a support moves has its number among
    // the held vertices, as its force has.
    const auto &nodes = unknowns.contact().boundary().nodes;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (const auto &tangent : nodes[i].tangents)
        if (tangent.is_held)
          result.tangential_forces[i] -=
            held_forces[tangent.index] * tangent.direction;

    // The imbalance is relative to the sum of the sizes of all forces, since
    // resultants can vanish if forces do not.
    DofVector all = clamped;
    all += contact;
    const double scale = all.l1_norm() + applied.l1_norm();
    // Each body is in balance by itself: forces between bodies act on both, and
    // would cancel in the sum over all bodies.
    all = unknowns.cartesian_forces(all);
    all += applied;
    std::vector<dealii::Tensor<1, dim>> sums(unknowns.n_bodies());
    for (unsigned int i = 0; i < all.size(); ++i)
      sums[unknowns.body_of(i / dim)][i % dim] += all(i);
    double imbalance = 0.;
    for (dealii::Tensor<1, dim> &sum : sums)
      {
        // Away from an axis hoop stresses balance what loads do not, so that
        // only the component along the axis is in balance.
        if (unknowns.symmetry() == Symmetry::axis)
          sum[0] = 0.;
        imbalance = std::max(imbalance, sum.norm());
      }
    result.force_imbalance =
      imbalance > 0. ? imbalance / std::max(scale, resolved) : 0.;
  }



  DEBOND_INSTANTIATE(at_contact_nodes);
  DEBOND_INSTANTIATE(compute_force_balance);
} // namespace Debond
