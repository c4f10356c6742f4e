// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/adhesion_integral.h>

#include <algorithm>
#include <limits>

namespace Debond
{
  template <int dim>
  AdhesionIntegral<dim>::AdhesionIntegral(
    const ContactBoundary<dim>   &contact_boundary,
    const AdhesiveLaw            &adhesive_law,
    const ContactQuadrature<dim> &quadrature_rule,
    const BondField<dim>         *bond_field)
    : contact_points(contact_boundary, quadrature_rule, bond_field)
    , law(adhesive_law)
  {
    update();
  }



  template <int dim>
  AdhesionIntegral<dim>
  AdhesionIntegral<dim>::at(const double factor) const
  {
    // The memory stays: the points are the same at each factor.
    AdhesionIntegral result(*this);
    result.contact_points.set_factor(factor);
    result.update();
    return result;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::break_for_good(const VectorView &s)
  {
    BondMemory memory;
    for_each_point(s, [&](const auto &, double stretch, double reached) {
      memory.push_back(std::min(reached, stretch));
    });
    set_memory(memory);
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::set_memory(const BondMemory &memory)
  {
    broken = memory;
    update();
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::update()
  {
    phi_at_zero = 0.;
    if (contact_boundary().held_vertices.empty() && broken.empty())
      return;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n_nodes());
    phi_at_zero                = value(zero);
    // The largest memory around a node: a node counts as broken where all bonds
    // around it are.
    reached_of_nodes.assign(n_nodes(), -std::numeric_limits<double>::max());
    for_each_point(zero, [&](const auto &point, double, double reached) {
      for (unsigned int k = 0; k < point.n_nodes; ++k)
        reached_of_nodes[point.index[k]] =
          std::max(reached_of_nodes[point.index[k]], reached);
    });
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::reached_at(const Face        &face,
                                    const unsigned int vertex) const
  {
    if (!face.is_held(vertex))
      return reached(face.nodes[vertex]);
    if (!contact_points.is_nodal())
      return 0.;
    Barycentric place = {};
    place[vertex]     = 1.;
    return reached_at(face, place);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::value(const VectorView &s) const
  {
    double sum = 0.;
    for_each_point(s, [&](const auto &point, double stretch, double reached) {
      sum += point.weight * point.bonds.energy * law.value(stretch, reached);
    });
    return sum;
  }



  template <int dim>
  Eigen::VectorXd
  AdhesionIntegral<dim>::subgradient(const VectorView &s) const
  {
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(s.size());
    for_each_point(s, [&](const auto &point, double stretch, double reached) {
      const double force = point.force() * law.derivative(stretch, reached);
      for (unsigned int k = 0; k < point.n_nodes; ++k)
        xi(point.index[k]) += point.shape[k] * force;
    });
    return xi;
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::curvature(const VectorView &s) const
  {
    return matrix(s, [this](const double stretch, const double reached) {
      return law.curvature(stretch, reached);
    });
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::second_derivative(const VectorView &s) const
  {
    return matrix(s, [this](const double stretch, const double reached) {
      return law.second_derivative(stretch, reached);
    });
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::first_change(const VectorView &s,
                                      const VectorView &ds,
                                      const double      limit) const
  {
    double first = limit;
    for_each_point(s, [&](const auto &point, double stretch, double reached) {
      if (point.bonds.energy > 0.)
        first = std::min(first,
                         law.pieces()
                           .piece_at(stretch, reached)
                           .way_to_end(stretch,
                                       point.stretch(ds) -
                                         point.offset / point.bonds.stretch));
    });
    return first;
  }



  template <int dim>
  std::vector<Interval>
  AdhesionIntegral<dim>::force_intervals(const VectorView          &s,
                                         const std::vector<double> &delta) const
  {
    AssertDimension(delta.size(), n_nodes());

    std::vector<Interval> forces(n_nodes(), Interval{0., 0.});
    for_each_point(s, [&](const auto &point, double stretch, double reached) {
      for (unsigned int k = 0; k < point.n_nodes; ++k)
        {
          const unsigned int node = point.index[k];
          // Each node's radius is that of its own force: how far s may be wrong
          // differs from node to node.
          const Interval traction =
            law.goldstein_interval(stretch,
                                   delta[node] / point.bonds.stretch,
                                   reached);
          forces[node].lower += point.force() * point.shape[k] * traction.lower;
          forces[node].upper += point.force() * point.shape[k] * traction.upper;
        }
    });
    return forces;
  }



  template class AdhesionIntegral<2>;
  template class AdhesionIntegral<3>;
} // namespace Debond
