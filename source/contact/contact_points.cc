// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/contact/contact_points.h>

#include <Eigen/QR>

namespace Debond
{
  template <int dim>
  ContactPoints<dim>::ContactPoints(
    const ContactBoundary<dim>   &contact_boundary,
    const AdhesiveLaw            &law,
    const ContactQuadrature<dim> &quadrature_rule,
    const BondField<dim>         *bond_field)
    : contact(contact_boundary)
    , law(law)
    , quadrature(quadrature_rule)
    , field(bond_field)
  {
    // Nodes need their mean bonds whatever the quadrature is: checks of nodes
    // scale by them.
    collect_bonds();
    collect_points();
  }



  template <int dim>
  void
  ContactPoints<dim>::set_factor(const double factor)
  {
    // Prescribed displacements are parts of the points' offsets, which are
    // computed anew. Without held vertices nothing in the points depends on the
    // load.
    load_factor = factor;
    if (!contact.held_vertices.empty())
      collect_points();
  }



  template <int dim>
  void
  ContactPoints<dim>::set_modes(const std::vector<double> &by_point)
  {
    if (modes == by_point)
      return;
    modes = by_point;
    collect_points();
    // Between points a node has the mode of the next one.
    modes_of_nodes.assign(contact.nodes.size(), 0.);
    for (const Face &face : contact.faces)
      for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
        if (!face.is_held(k))
          modes_of_nodes[face.node(k)] =
            modes[nearest(face, coefficient_place<dim>(k))];
  }



  template <int dim>
  BondScale
  ContactPoints<dim>::with_law(BondScale bonds) const
  {
    // Few bonds have a tail of their own, and the law of all others is not
    // owned by them.
    bonds.law =
      bonds.tail == 1. ?
        std::shared_ptr<const AdhesiveLaw>(std::shared_ptr<void>(), &law) :
        std::make_shared<const AdhesiveLaw>(law.with_tail(bonds.tail));
    return bonds;
  }



