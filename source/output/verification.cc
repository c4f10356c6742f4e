// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/output/verification.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace Debond
{
  std::string
  to_string(const BondState state)
  {
    switch (state)
      {
        case BondState::contact:
          return "contact";
        case BondState::bonded:
          return "bonded";
        case BondState::kink:
          return "kink";
        case BondState::broken:
          return "broken";
        case BondState::free:
          return "free";
      }
    throw std::invalid_argument("This is not a bond state");
  }



  template <int dim>
  double
  Verification<dim>::error() const
  {
    // The comparisons of std::max would lose a NaN.
    return std::isfinite(equilibrium_residual + force_imbalance +
                         contact_residual) ?
             std::max(
               {equilibrium_residual, force_imbalance, contact_residual}) :
             std::numeric_limits<double>::infinity();
  }



  template <int dim>
  unsigned int
  Verification<dim>::count(const BondState state) const
  {
    return static_cast<unsigned int>(std::count_if(
      nodes.begin(), nodes.end(), [&](const ContactNodeState &node) {
        return node.state == state;
      }));
  }



  namespace
  {
    /// What displacements and tractions are compared with.
    struct LawScales
    {
      double length;
      double traction;
    };



    template <int dim>
    double
    largest_measure(const ContactBoundary<dim> &boundary)
    {
      double largest = 0.;
      for (const auto &node : boundary.nodes)
        largest = std::max(largest, node.measure);
      return largest;
    }



    template <int dim>
    LawScales
    law_scales(const AdhesiveLaw                   &law,
               const ContactBoundary<dim>          &boundary,
               const std::vector<ContactNodeState> &nodes,
               const double                         largest_reaction)
    {
      if (law.bond_threshold() > 0. && law.bond_strength() > 0.)
        return {law.bond_threshold(), law.bond_strength()};

      LawScales scales = {0., 0.};
      for (const ContactNodeState &node : nodes)
        scales.length = std::max(scales.length, std::abs(node.u_nu));
      if (!boundary.nodes.empty())
        scales.traction = largest_reaction / largest_measure(boundary);
      return scales;
    }



    BondState
    bond_state(const ContactNodeState &node,
               const AdhesiveLaw      &law,
               const LawScales        &scales,
               const double            largest_displacement,
               const double            tolerance)
    {
      if (node.u_nu >=
          -tolerance * std::min(scales.length, largest_displacement))
        return BondState::contact;

      // A small gap under pressure is contact that an iterative method has not
      // closed yet.
      constexpr double largest_gap = 1e-3;
      const double     gap =
        std::max(tolerance, std::min(largest_gap, 1.01 * node.violation));
      if (node.normal_force > 0. && node.u_nu >= -gap * scales.length)
        return BondState::contact;
      if (!(law.bond_strength() > 0.))
        return BondState::free;
      if (std::abs(node.u_nu + law.bond_threshold()) <=
          tolerance * scales.length)
        return BondState::kink;
      return node.u_nu < -law.bond_threshold() ? BondState::broken :
                                                 BondState::bonded;
    }



    /// The distance of a force to the allowed ones.
    double
    distance(const double force, const Interval &allowed)
    {
      return std::max({0., allowed.lower - force, force - allowed.upper});
    }



    Interval
    unbounded_above_if(const bool contact, const Interval &interval)
    {
      return {interval.lower,
              contact ? std::numeric_limits<double>::infinity() :
                        interval.upper};
    }



    /**
     * The distances of Verification::law_violation, one for each node. A
     * larger delta allows more, so that bisection finds the least one. It
     * bisects the exponent, because a node next to a jump of the law is close
     * to the graph, however far its force is from what is allowed at its
     * very displacement.
     */
    template <int dim>
    void
    compute_violations(const ContactBoundary<dim>    &boundary,
                       const AdhesionIntegral<dim>   &adhesion,
                       const dealii::Vector<double>  &s,
                       const LawScales               &scales,
                       std::vector<ContactNodeState> &nodes)
    {
      const unsigned int n = static_cast<unsigned int>(nodes.size());

      // What is needed at fixed displacements is enough. It is exactly zero
      // for a node on the graph.
      std::vector<double> lower(n, 0.);
      std::vector<double> upper(n, 0.);
      for (unsigned int i = 0; i < n; ++i)
        {
          const double force_distance =
            distance(nodes[i].normal_force, nodes[i].allowed_force);
          if (force_distance > 0.)
            upper[i] =
              force_distance / (scales.traction * boundary.nodes[i].measure);
          if (s(i) > 0.)
            upper[i] = std::max(upper[i], s(i) / scales.length);
          if (upper[i] > 0.)
            lower[i] = std::numeric_limits<double>::min();
        }

      // The exponents of double are 2^11, its mantissa has 2^53 values.
      std::vector<double> delta(n);
      std::vector<double> radius(n);
      for (unsigned int step = 0; step < 11 + 53; ++step)
        {
          for (unsigned int i = 0; i < n; ++i)
            {
              delta[i]  = std::sqrt(lower[i]) * std::sqrt(upper[i]);
              radius[i] = delta[i] * scales.length;
            }
          const std::vector<Interval> intervals =
            adhesion.force_intervals(s, radius);
          for (unsigned int i = 0; i < n; ++i)
            {
              const Interval allowed =
                unbounded_above_if(s(i) >= -radius[i], intervals[i]);
              const bool enough =
                s(i) <= radius[i] &&
                distance(nodes[i].normal_force, allowed) <=
                  delta[i] * scales.traction * boundary.nodes[i].measure;
              (enough ? upper : lower)[i] = delta[i];
            }
        }

      for (unsigned int i = 0; i < n; ++i)
        nodes[i].violation = upper[i];
    }



    /// Largest |A u - f| where the body is free and where it is supported or
    /// touches the foundation.
    struct LargestResiduals
    {
      double free      = 0.;
      double supported = 0.;
    };



    template <int dim>
    LargestResiduals
    largest_residuals(const ElasticProblem<dim>    &problem,
                      const dealii::Vector<double> &residual)
    {
      std::vector<bool> supported(problem.n_dofs(), false);
      for (const auto &node : problem.contact_boundary().nodes)
        supported[node.dof] = true;

      LargestResiduals result;
      for (unsigned int i = 0; i < problem.n_dofs(); ++i)
        {
          double &largest = supported[i] || problem.is_constrained(i) ?
                              result.supported :
                              result.free;
          largest         = std::max(largest, std::abs(residual(i)));
        }
      return result;
    }



    template <int dim>
    void
    compute_force_balance(const ElasticProblem<dim>    &problem,
                          const dealii::Vector<double> &residual,
                          const double                  load_factor,
                          Verification<dim>            &result)
    {
      std::vector<bool> is_normal(problem.n_dofs(), false);
      for (const auto &node : problem.contact_boundary().nodes)
        is_normal[node.dof] = true;

      // What the supports and the foundation exert is the residual at their
      // degrees of freedom; all of it at a vertex with a contact node comes
      // from the foundation.
      dealii::Vector<double>    clamped(problem.n_dofs());
      dealii::Vector<double>    contact(problem.n_dofs());
      std::vector<unsigned int> component(problem.n_dofs());
      for (const auto &cell : problem.dof_handler().active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          {
            bool has_contact_node = false;
            for (unsigned int d = 0; d < dim; ++d)
              has_contact_node |= is_normal[cell->vertex_dof_index(v, d)];

            for (unsigned int d = 0; d < dim; ++d)
              {
                const auto dof = cell->vertex_dof_index(v, d);
                component[dof] = d;
                if (is_normal[dof] || problem.is_constrained(dof))
                  (has_contact_node ? contact : clamped)(dof) = residual(dof);
              }
          }

      const auto resultant = [&](const dealii::Vector<double> &forces) {
        const dealii::Vector<double> cartesian =
          problem.cartesian_forces(forces);
        dealii::Tensor<1, dim> sum;
        for (unsigned int i = 0; i < cartesian.size(); ++i)
          sum[component[i]] += cartesian(i);
        return sum;
      };

      result.applied_force    = load_factor * problem.total_load();
      result.clamped_reaction = resultant(clamped);
      result.contact_reaction = resultant(contact);

      // Resultants can vanish where forces do not.
      dealii::Vector<double> supports = clamped;
      supports += contact;
      const double scale =
        supports.l1_norm() +
        std::abs(load_factor) * problem.applied_nodal_forces().l1_norm();
      const double imbalance = (result.applied_force + result.clamped_reaction +
                                result.contact_reaction)
                                 .norm();
      result.force_imbalance = imbalance > 0. ? imbalance / scale : 0.;
    }
  } // namespace



  template <int dim>
  Verification<dim>
  verify(const ElasticProblem<dim>    &problem,
         const AdhesionIntegral<dim>  &adhesion,
         const AdhesiveLaw            &law,
         const dealii::Vector<double> &u,
         const double                  load_factor,
         const double                  tolerance)
  {
    if (!std::all_of(u.begin(), u.end(), [](const double x) {
          return std::isfinite(x);
        }))
      throw std::invalid_argument(
        "The displacement is not finite and cannot be verified: the data of the "
        "scene are too large or too small for double precision.");

    const ContactBoundary<dim>  &boundary = problem.contact_boundary();
    const dealii::Vector<double> residual = problem.residual(u, load_factor);

    dealii::Vector<double> s(static_cast<unsigned int>(boundary.nodes.size()));
    for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
      s(i) = u(boundary.nodes[i].dof);
    const std::vector<Interval> forces = adhesion.force_intervals(s, 0.);

    Verification<dim> result;
    result.penetration = 0.;
    for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
      {
        ContactNodeState node;
        node.u_nu          = s(i);
        node.normal_force  = -residual(boundary.nodes[i].dof);
        node.allowed_force = unbounded_above_if(s(i) >= 0., forces[i]);
        result.nodes.push_back(node);
        result.penetration = std::max(result.penetration, s(i));
      }

    const LargestResiduals largest = largest_residuals(problem, residual);
    const LawScales        scales =
      law_scales(law, boundary, result.nodes, largest.supported);
    compute_violations(boundary, adhesion, s, scales, result.nodes);

    result.law_violation = 0.;
    for (ContactNodeState &node : result.nodes)
      {
        node.state = bond_state(node, law, scales, s.linfty_norm(), tolerance);
        result.law_violation = std::max(result.law_violation, node.violation);
      }

    result.equilibrium_residual =
      largest.free > 0. ?
        largest.free / std::max(largest.free, largest.supported) :
        0.;
    result.contact_residual = result.law_violation;
    if (largest.supported > 0.)
      result.contact_residual *= std::min(
        1., scales.traction * largest_measure(boundary) / largest.supported);
    compute_force_balance(problem, residual, load_factor, result);
    return result;
  }



  template struct Verification<2>;
  template struct Verification<3>;
  template Verification<2>
  verify(const ElasticProblem<2> &,
         const AdhesionIntegral<2> &,
         const AdhesiveLaw &,
         const dealii::Vector<double> &,
         const double,
         const double);
  template Verification<3>
  verify(const ElasticProblem<3> &,
         const AdhesionIntegral<3> &,
         const AdhesiveLaw &,
         const dealii::Vector<double> &,
         const double,
         const double);
} // namespace Debond
