// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/adhesion_integral.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace Debond
{
  template <int dim>
  AdhesionIntegral<dim>::AdhesionIntegral(
    const ContactBoundary<dim>   &contact_boundary,
    const AdhesiveLaw            &adhesive_law,
    const ContactQuadrature<dim> &quadrature_rule,
    const BondField<dim>         *bond_field)
    : boundary(contact_boundary)
    , law(adhesive_law)
    , quadrature(quadrature_rule)
    , field(bond_field)
  {
    collect_bonds();
    update_points();
  }



  template <int dim>
  unsigned int
  AdhesionIntegral<dim>::n_nodes() const
  {
    return static_cast<unsigned int>(boundary.nodes.size());
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::collect_bonds()
  {
    if (field == nullptr)
      return;

    struct Sum
    {
      BondScale first;
      bool      is_mixed  = false;
      double    measure   = 0.;
      double    stiffness = 0.; ///< times measure, as is the energy
      double    energy    = 0.;
    };
    std::vector<Sum> nodes(boundary.nodes.size());
    std::vector<Sum> held(boundary.held_vertices.size());
    const auto       add = [](const BondScale &bonds,
                        const double     measure,
                        Sum             &sum) {
      if (sum.measure == 0.)
        sum.first = bonds;
      sum.is_mixed = sum.is_mixed || bonds.energy != sum.first.energy ||
                     bonds.stretch != sum.first.stretch;
      sum.measure += measure;
      sum.stiffness += measure * bonds.energy / (bonds.stretch * bonds.stretch);
      sum.energy += measure * bonds.energy;
    };
    const auto at = [this](const auto               &face,
                           const dealii::Point<dim> &position) {
      return field->at(position, face.id);
    };
    for (const auto &face : boundary.faces)
      for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
        if (!face.is_held(k))
          add(at(face, boundary.nodes[face.node(k)].position),
              face.measure,
              nodes[face.node(k)]);
        else if (!held.empty())
          add(at(face, boundary.held_vertices[face.held_at(k)].position),
              face.measure,
              held[face.held_at(k)]);
        else if (k < dim)
          // What is said of a face asks for the bonds of all its vertices.
          at(face, face.vertices[k]);

    const auto mean = [](const Sum &sum) -> BondScale {
      if (!sum.is_mixed)
        return sum.first;
      if (sum.energy == 0.)
        return {0., 1.};
      return {sum.energy / sum.measure, std::sqrt(sum.energy / sum.stiffness)};
    };
    for (const Sum &sum : nodes)
      bonds_of_nodes.push_back(mean(sum));
    for (const Sum &sum : held)
      bonds_of_held.push_back(mean(sum));
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::update_points()
  {
    collect_points();
    lump_nodal_points();
    if (!boundary.held_vertices.empty() || !broken.nodes.empty())
      phi_at_zero = energy(Eigen::VectorXd::Zero(boundary.nodes.size()));
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::break_for_good(const VectorView &s)
  {
    if (!quadrature.is_nodal())
      {
        broken.points.resize(point_list.size(), 0.);
        broken.nodes.assign(boundary.nodes.size(),
                            -std::numeric_limits<double>::max());
        for (unsigned int q = 0; q < point_list.size(); ++q)
          {
            const Point &point   = point_list[q];
            double      &reached = broken.points[q];
            reached = std::min(reached, point.trace(s) / point.bonds.stretch);
            for (unsigned int k = 0; k < point.n_nodes; ++k)
              broken.nodes[point.nodes[k]] =
                std::max(broken.nodes[point.nodes[k]], reached);
          }
        update_points();
        return;
      }

    broken.nodes.resize(boundary.nodes.size(), 0.);
    broken.held.resize(boundary.held_vertices.size(), 0.);
    const auto raise =
      [](const double trace, const BondScale &bonds, double &reached) {
        reached = std::min(reached, trace / bonds.stretch);
      };
    for (unsigned int i = 0; i < s.size(); ++i)
      raise(s(i), bonds_at(i), broken.nodes[i]);
    for (const auto &face : boundary.faces)
      for (unsigned int k = 0; k < dim; ++k)
        if (face.is_held(k) && !broken.held.empty())
          raise(held_trace(face, k),
                bonds_at(face, k),
                broken.held[face.held[k]]);
    update_points();
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::set_memory(const BondMemory &memory)
  {
    broken = memory;
    update_points();
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::reached_at(
    const typename ContactBoundary<dim>::Face &face,
    const unsigned int                         vertex) const
  {
    if (!face.is_held(vertex))
      return reached(face.nodes[vertex]);
    return broken.held.empty() ? 0. : broken.held[face.held[vertex]];
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::reached_at(
    const typename ContactBoundary<dim>::Face &face,
    const std::array<double, dim>             &barycentric) const
  {
    if (broken.nodes.empty())
      return 0.;
    if (quadrature.is_nodal())
      return reached_at(face,
                        static_cast<unsigned int>(
                          std::max_element(barycentric.begin(),
                                           barycentric.end()) -
                          barycentric.begin()));
    const auto  &points  = quadrature.points();
    unsigned int nearest = 0;
    double       least   = std::numeric_limits<double>::infinity();
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        dealii::Tensor<1, dim> way;
        for (unsigned int k = 0; k < dim; ++k)
          way += (points[q].barycentric[k] - barycentric[k]) *
                 (face.vertices[k] - face.vertices[0]);
        if (way.norm_square() < least)
          {
            least   = way.norm_square();
            nearest = q;
          }
      }
    return broken
      .points[(&face - boundary.faces.data()) * points.size() + nearest];
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::open_measure(const VectorView &s) const
  {
    const PiecewiseEnergy &branches = law.branches();
    double                 sum      = 0.;
    for (const Point &point : point_list)
      {
        const double trace = point.trace(s) / point.bonds.stretch;
        if (trace < 0. && (point.bonds.energy == 0. ||
                           branches.index(std::min(point.reached, trace)) + 1 ==
                             branches.size()))
          sum += point.weight;
      }
    return sum;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::first_change(const VectorView &s,
                                      const VectorView &ds,
                                      const double      limit) const
  {
    const PiecewiseEnergy &branches = law.branches();
    double                 first    = limit;
    for (const Point &point : point_list)
      if (point.bonds.energy > 0.)
        {
          const double trace = point.trace(s) / point.bonds.stretch;
          const double speed =
            (point.trace(ds) - point.offset) / point.bonds.stretch;
          first = std::min(
            first,
            branches.piece_at(trace, point.reached).way_to_end(trace, speed));
        }
    return first;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::dissipated_energy() const
  {
    double sum = 0.;
    if (!broken.nodes.empty())
      for (const Point &point : point_list)
        sum += point.weight * point.bonds.energy * law.value(0., point.reached);
    return sum;
  }



  template <int dim>
  BondScale
  AdhesionIntegral<dim>::bonds_at(
    const typename ContactBoundary<dim>::Face &face,
    const unsigned int                         vertex) const
  {
    // Only nodal quadrature has bonds of nodes.
    if (quadrature.is_nodal() && field != nullptr)
      {
        if (!face.is_held(vertex))
          return bonds_of_nodes[face.nodes[vertex]];
        if (!bonds_of_held.empty())
          return bonds_of_held[face.held[vertex]];
      }
    std::array<double, dim> barycentric = {};
    barycentric[vertex]                 = 1.;
    return bonds_of(face, barycentric);
  }



  template <int dim>
  AdhesionIntegral<dim>
  AdhesionIntegral<dim>::at(const double factor) const
  {
    AdhesionIntegral result(*this);
    result.load_factor = factor;
    if (!boundary.held_vertices.empty())
      result.update_points();
    return result;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::energy(const VectorView &s) const
  {
    double sum = 0.;
    for (const Point &point : point_list)
      sum += point.weight * point.bonds.energy *
             law.value(point.trace(s) / point.bonds.stretch, point.reached);
    return sum;
  }



  template <int dim>
  Eigen::VectorXd
  AdhesionIntegral<dim>::subgradient(const VectorView &s) const
  {
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(s.size());
    for (const Point &point : point_list)
      {
        const double force =
          point.weight * point.bonds.energy / point.bonds.stretch *
          law.derivative(point.trace(s) / point.bonds.stretch, point.reached);
        for (unsigned int k = 0; k < point.n_nodes; ++k)
          xi(point.nodes[k]) += point.shape[k] * force;
      }
    return xi;
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::curvature(const VectorView &s) const
  {
    return matrix(s, [this](const double trace, const Point &point) {
      return law.curvature(trace, point.reached);
    });
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::second_derivative(const VectorView &s) const
  {
    return matrix(s, [this](const double trace, const Point &point) {
      return law.second_derivative(trace, point.reached);
    });
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::least_second_derivative(const VectorView &s,
                                                 const double      part) const
  {
    return matrix(s, [this, part](const double trace, const Point &point) {
      return std::min(law.second_derivative((1. + part) * trace, point.reached),
                      law.second_derivative((1. - part) * trace,
                                            point.reached));
    });
  }



  template <int dim>
  Eigen::VectorXd
  AdhesionIntegral<dim>::lumped_weights() const
  {
    const unsigned int n = n_nodes();
    return matrix(Eigen::VectorXd::Zero(n),
                  [](const double, const Point &) { return 1.; }) *
           Eigen::VectorXd::Ones(n);
  }



  template <int dim>
  bool
  AdhesionIntegral<dim>::is_at_drop(const VectorView &s,
                                    const double      part) const
  {
    std::vector<double> drops;
    for (unsigned int k = 0; k + 1 < law.branches().size(); ++k)
      if (law.branches().has_drop(k))
        drops.push_back(law.branches()[k].lower);
    return std::any_of(
      point_list.begin(), point_list.end(), [&](const Point &point) {
        const double trace = point.trace(s) / point.bonds.stretch;
        return point.bonds.energy > 0. &&
               std::any_of(drops.begin(), drops.end(), [&](const double drop) {
                 return drop <= point.reached &&
                        std::abs(trace - drop) <= part * std::abs(trace);
               });
      });
  }



  template <int dim>
  template <typename Curvature>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::matrix(const VectorView &s,
                                const Curvature  &of_law) const
  {
    std::vector<Eigen::Triplet<double>> entries;
    for (const Point &point : point_list)
      {
        const double stretch   = point.bonds.stretch;
        const double curvature = point.weight * point.bonds.energy /
                                 (stretch * stretch) *
                                 of_law(point.trace(s) / stretch, point);
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
  AdhesionIntegral<dim>::force_intervals(const VectorView          &s,
                                         const std::vector<double> &delta) const
  {
    AssertDimension(delta.size(), boundary.nodes.size());

    std::vector<Interval> forces(boundary.nodes.size(), Interval{0., 0.});
    for (const Point &point : point_list)
      {
        const double stretch = point.bonds.stretch;
        const double trace   = point.trace(s) / stretch;
        for (unsigned int k = 0; k < point.n_nodes; ++k)
          {
            const unsigned int node = point.nodes[k];
            const Interval     traction =
              law.goldstein_interval(trace,
                                     delta[node] / stretch,
                                     point.reached);
            const double measure =
              point.weight * point.shape[k] * point.bonds.energy / stretch;
            forces[node].lower += measure * traction.lower;
            forces[node].upper += measure * traction.upper;
          }
      }
    return forces;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::Point::trace(const VectorView &s) const
  {
    double sum = offset;
    for (unsigned int k = 0; k < n_nodes; ++k)
      sum += shape[k] * s(nodes[k]);
    return sum;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::collect_points()
  {
    const unsigned int n_face_nodes = boundary.n_face_nodes();
    point_list.clear();
    for (const auto &face : boundary.faces)
      {
        for (const auto &quadrature_point : quadrature.points())
          {
            const Trace shape =
              bernstein(quadrature_point.barycentric, boundary.degree);
            Point point   = {};
            point.n_nodes = 0;
            point.weight  = quadrature_point.weight * face.measure;
            point.bonds   = bonds_of(face, quadrature_point.barycentric);
            for (unsigned int k = 0; k < dim; ++k)
              if (quadrature_point.barycentric[k] == 1.)
                {
                  point.bonds   = bonds_at(face, k);
                  point.reached = reached_at(face, k);
                }
            if (!broken.points.empty())
              point.reached = broken.points[point_list.size()];
            for (unsigned int k = 0; k < n_face_nodes; ++k)
              if (face.is_held(k))
                point.offset += shape[k] * held_trace(face, k);
              else if (shape[k] != 0.)
                {
                  point.nodes[point.n_nodes] = face.node(k);
                  point.shape[point.n_nodes] = shape[k];
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
    return std::all_of(point_list.begin(),
                       point_list.end(),
                       [](const Point &point) {
                         return point.n_nodes == 0 || point.is_on_a_node();
                       });
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::lump_nodal_points()
  {
    std::vector<double>    weights(boundary.nodes.size(), 0.);
    std::vector<BondScale> bonds(boundary.nodes.size());
    for (const Point &point : point_list)
      if (point.is_on_a_node())
        {
          weights[point.nodes[0]] += point.weight;
          bonds[point.nodes[0]] = point.bonds;
        }

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
          point.bonds    = bonds[node];
          point.reached  = reached(node);
          point_list.push_back(point);
        }
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::held_trace(
    const typename ContactBoundary<dim>::Face &face,
    const unsigned int                         k) const
  {
    if (boundary.held_vertices.empty())
      return 0.;
    const auto &held = boundary.held_vertices[face.held_at(k)];
    return load_factor * held.normal_displacement - held.gap;
  }



  template <int dim>
  BondScale
  AdhesionIntegral<dim>::bonds_of(
    const typename ContactBoundary<dim>::Face &face,
    const std::array<double, dim>             &barycentric) const
  {
    if (field == nullptr)
      return {};
    dealii::Point<dim> position;
    for (unsigned int k = 0; k < dim; ++k)
      position += barycentric[k] * face.vertices[k];
    return field->at(position, face.id);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::trace(const typename ContactBoundary<dim>::Face &face,
                               const std::array<double, dim> &barycentric,
                               const VectorView              &s) const
  {
    const Trace coefficients = trace_on(face, s);
    const Trace shape        = bernstein(barycentric, boundary.degree);
    double      result       = 0.;
    for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
      result += shape[k] * coefficients[k];
    return result;
  }



  template <int dim>
  typename ContactQuadrature<dim>::Trace
  AdhesionIntegral<dim>::trace_on(
    const typename ContactBoundary<dim>::Face &face,
    const VectorView                          &s) const
  {
    Trace trace = {};
    for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
      trace[k] = face.is_held(k) ? held_trace(face, k) : s(face.node(k));
    return trace;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::traction(
    const typename ContactBoundary<dim>::Face &face,
    const std::array<double, dim>             &barycentric,
    const VectorView                          &s) const
  {
    const BondScale bonds = bonds_of(face, barycentric);
    return bonds.energy / bonds.stretch *
           law.derivative(trace(face, barycentric, s) / bonds.stretch,
                          reached_at(face, barycentric));
  }



  template <int dim>
  std::vector<double>
  AdhesionIntegral<dim>::held_forces(const VectorView &s) const
  {
    std::vector<double> forces(boundary.held_vertices.size(), 0.);
    if (forces.empty())
      return forces;
    for (const auto &face : boundary.faces)
      {
        const unsigned int n_face_nodes = boundary.n_face_nodes();
        bool               is_held      = false;
        for (unsigned int k = 0; k < n_face_nodes; ++k)
          is_held |= face.is_held(k);
        if (!is_held)
          continue;
        const Trace trace = trace_on(face, s);
        std::size_t index =
          (&face - boundary.faces.data()) *
          (broken.points.empty() ? 0 : quadrature.points().size());
        for (const auto &point : quadrature.points())
          {
            BondScale   bonds = bonds_of(face, point.barycentric);
            const Trace shape = bernstein(point.barycentric, boundary.degree);
            double      at_point = 0.;
            for (unsigned int k = 0; k < n_face_nodes; ++k)
              at_point += shape[k] * trace[k];
            double reached = 0.;
            for (unsigned int k = 0; k < dim; ++k)
              if (point.barycentric[k] == 1.)
                {
                  bonds   = bonds_at(face, k);
                  reached = reached_at(face, k);
                }
            if (!broken.points.empty())
              reached = broken.points[index++];
            const double force =
              point.weight * face.measure * bonds.energy / bonds.stretch *
              law.derivative(at_point / bonds.stretch, reached);
            for (unsigned int k = 0; k < n_face_nodes; ++k)
              if (face.is_held(k))
                forces[face.held_at(k)] += shape[k] * force;
          }
      }
    return forces;
  }



  template class AdhesionIntegral<2>;
  template class AdhesionIntegral<3>;
} // namespace Debond