  template <int dim>
  void
  ContactPoints<dim>::collect_bonds()
  {
    if (field == nullptr)
      return;

    // What bonds take on the first piece and beyond, if they soften and break.
    const bool softens =
      law.softens() && std::isfinite(law.pieces().largest_value());
    const double stored = softens ? law.value(law.pieces()[0].lower) : 1.;
    const double taken  = softens ? law.pieces().largest_value() - stored : 0.;

    // The bonds of the faces around a vertex, each as often as its measure:
    // stiffness, strength, and energy, and what belongs to each of them.
    struct Sum
    {
      BondScale first;
      bool      is_mixed = false;
      double    measure = 0., stiffness = 0., strength = 0., energy = 0.;
      double    whole = 0., shear = 0., shear_energy = 0.;
      double    energy_ratio = 0., strength_ratio = 0.;

      void
      add(const BondScale &bonds, const double more, const double per_energy)
      {
        if (measure == 0.)
          first = bonds;
        is_mixed = is_mixed || bonds.energy != first.energy ||
                   bonds.length != first.length || bonds.shear != first.shear ||
                   bonds.shear_energy != first.shear_energy ||
                   bonds.tail != first.tail ||
                   bonds.energy_ratio != first.energy_ratio ||
                   bonds.strength_ratio != first.strength_ratio;
        const double here = more * bonds.energy;
        measure += more;
        stiffness += here / (bonds.length * bonds.length);
        strength += here / bonds.length;
        energy += here;
        whole += here * per_energy;
        shear += here / (bonds.length * bonds.length) * bonds.shear;
        shear_energy += more * bonds.shear_energy;
        energy_ratio += here * per_energy * bonds.energy_ratio;
        strength_ratio += here / bonds.length * bonds.strength_ratio;
      }
    };
    const auto add = [&](const BondScale &bonds, const double more, Sum &sum) {
      sum.add(bonds, more, stored + bonds.tail * taken);
    };
    const auto mean = [&](const Sum &sum) -> BondScale {
      // Equal bonds keep their last digits.
      if (!sum.is_mixed)
        return sum.first;
      if (sum.energy == 0.)
        return {0., 1.};
      const double length = softens ? sum.strength / sum.stiffness :
                                      std::sqrt(sum.energy / sum.stiffness);
      BondScale    result = {softens ?
                               sum.stiffness * length * length / sum.measure :
                               sum.energy / sum.measure,
                          length,
                          sum.shear / sum.stiffness,
                          sum.shear_energy / sum.measure};
      if (softens)
        result.tail =
          (sum.whole / (result.energy * sum.measure) - stored) / taken;
      // Where only other numbers differ the tail is 1 but for rounding.
      if (std::abs(result.tail - 1.) < Tolerance::rounding_of_data)
        result.tail = 1.;
      result.energy_ratio   = sum.energy_ratio / sum.whole;
      result.strength_ratio = sum.strength_ratio / sum.strength;
      return result;
    };
    // Where boundaries with different bonds meet, a vertex has the bonds of
    // each of them. Nodal quadrature needs one law there. The mean stiffness a
    // = energy / length^2 and the mean energy keep what the bonds are as
    // springs and what it takes to break them; the threshold follows from these
    // two, and of bonds that soften the strength has its mean as well. The
    // means are weighted by the integral of the vertex's function on each face,
    // as the energy of the vertex in Phi is.
    std::vector<Sum> nodes(contact.nodes.size());
    std::vector<Sum> held(contact.held_vertices.size());
    // The field is asked with the boundary of each face, as at such a vertex it
    // has a value for each of them.
    for (const Face &face : contact.faces)
      for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
        if (!face.is_held(k))
          add(field->at(contact.nodes[face.node(k)].position, face.id),
              contact.integral(face, k),
              nodes[face.node(k)]);
        else if (!held.empty())
          add(field->at(contact.held_vertices[face.held_at(k)].position,
                        face.id),
              contact.integral(face, k),
              held[face.held_at(k)]);
        else if (k < dim)
          // A field has to have a value at all vertices, so that a fault in it
          // does not depend on the supports.
          field->at(face.vertices[k], face.id);

    for (const Sum &sum : nodes)
      bonds_of_nodes.push_back(with_law(mean(sum)));
    for (const Sum &sum : held)
      bonds_of_held.push_back(with_law(mean(sum)));
  }



  template <int dim>
  void
  ContactPoints<dim>::collect_points()
  {
    // With nodal quadrature the faces around a node add their weights to one
    // point. Phi then is a sum of functions of one component of s each, on
    // which search and proof rely, and E is diagonal. As several points of
    // faces become one, `places` keeps where each of them went.
    places.clear();
    points.assign(is_nodal() ? contact.nodes.size() : 0, ContactPoint<dim>());
    for (const Face &face : contact.faces)
      for (const auto &in_rule : quadrature.points())
        {
          // A coefficient whose shape function is zero at the point is left
          // out, so that a point on a vertex depends on this vertex alone.
          const Trace shape = bernstein(in_rule.barycentric, contact.degree);
          ContactPoint<dim> point;
          point.weight = in_rule.weight * face.measure *
                         contact.density(face, in_rule.centroid);
          point.bonds    = in_opening_at(face, in_rule.barycentric);
          const auto add = [&](const unsigned int index, const unsigned int k) {
            point.index[point.n_entries] = index;
            point.shape[point.n_entries] = shape[k];
            ++point.n_entries;
          };
          // Unknowns first, then what is held, whose forces held_forces() asks
          // for.
          for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
            if (!face.is_held(k) && shape[k] != 0.)
              add(face.node(k), k);
          point.n_nodes = point.n_entries;
          for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
            if (face.is_held(k) && shape[k] != 0.)
              {
                point.offset += shape[k] * held_trace(face, k);
                add(face.held_at(k), k);
              }
          add_slip(face, shape, point);

          // A point on a vertex has the bonds of all faces around it.
          if (is_nodal() && point.n_nodes == 1)
            {
              ContactPoint<dim> &at_node = points[point.index[0]];
              // The point of the node is replaced by this one, with the sum of
              // the weights of all faces so far. Displacements along the
              // boundary are those of the last face that has bonds in shear.
              point.weight += at_node.weight;
              point.bonds = field == nullptr ? with_law({}) :
                                               bonds_of_nodes[point.index[0]];
              if (!point.shears())
                {
                  point.slip        = at_node.slip;
                  point.held_slip   = at_node.held_slip;
                  point.slip_offset = at_node.slip_offset;
                }
              at_node = point;
              places.push_back(point.index[0]);
              continue;
            }
          // A point on a held vertex depends on no unknown, and its first entry
          // is that vertex. It stays one point a face: their energies and
          // forces add up anyway.
          if (is_nodal() && !bonds_of_held.empty())
            point.bonds = bonds_of_held[point.index[0]];
          places.push_back(static_cast<unsigned int>(points.size()));
          points.push_back(point);
        }
    separate_shear();
    if (modes.empty() && !depends_on_mode())
      return;
    in_opening.clear();
    for (const ContactPoint<dim> &point : points)
      in_opening.push_back(point.bonds);
    for (std::size_t q = 0; q < modes.size(); ++q)
      points[q].bonds = at_mode(q, modes[q]);
  }



