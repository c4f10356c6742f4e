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
    // Only the offsets of the points depend on the factor. The memory stays, as
    // the points are the same at each factor.
    AdhesionIntegral result(*this);
    result.contact_points.set_factor(factor);
    result.update();
    return result;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::break_for_good(const VectorView &s)
  {
    // The memory of a point is the least stretch that it has ever had, so it
    // only falls, and a second call with the same s changes nothing. Where
    // there is no memory yet, reached is 0, which no stretch at s <= 0 exceeds.
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
    // The sums at s = 0 contain what bonds have dissipated, so they follow the
    // memory.
    broken = memory;
    update();
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::update()
  {
    // Phi(0) is not zero in two cases only. A vertex with a prescribed
    // displacement stretches the bonds beside it whatever s is, and bonds with
    // a memory have dissipated energy. Otherwise there is nothing to be summed
    // up, nor are there memories to be gathered.
    phi_at_zero = 0.;
    if (contact_boundary().held_vertices.empty() && broken.empty())
      return;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n_nodes());
    phi_at_zero                = value(zero);
    if (broken.empty())
      return;
    // The largest memory that a node has by the points of the faces around it:
    // a node counts as broken where all of them say so.
    reached_of_nodes.assign(n_nodes(), -std::numeric_limits<double>::max());
    for (const Face &face : contact_boundary().faces)
      {
        const auto memory = contact_points.coefficients(face, broken);
        for (unsigned int k = 0; k < contact_boundary().n_face_nodes(); ++k)
          if (!face.is_held(k))
            {
              double &reached = reached_of_nodes[face.node(k)];
              reached         = std::max(reached, std::min(memory[k], 0.));
            }
      }
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::reached_at(const Face        &face,
                                    const unsigned int vertex) const
  {
    if (broken.empty())
      return 0.;
    if (!face.is_held(vertex))
      return reached(face.nodes[vertex]);
    return std::min(contact_points.coefficients(face, broken)[vertex], 0.);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::value(const VectorView &s) const
  {
    // This is the quadrature of the last term of J. Bonds that vary have the
    // energy times j_1(s / stretch), so that one law serves all points and only
    // two numbers a point are stored.
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
    // By the chain rule the derivative of j_1(s / stretch) has the factor 1 /
    // stretch, which is part of force(). At a kink (9) allows an interval of
    // tractions; the bundle methods ask for one element only, and the law takes
    // the one on the side of 0.
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
    // This is the E of the majorant 1/2 s'E s - b's of Phi: the law of each
    // point is replaced by the flattest quadratic that touches it at s and is
    // nowhere below it. It is never negative, so S + E stays definite if S is.
    return matrix(s, [this](const double stretch, const double reached) {
      return law.curvature(stretch, reached);
    });
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::second_derivative(const VectorView &s) const
  {
    // Where bonds soften this is less than curvature(), and S + Phi'' may be
    // indefinite. That is what the search along lines and the test for a local
    // minimum have to see.
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
    // Stretches are affine in s, so each point moves on a straight way to the
    // end of its piece. Up to the first arrival Phi is one smooth function.
    // Points without bonds have no kink. The offset is part of
    // point.stretch(ds), but it does not move, so it is taken off again.
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

    // This is the discrete form of (9). An equilibrium may use any traction
    // that the law allows, at each point independently of the others, so that
    // the interval of a node is the sum of theirs. Values of the shape
    // functions are not negative, which keeps lower ends below upper ends.
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
