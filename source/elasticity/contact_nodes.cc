// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/contact_nodes.h>
#include <debond/elasticity/edge_coefficients.h>
#include <debond/mesh/field_value.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    /// A vertex of the contact boundary that is not clamped.
    template <int dim>
    struct ContactVertex
    {
      dealii::Point<dim> position;

      /// These are by its faces.
      std::vector<dealii::Tensor<1, dim>> normals;
      std::vector<double>                 measures;
      std::vector<double>                 gaps;

      /// On one of its faces u_tau = 0 holds.
      bool is_tangential_fixed = false;

      /// Bonds of one of its faces shear, or there is friction.
      bool has_tangents = false;

      std::vector<unsigned int> groups; ///< of its faces
      std::vector<unsigned int> nodes;  ///< of each group, or no_node
      std::vector<unsigned int> held;   ///< vertices of the groups without
    };



    /// The gap to the foundation below a point of the boundary.
    template <int dim>
    double
    gap_value(const Supports<dim>             &supports,
              const dealii::types::boundary_id id,
              const dealii::Point<dim>        &point)
    {
      const auto gap = supports.gaps.find(id);
      if (gap == supports.gaps.end())
        return 0.;
      try
        {
          return field_value(*gap->second.value, point);
        }
      catch (const std::invalid_argument &error)
        {
          throw SupportError(SupportError::Subject::gap,
                             gap->second.name,
                             error.what());
        }
    }



    /// The gap at a node of a face, of an edge its coefficient.
    template <int dim>
    double
    gap_at(const Supports<dim>     &supports,
           const BoundaryFace<dim> &face,
           const unsigned int       node)
    {
      // On a quadratic edge the unknown is a Bernstein coefficient of u_nu, and
      // so has the gap to be: u_nu <= g for all coefficients then gives it for
      // the interpolated gap at each point.
      const auto at = [&](const unsigned int k) {
        return gap_value(supports, face.id, face.positions[k]);
      };
      return face.gaps[node] +
             (node < dim ? at(node) : edge_coefficient<dim>(node, at));
    }



    /// Ranks of numbers, where those that differ by rounding share one.
    std::vector<unsigned int>
    ranks(const std::vector<double> &values, const double tolerance)
    {
      // Sorted values that differ from the one before by more than the
      // tolerance begin a new rank. Comparing with a tolerance directly would
      // be no order, as a chain of close values has ends that are not close. In
      // a chain all values share one rank here.
      std::vector<unsigned int> order(values.size());
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(),
                order.end(),
                [&](const unsigned int a, const unsigned int b) {
                  return values[a] < values[b];
                });

      std::vector<unsigned int> result(values.size(), 0);
      for (unsigned int k = 1; k < order.size(); ++k)
        result[order[k]] =
          result[order[k - 1]] +
          (values[order[k]] - values[order[k - 1]] > tolerance ? 1 : 0);
      return result;
    }



    /// The places of contact nodes in their order, the lexicographic one of
    /// their positions. Rounding of the coordinates, as in a turned body, must
    /// not change it: those that agree to 1e-10 of the contact boundary's size
    /// are the same, and nodes at the same place stay as they are.
    template <int dim>
    std::vector<unsigned int>
    contact_order(const std::vector<typename ContactBoundary<dim>::Node> &nodes)
    {
      // The coordinates of the nodes are replaced by their ranks, one axis
      // after the other, and these are compared lexicographically. Nodes at one
      // place, where sides of different normals meet, are equal and keep their
      // order by the stable sort, so that the order of s is the same on all
      // machines and in turned bodies.
      double size = 0.;
      for (const auto &node : nodes)
        size = std::max(size, node.position.distance(nodes[0].position));
      std::array<std::vector<unsigned int>, dim> coordinate_ranks;
      for (unsigned int d = 0; d < dim; ++d)
        {
          std::vector<double> coordinates;
          for (const auto &node : nodes)
            coordinates.push_back(node.position[d]);
          coordinate_ranks[d] =
            ranks(coordinates, Tolerance::same_coordinate * size);
        }
      std::vector<unsigned int> order(nodes.size());
      std::iota(order.begin(), order.end(), 0u);
      std::stable_sort(order.begin(),
                       order.end(),
                       [&](const unsigned int a, const unsigned int b) {
                         for (unsigned int d = 0; d < dim; ++d)
                           if (coordinate_ranks[d][a] != coordinate_ranks[d][b])
                             return coordinate_ranks[d][a] <
                                    coordinate_ranks[d][b];
                         return false;
                       });
      return order;
    }



    constexpr unsigned int no_node = dealii::numbers::invalid_unsigned_int;

    /// Goes from the faces to their vertices, from these to contact nodes, and
    /// with the nodes back to the faces.
    template <int dim>
    class ContactSpaceMaker
    {
    public:
      ContactSpaceMaker(const std::vector<BoundaryFace<dim>> &faces,
                        const unsigned int                    degree,
                        const BoundaryConditions             &conditions,
                        const Supports<dim>                  &supports,
                        const NodeSupports<dim>              &node_supports,
                        ConstrainedDofs<dim>                 &constrained)
        : faces(faces)
        , supports(supports)
        , node_supports(node_supports)
        , constrained(constrained)
        , places(faces.size())
      {
        // The vertices come from a map by the number of the node, so that
        // nodes, frames and constraints are made in that order on all ranks.
        // Slip is checked last, because it needs the groups of normals that
        // make_nodes() finds.
        boundary.degree   = degree;
        boundary.symmetry = conditions.symmetry;
        find_vertices(conditions);
        for (auto &[index, vertex] : vertices)
          make_nodes(index, vertex);
        check_slip(conditions);
      }

      ContactSpace<dim>
      space()
      {
        // Nodes are put in the order of their places here, and faces get the
        // numbers that the nodes have then. The vector of unknowns is s of all
        // nodes first, which have the bound 0, and then the tangential
        // displacements, which have none.
        std::vector<dealii::types::global_dof_index> dofs;
        std::vector<unsigned int>                    place(nodes.size());
        for (const unsigned int node : contact_order<dim>(nodes))
          {
            place[node] = static_cast<unsigned int>(boundary.nodes.size());
            boundary.nodes.push_back(nodes[node]);
            dofs.push_back(normal_dofs[node]);
          }
        add_faces(place);
        // Tangents are numbered as the vertices are, after the normals.
        const auto number = [&](auto &of_vertices) {
          for (auto &vertex : of_vertices)
            for (auto &tangent : vertex.tangents)
              if (!tangent.is_held)
                {
                  dofs.push_back(tangent.index);
                  tangent.index = boundary.n_unknowns();
                  ++boundary.n_tangents;
                }
        };
        number(boundary.nodes);
        number(boundary.held_vertices);
        // Vertices that are held at the foundation, without a gap and without
        // tangents, have an opening that is always zero, and bonds at them have
        // no energy and no force. What bonds between nodes pull at them with,
        // within a cell, is left in the reaction of the support. If all held
        // vertices are such, nobody who sums over them need see them.
        if (std::all_of(boundary.held_vertices.begin(),
                        boundary.held_vertices.end(),
                        [](const auto &vertex) {
                          return vertex.normal_displacement == 0. &&
                                 vertex.gap == 0. && vertex.tangents.empty();
                        }))
          boundary.held_vertices.clear();
        return ContactSpace<dim>(boundary, dofs);
      }

    private:
      void
      find_vertices(const BoundaryConditions &conditions)
      {
        for (unsigned int f = 0; f < faces.size(); ++f)
          if (is_on_axis(faces[f]))
            throw EntryError("Boundary conditions/Contact boundary",
                             "the axis is no boundary of a body of revolution, "
                             "at " +
                               point_text(faces[f].positions[0]));
        for (unsigned int f = 0; f < faces.size(); ++f)
          for (unsigned int v = 0; v < faces[f].n_nodes; ++v)
            {
              // Each face appends its normal, measure and gap to its vertices;
              // its place among them is kept, to find the group that it belongs
              // to afterwards. One fixed face is enough to fix the tangential
              // displacement of a vertex, as u is continuous.
              ContactVertex<dim> &vertex = vertices[faces[f].indices[v]];
              // A vertex that has the jump of another one is not there, whose
              // faces have one normal.
              if (faces[f].borrowed[v])
                {
                  places[f][v] = 0;
                  continue;
                }
              vertex.position = faces[f].positions[v];
              places[f][v] = static_cast<unsigned int>(vertex.normals.size());
              vertex.normals.push_back(faces[f].normal);
              vertex.measures.push_back(faces[f].measure);
              vertex.gaps.push_back(gap_at(supports, faces[f], v));
              vertex.is_tangential_fixed =
                vertex.is_tangential_fixed ||
                conditions.fixes_tangential(faces[f].id);
              vertex.has_tangents =
                vertex.has_tangents || conditions.has_tangents(faces[f].id);
            }
      }

      bool
      is_on_axis(const BoundaryFace<dim> &face) const
      {
        // In the section of a body of revolution a face is a line with two
        // vertices.
        return node_supports.on_axis().count(face.indices[0]) > 0 &&
               node_supports.on_axis().count(face.indices[1]) > 0;
      }

      /// Returns whether a face is joined at a vertex to one with another
      /// normal.
      bool
      is_curved(const unsigned int f) const
      {
        for (unsigned int v = 0; v < faces[f].n_nodes; ++v)
          {
            const ContactVertex<dim> &vertex = vertices.at(faces[f].indices[v]);
            for (unsigned int k = 0; k < vertex.normals.size(); ++k)
              if (vertex.groups[k] == vertex.groups[places[f][v]] &&
                  (vertex.normals[k] - faces[f].normal).norm() >
                    Tolerance::same_normal)
                return true;
          }
        return false;
      }

      /// Where u_tau = 0 meets another value the displacement jumps, which no
      /// displacement of finite energy does. What is prescribed on a contact
      /// boundary takes the place of u_tau = 0; on curved ones the normals of
      /// the mesh are not exact.
      void
      check_slip(const BoundaryConditions &conditions) const
      {
        // The check needs the normals of faces, not those of nodes: the
        // displacement that both conditions allow at a vertex has to be a
        // multiple of the normal of the flat side, for u_tau = 0 holds on all
        // of that.
        const auto is_moved = [this](const dealii::types::boundary_id id) {
          return std::any_of(supports.displacements.begin(),
                             supports.displacements.end(),
                             [id](const auto &condition) {
                               return condition.boundaries.count(id) > 0;
                             });
        };
        for (unsigned int f = 0; f < faces.size(); ++f)
          if (conditions.fixes_tangential(faces[f].id) &&
              !is_moved(faces[f].id) && !is_curved(f))
            for (unsigned int v = 0; v < faces[f].n_nodes; ++v)
              check_prescribed(node_supports.at(faces[f].indices[v],
                                                faces[f].positions[v]),
                               faces[f].normal);
      }

      /// Throws unless a multiple of @p normal is a displacement that supports
      /// allow, and they prescribe all of it or nothing.
      void
      check_prescribed(const PrescribedNode<dim>    &prescribed,
                       const dealii::Tensor<1, dim> &normal) const
      {
        // The supports prescribe r_k . u = v_k along orthonormal directions
        // r_k, and u is to be c n. With p_k = r_k . n this needs v_k = c p_k
        // for all k, so that c = sum p_k v_k / sum p_k^2. If sum p_k^2 is
        // neither 0 nor 1 the normal is neither prescribed nor free, which is
        // allowed only if the prescribed values are zero.
        double product = 0., square = 0., largest = 0.;
        for (const auto &row : prescribed.rows)
          {
            const double part = row.direction * normal;
            product += part * row.value;
            square += part * part;
            largest = std::max(largest, std::abs(row.value));
          }
        constexpr double rounding = Tolerance::same_normal;
        const double     multiple =
          square > rounding * rounding ? product / square : 0.;
        if (largest > 0. && square > rounding && square < 1. - rounding)
          throw SupportError(SupportError::Subject::displacement,
                             node_supports.name(prescribed.rows[0].support),
                             "at " + point_text(prescribed.position) +
                               " it is neither along the contact boundary nor "
                               "across it, and with Tangential displacement = "
                               "fixed all is known there: prescribe the whole "
                               "displacement, along the normal");
        for (const auto &row : prescribed.rows)
          if (std::abs(row.value - multiple * (row.direction * normal)) >
              rounding * largest)
            throw SupportError(SupportError::Subject::displacement,
                               node_supports.name(row.support),
                               "the displacement at " +
                                 point_text(prescribed.position) +
                                 " is prescribed otherwise by Tangential "
                                 "displacement = fixed");
      }

      /// The least gap of the faces of each group of a vertex.
      std::vector<double>
      gaps_of(const unsigned int        index,
              const ContactVertex<dim> &vertex,
              const std::size_t         n_groups) const
      {
        // A vertex has one gap for each of its normals. Where boundaries with
        // different gaps meet, the least one holds: the vertex must not enter
        // either of the foundations.
        std::vector<double> gaps(n_groups, infinity);
        for (unsigned int k = 0; k < vertex.gaps.size(); ++k)
          gaps[vertex.groups[k]] =
            std::min(gaps[vertex.groups[k]], vertex.gaps[k]);
        // Where an interface ends there is neither jump nor bond.
        if (node_supports.is_end_of_interface(index))
          std::fill(gaps.begin(), gaps.end(), 0.);
        return gaps;
      }

      /// Which normal displacements are unknown at a vertex: those that
      /// supports do not prescribe. Constrains what u_tau = 0 prescribes beside
      /// them.
      std::vector<unsigned int>
      unknown_normals(const ContactVertex<dim>                  &vertex,
                      const std::vector<dealii::Tensor<1, dim>> &normals,
                      PrescribedNode<dim>                       &prescribed)
      {
        std::vector<unsigned int> unknown;
        if (node_supports.is_end_of_interface(prescribed.node))
          return unknown;
        for (unsigned int k = 0; k < normals.size(); ++k)
          {
            // What remains of a normal without its projection on the prescribed
            // directions. The normal displacement is unknown if anything
            // remains of it that is more than rounding of mean normals.
            dealii::Tensor<1, dim> rest = normals[k];
            for (const auto &row : prescribed.rows)
              rest -= (normals[k] * row.direction) * row.direction;
            if (rest.norm() > Tolerance::free_normal)
              unknown.push_back(k);
          }
        // The square of the cosine between the normal and the space of the
        // prescribed directions. With u_tau = 0 only the multiples of the
        // normal remain, and a support that is inclined to it leaves none of
        // these if it prescribes zero.
        double along_normal = 0.;
        for (const auto &row : prescribed.rows)
          along_normal += std::pow(row.direction * normals[0], 2);
        if (vertex.is_tangential_fixed &&
            (normals.size() > 1 || unknown.empty() ||
             (along_normal > most_inclined * most_inclined &&
              prescribed.displacement().norm() == 0.)))
          {
            // Where normals differ, all displacements are tangential to one,
            // also if supports prescribe one of the normal ones. Supports that
            // are inclined to the normal leave no displacement along it.
            unknown.clear();
            prescribed.fix_rest();
            constrained.constrain(prescribed);
          }
        if (unknown.size() > dim)
          throw std::invalid_argument(
            "Contact sides of " + std::to_string(unknown.size()) +
            " different normals meet at " + point_text(vertex.position) +
            ", where the body has " + std::to_string(dim) +
            " displacements: Tangential displacement = fixed holds such "
            "vertices.");
        if (unknown.size() + prescribed.rows.size() > dim)
          throw SupportError(SupportError::Subject::displacement,
                             node_supports.name(prescribed.rows[0].support),
                             "too much is prescribed at " +
                               point_text(vertex.position) +
                               ", where contact sides meet");
        return unknown;
      }

      /// Makes a node for each group of normals along which the displacement is
      /// unknown, and holds the vertex along the others.
      void
      make_nodes(const unsigned int index, ContactVertex<dim> &vertex)
      {
        // The faces around the vertex are grouped by their normals. For each
        // group the normal displacement is either unknown, which makes a
        // contact node with its gap, or known, which makes a held vertex whose
        // opening enters J as a constant. The frame of the vertex has the
        // normals of its nodes as its first rows, so that u_nu of the k-th node
        // is the k-th unknown.
        const VertexNormals<dim> groups(vertex.normals, vertex.measures);
        std::vector<dealii::Tensor<1, dim>> normals = groups.normals;
        // Across the axis is the same face once more.
        if (node_supports.on_axis().count(index) > 0)
          for (dealii::Tensor<1, dim> &normal : normals)
            {
              normal[0] = 0.;
              normal /= normal.norm();
            }
        vertex.groups                  = groups.groups;
        const std::vector<double> gaps = gaps_of(index, vertex, normals.size());
        PrescribedNode<dim>       prescribed =
          node_supports.at(index, vertex.position);
        const std::vector<unsigned int> unknown =
          unknown_normals(vertex, normals, prescribed);

        const bool shears = vertex.has_tangents &&
                            !vertex.is_tangential_fixed &&
                            !node_supports.is_end_of_interface(index);
        if (shears && normals.size() > 1 && prescribed.rows.size() < dim)
          throw EntryError("Contact law/Tangential displacement",
                           "contact sides of different normals meet at " +
                             point_text(vertex.position) +
                             ", where neither bonds can shear nor friction "
                             "resist: these need another side there, which is "
                             "no contact boundary, or fixed on one of the two");

        vertex.nodes.assign(normals.size(), no_node);
        vertex.held.assign(normals.size(), 0);
        std::vector<dealii::Tensor<1, dim>> directions;
        for (const unsigned int k : unknown)
          {
            vertex.nodes[k] = static_cast<unsigned int>(nodes.size());
            // The frame lists the free normals in this order, so that the
            // number of the unknown is that of the directions before it.
            normal_dofs.push_back(dim * index +
                                  static_cast<unsigned int>(directions.size()));
            constrained.set_gap(normal_dofs.back(), gaps[k]);
            directions.push_back(normals[k]);
            nodes.push_back({vertex.position, normals[k], 0., gaps[k]});
          }

        // Reactions at a held vertex count for its support. At an interface
        // there are two, one for each body.
        std::array<unsigned int, 2> supports{
          {prescribed.rows.empty() ? no_node : prescribed.rows[0].support,
           no_node}};
        if (const auto *of_pair = node_supports.supports_of_pair(index))
          supports = *of_pair;
        // At the end of an interface both bodies are one node, whose
        // displacement opens nothing.
        const dealii::Tensor<1, dim> jump =
          node_supports.is_end_of_interface(index) ? dealii::Tensor<1, dim>() :
                                                     prescribed.displacement();
        for (unsigned int k = 0; k < normals.size(); ++k)
          if (vertex.nodes[k] == no_node)
            {
              vertex.held[k] =
                static_cast<unsigned int>(boundary.held_vertices.size());
              boundary.held_vertices.push_back({jump * normals[k],
                                                gaps[k],
                                                supports[0],
                                                normals[k],
                                                vertex.position,
                                                supports[1]});
            }
        if (!unknown.empty())
          constrained.add_frame(prescribed,
                                directions,
                                vertex.is_tangential_fixed);
        // The tangents come after the frame, in whose rows they are.
        if (shears)
          for (unsigned int k = 0; k < normals.size(); ++k)
            add_tangents(prescribed,
                         normals[k],
                         supports,
                         vertex.nodes[k] == no_node,
                         vertex.nodes[k] == no_node ? vertex.held[k] :
                                                      vertex.nodes[k]);
      }

      /// Adds the directions along the boundary in which a vertex may move, as
      /// unknowns of a frame that has them, or is moved by supports. @p number:
      /// that of the node or, if the normal displacement is known, of the held
      /// vertex.
      void
      add_tangents(const PrescribedNode<dim>         &prescribed,
                   const dealii::Tensor<1, dim>      &normal,
                   const std::array<unsigned int, 2> &supports,
                   const bool                         is_normal_known,
                   const unsigned int                 number)
      {
        // The list is asked for anew at each use: the vector of held vertices
        // grows below, which moves its elements.
        const auto tangents = [&]() -> auto &
        {
          return is_normal_known ? boundary.held_vertices[number].tangents :
                                   nodes[number].tangents;
        };
        using Held          = typename ContactBoundary<dim>::HeldVertex;
        const auto n        = static_cast<unsigned int>(prescribed.rows.size());
        const auto add_held = [&](const dealii::Tensor<1, dim> &way) {
          // The part of a prescribed displacement along the boundary stretches
          // the bonds that shear. It becomes a held vertex of its own, with the
          // direction as its normal and the length as its displacement.
          const dealii::Tensor<1, dim> along = way - (way * normal) * normal;
          const double                 size  = along.norm();
          if (size <= Tolerance::free_normal * way.norm())
            return;
          Held held = {size,
                       0.,
                       supports[0],
                       along / size,
                       prescribed.position,
                       supports[1],
                       true};
          tangents().push_back(
            {held.normal,
             true,
             static_cast<unsigned int>(boundary.held_vertices.size())});
          boundary.held_vertices.push_back(held);
        };
        add_held(prescribed.displacement());
        if (n == dim)
          return;
        // The frame of a node has its normal first, what is prescribed along
        // the boundary next, and the free tangents last. A vertex whose normal
        // displacement is known has got no frame so far.
        const bool is_held =
          std::any_of(prescribed.rows.begin(),
                      prescribed.rows.end(),
                      [&](const auto &row) {
                        return std::abs(row.direction * normal) > most_inclined;
                      });
        if (is_held && !is_normal_known)
          throw SupportError(SupportError::Subject::displacement,
                             node_supports.name(prescribed.rows[0].support),
                             "at " + point_text(prescribed.position) +
                               " it is neither along the contact boundary nor "
                               "across it, which bonds that shear need");
        if (is_normal_known)
          constrained.add_frame(prescribed, {}, false);
        const auto &frame = constrained.frames().back().to_unknowns;
        // The remaining rows of the frame are orthonormal and span the free
        // directions along the boundary. Their displacements become unknowns of
        // s.
        for (unsigned int d = n + (is_normal_known ? 0 : 1); d < dim; ++d)
          tangents().push_back({frame[d], false, dim * prescribed.node + d});
      }

      /// @p place: of each node in the order of the boundary's.
      void
      add_faces(const std::vector<unsigned int> &place)
      {
        for (unsigned int f = 0; f < faces.size(); ++f)
          {
            // Each face refers to nodes by their numbers in the order of s, or
            // to held vertices. For each coefficient of the face the integral
            // of its basis function is added to the measure of its node: the
            // weights of the quadrature at the nodes, int phi_i over Gamma_C,
            // each with the normal of its group alone.
            typename ContactBoundary<dim>::Face face;
            std::copy_n(faces[f].positions.begin(), dim, face.vertices.begin());
            dealii::Point<dim> middle;
            for (const dealii::Point<dim> &corner : face.vertices)
              middle += corner / static_cast<double>(dim);
            face.normal = faces[f].normal;
            // 2 pi r is linear along the face, so that the measure of the cone
            // is the length times 2 pi r in the middle.
            face.measure =
              faces[f].measure * circumference(boundary.symmetry, middle);
            face.id   = faces[f].id;
            face.cell = faces[f].cell;
            for (unsigned int v = 0; v < faces[f].n_nodes; ++v)
              {
                unsigned int &face_node =
                  v < dim ? face.nodes[v] : face.edge_nodes[v - dim];
                unsigned int &face_held =
                  v < dim ? face.held[v] : face.edge_held[v - dim];
                const ContactVertex<dim> &vertex =
                  vertices.at(faces[f].indices[v]);
                const unsigned int group = vertex.groups[places[f][v]];
                const unsigned int node  = vertex.nodes[group];
                face_node = node == no_node ? no_node : place[node];
                face_held = vertex.held[group];
                if (node == no_node)
                  boundary.held_vertices[face_held].boundary = faces[f].id;
                else
                  boundary.nodes[face_node].measure +=
                    boundary.integral(face, v);
              }
            boundary.faces.push_back(face);
          }
      }

      const std::vector<BoundaryFace<dim>> &faces;
      const Supports<dim>                  &supports;
      const NodeSupports<dim>              &node_supports;
      ConstrainedDofs<dim>                 &constrained;

      /// The vertices by their node's number.
      std::map<unsigned int, ContactVertex<dim>> vertices;

      /// The place of each face among those of each of its vertices.
      std::vector<std::array<unsigned int, BoundaryFace<dim>::maximum>> places;

      std::vector<typename ContactBoundary<dim>::Node> nodes;
      std::vector<dealii::types::global_dof_index>     normal_dofs;
      ContactBoundary<dim>                             boundary;
    };
  } // namespace



  template <int dim>
  ContactSpace<dim>
  make_contact_space(const std::vector<BoundaryFace<dim>> &faces,
                     const unsigned int                    degree,
                     const BoundaryConditions             &conditions,
                     const Supports<dim>                  &supports,
                     const NodeSupports<dim>              &node_supports,
                     ConstrainedDofs<dim>                 &constrained)
  {
    return ContactSpaceMaker<dim>(
             faces, degree, conditions, supports, node_supports, constrained)
      .space();
  }



  DEBOND_INSTANTIATE(make_contact_space);
} // namespace Debond