  template <int dim>
  void
  ContactPoints<dim>::add_slip(const Face        &face,
                               const Trace       &shape,
                               ContactPoint<dim> &point) const
  {
    // Coefficients have the tangents of their own vertex, whose normal may be
    // the mean of several faces' normals. The rotation that takes that normal n
    // to the face's normal N takes a tangent t into the plane of the face. If
    // it turns in the plane of both, t becomes t - (t.N) / (1 + n.N) (n + N),
    // as t.n = 0.
    if (point.bonds.shear == 0.)
      return;
    for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
      {
        const bool is_held = face.is_held(k);
        if (shape[k] == 0. || (is_held && contact.held_vertices.empty()))
          continue;
        // Nodes and held vertices have tangents alike. A tangent that is
        // prescribed is part of the offset, which grows with the load.
        const auto add = [&](const auto &vertex) {
          for (const auto &tangent : vertex.tangents)
            {
              const typename ContactPoint<dim>::Slip slip = {
                tangent.index,
                shape[k] *
                  (tangent.direction - tangent.direction * face.normal /
                                         (1. + vertex.normal * face.normal) *
                                         (vertex.normal + face.normal))};
              (tangent.is_held ? point.held_slip : point.slip).push_back(slip);
              if (tangent.is_held)
                point.slip_offset +=
                  load_factor *
                  contact.held_vertices[tangent.index].normal_displacement *
                  slip.direction;
            }
        };
        if (is_held)
          add(contact.held_vertices[face.held_at(k)]);
        else
          add(contact.nodes[face.node(k)]);
      }
  }



  template <int dim>
  void
  ContactPoints<dim>::separate_shear()
  {
    // Points that are appended here are behind all of the rule's, so that
    // `places` still leads to the latter. A point of bonds in shear has no
    // normal displacement, and its opening is |t|.
    for (std::size_t q = 0, n = points.size(); q < n; ++q)
      if (const BondScale bonds = points[q].bonds;
          bonds.shear_energy > 0. && points[q].shears())
        {
          // The law of this energy whose stiffness is that in shear.
          ContactPoint<dim> &normal = points[q];
          ContactPoint<dim>  shear;
          shear.weight = normal.weight;
          shear.bonds  = bonds.in_shear();
          std::swap(shear.slip, normal.slip);
          std::swap(shear.held_slip, normal.held_slip);
          std::swap(shear.slip_offset, normal.slip_offset);
          points.push_back(shear);
        }
  }



  template <int dim>
  ContactPoint<dim>
  ContactPoints<dim>::point_at(const Face &face, const Barycentric &place) const
  {
    // A point that need not be one of the rule, for results at other places.
    // Held coefficients are in its offset.
    const Trace       shape = bernstein(place, contact.degree);
    ContactPoint<dim> point;
    point.bonds = bonds_at(face, place);
    for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
      if (face.is_held(k))
        point.offset += shape[k] * held_trace(face, k);
      else if (shape[k] != 0.)
        {
          point.index[point.n_nodes]   = face.node(k);
          point.shape[point.n_nodes++] = shape[k];
        }
    point.n_entries = point.n_nodes;
    // Those that break by themselves do not stretch others.
    if (point.bonds.shear_energy == 0.)
      add_slip(face, shape, point);
    return point;
  }



