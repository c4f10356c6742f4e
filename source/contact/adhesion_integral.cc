// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/adhesion_integral.h>

#include <algorithm>
#include <functional>

namespace Debond
{
  template <int dim>
  AdhesionIntegral<dim>::AdhesionIntegral(
    const ContactBoundary<dim>   &contact_boundary,
    const AdhesiveLaw            &adhesive_law,
    const ContactQuadrature<dim> &quadrature_rule)
    : boundary(contact_boundary)
    , law(adhesive_law)
    , quadrature(quadrature_rule)
  {
    if (!quadrature.depends_on_trace())
      {
        collect_points(dealii::Vector<double>(
          static_cast<unsigned int>(boundary.nodes.size())));
        lump_nodal_points();
      }
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::value(const dealii::Vector<double> &s) const
  {
    double sum = 0.;
    for (const Point &point : points(s))
      sum += point.weight * law.value(point.trace(s));
    return sum;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::subgradient(const dealii::Vector<double> &s,
                                     dealii::Vector<double>       &xi) const
  {
    AssertDimension(xi.size(), boundary.nodes.size());

    xi = 0.;
    for (const Point &point : points(s))
      {
        const double force = point.weight * law.derivative(point.trace(s));
        for (unsigned int k = 0; k < point.n_nodes; ++k)
          xi(point.nodes[k]) += point.shape[k] * force;
      }
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::curvature(const dealii::Vector<double> &s) const
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (const Point &point : points(s))
      {
        const double curvature = point.weight * law.curvature(point.trace(s));
        if (curvature != 0.)
          for (unsigned int k = 0; k < point.n_nodes; ++k)
            for (unsigned int l = 0; l < point.n_nodes; ++l)
              entries.emplace_back(point.nodes[k],
                                   point.nodes[l],
                                   curvature * point.shape[k] * point.shape[l]);
      }
    Eigen::SparseMatrix<double> result(s.size(), s.size());
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }



  template <int dim>
  std::vector<Interval>
  AdhesionIntegral<dim>::force_intervals(const dealii::Vector<double> &s,
                                         const double delta) const
  {
    return force_intervals(s,
                           std::vector<double>(boundary.nodes.size(), delta));
  }



  template <int dim>
  std::vector<Interval>
  AdhesionIntegral<dim>::force_intervals(const dealii::Vector<double> &s,
                                         const std::vector<double> &delta) const
  {
    AssertDimension(delta.size(), boundary.nodes.size());

    std::vector<Interval> forces(boundary.nodes.size(), Interval{0., 0.});
    for (const Point &point : points(s))
      {
        const double trace = point.trace(s);
        for (unsigned int k = 0; k < point.n_nodes; ++k)
          {
            const unsigned int node = point.nodes[k];
            const Interval     traction =
              law.goldstein_interval(trace, delta[node]);
            const double measure = point.weight * point.shape[k];
            forces[node].lower += measure * traction.lower;
            forces[node].upper += measure * traction.upper;
          }
      }
    return forces;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::Point::trace(const dealii::Vector<double> &s) const
  {
    double sum = 0.;
    for (unsigned int k = 0; k < n_nodes; ++k)
      sum += shape[k] * s(nodes[k]);
    return sum;
  }



  template <int dim>
  const std::vector<typename AdhesionIntegral<dim>::Point> &
  AdhesionIntegral<dim>::points(const dealii::Vector<double> &s) const
  {
    AssertDimension(s.size(), boundary.nodes.size());

    if (quadrature.depends_on_trace())
      collect_points(s);
    return point_list;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::collect_points(const dealii::Vector<double> &s) const
  {
    point_list.clear();
    for (const auto &face : boundary.faces)
      {
        std::array<double, dim> trace;
        for (unsigned int k = 0; k < dim; ++k)
          trace[k] = face.nodes[k] == dealii::numbers::invalid_unsigned_int ?
                       0. :
                       s(face.nodes[k]);

        for (const auto &quadrature_point : quadrature.points(trace))
          {
            Point point   = {};
            point.n_nodes = 0;
            point.weight  = quadrature_point.weight * face.measure;
            for (unsigned int k = 0; k < dim; ++k)
              if (face.nodes[k] != dealii::numbers::invalid_unsigned_int &&
                  quadrature_point.barycentric[k] != 0.)
                {
                  point.nodes[point.n_nodes] = face.nodes[k];
                  point.shape[point.n_nodes] = quadrature_point.barycentric[k];
                  ++point.n_nodes;
                }
            point_list.push_back(point);
          }
      }
  }



  template <int dim>
  bool
  AdhesionIntegral<dim>::Point::is_on_a_node() const
  {
    return n_nodes == 1 && shape[0] == 1.;
  }



  template <int dim>
  bool
  AdhesionIntegral<dim>::is_separable() const
  {
    // Points on clamped vertices have no node.
    return !quadrature.depends_on_trace() &&
           std::all_of(point_list.begin(),
                       point_list.end(),
                       [](const Point &point) {
                         return point.n_nodes == 0 || point.is_on_a_node();
                       });
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::lump_nodal_points()
  {
    std::vector<double> weights(boundary.nodes.size(), 0.);
    for (const Point &point : point_list)
      if (point.is_on_a_node())
        weights[point.nodes[0]] += point.weight;

    point_list.erase(std::remove_if(point_list.begin(),
                                    point_list.end(),
                                    std::mem_fn(&Point::is_on_a_node)),
                     point_list.end());

    for (unsigned int node = 0; node < weights.size(); ++node)
      if (weights[node] > 0.)
        {
          Point point    = {};
          point.n_nodes  = 1;
          point.nodes[0] = node;
          point.shape[0] = 1.;
          point.weight   = weights[node];
          point_list.push_back(point);
        }
  }



  template class AdhesionIntegral<2>;
  template class AdhesionIntegral<3>;
} // namespace Debond