  template <int dim>
  unsigned int
  ContactPoints<dim>::nearest(const Face &face, const Barycentric &place) const
  {
    // The least |r - p|^2 / 2 less |p|^2 / 2, which has no rounding at
    // vertices.
    const auto  &rule  = quadrature.points();
    unsigned int next  = 0;
    double       least = infinity;
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        double sum = 0.;
        for (unsigned int k = 0; k < dim; ++k)
          sum +=
            rule[q].barycentric[k] * (0.5 * rule[q].barycentric[k] - place[k]);
        if (sum < least)
          {
            least = sum;
            next  = q;
          }
      }
    // Faces are in one array, and all have the points of the rule in its order.
    return places[(&face - contact.faces.data()) * rule.size() + next];
  }



  template <int dim>
  BondScale
  ContactPoints<dim>::in_opening_at(const Face        &face,
                                    const Barycentric &place) const
  {
    dealii::Point<dim> position;
    for (unsigned int k = 0; k < dim; ++k)
      position += place[k] * face.vertices[k];
    return bonds_at(position, face.id);
  }



  template <int dim>
  BondScale
  ContactPoints<dim>::bonds_at(const Face &face, const Barycentric &place) const
  {
    const BondScale bonds = in_opening_at(face, place);
    return modes.empty() ? bonds : at_mode(bonds, modes[nearest(face, place)]);
  }



  template <int dim>
  typename ContactPoints<dim>::Trace
  ContactPoints<dim>::coefficients(const Face                &face,
                                   const std::vector<double> &values) const
  {
    // A rule with as many points as coefficients, or more, determines a
    // polynomial; of fewer points, as of one in the middle of a face, each
    // coefficient takes the largest value, which for memories is the least
    // damage.
    const auto        &rule = quadrature.points();
    const unsigned int n    = contact.n_face_nodes();
    Eigen::MatrixXd    shapes(rule.size(), n);
    Eigen::VectorXd    at_points(rule.size());
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const auto shape = bernstein(rule[q].barycentric, contact.degree);
        for (unsigned int k = 0; k < n; ++k)
          shapes(q, k) = shape[k];
        // The point nearest to a point of the rule is that point, or with nodal
        // quadrature its node.
        at_points(q) = values[nearest(face, rule[q].barycentric)];
      }
    Trace result;
    result.fill(at_points.maxCoeff());
    if (rule.size() >= n)
      Eigen::Map<Eigen::VectorXd>(result.data(), n) =
        shapes.colPivHouseholderQr().solve(at_points);
    return result;
  }



  template <int dim>
  double
  ContactPoints<dim>::held_trace(const Face &face, const unsigned int k) const
  {
    if (contact.held_vertices.empty())
      return 0.;
    // In terms of the lifting this is u_nu - g. Prescribed displacements grow
    // with the factor of the load, the gap does not.
    const auto &held = contact.held_vertices[face.held_at(k)];
    return load_factor * held.normal_displacement - held.gap;
  }



  template <int dim>
  typename ContactPoints<dim>::Trace
  ContactPoints<dim>::trace_on(const Face &face, const VectorView &s) const
  {
    // Together unknown and prescribed coefficients are the whole trace w_nu of
    // the face, which results between the nodes are computed from.
    Trace trace = {};
    for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
      trace[k] = face.is_held(k) ? held_trace(face, k) : s(face.node(k));
    return trace;
  }



  template <int dim>
  double
  ContactPoints<dim>::trace(const Face        &face,
                            const Barycentric &place,
                            const VectorView  &s) const
  {
    const Trace coefficients = trace_on(face, s);
    const Trace shape        = bernstein(place, contact.degree);
    double      result       = 0.;
    for (unsigned int k = 0; k < contact.n_face_nodes(); ++k)
      result += shape[k] * coefficients[k];
    return result;
  }



  DEBOND_INSTANTIATE_CLASS(ContactPoints);
} // namespace Debond
