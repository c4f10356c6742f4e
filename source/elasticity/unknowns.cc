// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/elasticity/contact_nodes.h>
#include <debond/elasticity/edge_coefficients.h>
#include <debond/elasticity/mortar.h>
#include <debond/elasticity/unknowns.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/owned_cells.h>

#include <cstdint>
#include <numeric>

namespace Debond
{
  namespace
  {
    /// The diameter of the box around the whole mesh.
    template <int dim>
    double
    diameter_of(const dealii::Triangulation<dim> &triangulation)
    {
      // A rank has the vertices of its own cells and of ghosts only, so that
      // the corners of the box are reduced over all ranks.
      auto [lower, upper] =
        dealii::BoundingBox<dim>(triangulation.get_vertices())
          .get_boundary_points();
      const MPI_Comm ranks = triangulation.get_communicator();
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = dealii::Utilities::MPI::min(lower[d], ranks);
          upper[d] = dealii::Utilities::MPI::max(upper[d], ranks);
        }
      return lower.distance(upper);
    }



    /// Gives contact faces the normals of their foundations.
    template <int dim>
    void
    set_normals(const Supports<dim>            &supports,
                std::vector<BoundaryFace<dim>> &faces)
    {
      for (BoundaryFace<dim> &face : faces)
        if (const auto field = supports.normals.find(face.id);
            field != supports.normals.end())
          {
            // A face is flat and has one normal, which is that of the field in
            // its middle. It is divided by its largest component first, so that
            // squares of numbers of any size neither overflow nor vanish. It
            // has to point out of the body, by more than rounding.
            dealii::Point<dim> middle;
            for (unsigned int v = 0; v < dim; ++v)
              middle += face.positions[v] / static_cast<double>(dim);
            const std::string &name  = field->second.name;
            std::string        entry = "Boundary conditions/Foundation normal";
            if (!name.empty())
              entry += ' ' + name;
            try
              {
                dealii::Tensor<1, dim> normal =
                  field_vector(*field->second.value, middle);
                double largest = 0.;
                for (unsigned int d = 0; d < dim; ++d)
                  largest = std::max(largest, std::abs(normal[d]));
                if (largest > 0.)
                  normal /= largest;
                if (!(normal * face.normal >
                      Tolerance::same_normal * normal.norm()))
                  throw std::invalid_argument(
                    "it does not point out of the body at " +
                    point_text(middle));
                face.normal = normal / normal.norm();
              }
            catch (const std::invalid_argument &error)
              {
                throw EntryError(entry, error.what());
              }
          }
    }
  } // namespace



  template <int dim>
  ElasticUnknowns<dim>::ElasticUnknowns(
    const dealii::Triangulation<dim> &triangulation,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const unsigned int                degree)
    : mapping_p1(dealii::FE_SimplexP<dim>(1))
    , fe(dealii::FE_SimplexP<dim>(degree), dim)
    , dofs(triangulation)
  {
    if (!triangulation.all_reference_cells_are_simplex() ||
        triangulation.has_hanging_nodes())
      throw std::invalid_argument(
        "The elastic problem needs a mesh of simplices without hanging nodes.");
    for (const dealii::types::boundary_id id : conditions.contact)
      if (conditions.clamped.count(id) > 0)
        throw std::invalid_argument(
          "Boundary conditions: " + boundary_name(conditions.names, id) +
          " is both clamped and a contact boundary.");

    // deal.II's distribution numbers the dim components at a vertex or an edge
    // one after the other, so that node n has the unknowns from dim n on. That
    // is assumed everywhere. The constructor continues in an order in which
    // each step needs what the ones before it have found: faces, coefficients
    // and pairs; what supports prescribe at nodes; contact nodes with their
    // frames; the change of basis; and at last the rigid motions that remain.
    dofs.distribute_dofs(fe);
    const auto faces = [&](const std::set<dealii::types::boundary_id> &ids) {
      return ids.empty() ? std::vector<BoundaryFace<dim>>() :
                           boundary_faces(dofs, ids, conditions.names);
    };
    // An interface has one set of contact faces, those of its high side: its
    // foundation is the low one.
    std::set<dealii::types::boundary_id> contact_ids = conditions.contact;
    for (const dealii::types::boundary_id id : conditions.low_sides)
      contact_ids.erase(id);
    std::vector<BoundaryFace<dim>>       contact = faces(contact_ids);
    const std::vector<BoundaryFace<dim>> low     = faces(conditions.low_sides);
    // Both sides of an interface need Bernstein coefficients, because the jump
    // of two quadratic traces is bounded by its coefficients only if both
    // traces have them.
    std::vector<BoundaryFace<dim>> with_coefficients = contact;
    with_coefficients.insert(with_coefficients.end(), low.begin(), low.end());
    const unsigned int n_nodes = dofs.n_dofs() / dim;
    change_of_basis.set(BasisStep::coefficients,
                        edge_coefficients(with_coefficients),
                        n_nodes);

    // The order matters: prescribe() reads the coefficients, and jumps need to
    // know which nodes are held.
    NodeSupports<dim> node_supports;
    node_supports.clamp(faces(conditions.clamped), conditions);
    for (const PrescribedDisplacement<dim> &condition : supports.displacements)
      node_supports.prescribe(faces(condition.boundaries),
                              condition,
                              conditions,
                              change_of_basis);
    if (conditions.symmetry == Symmetry::axis)
      node_supports.hold_axis(node_positions(), diameter_of(triangulation));
    axis_nodes = node_supports.on_axis();
    make_jumps(low, conditions, node_supports, contact);
    names_of_supports = node_supports.names();

    // The normals of the foundation replace those of the faces before these are
    // grouped to nodes. Nodes of the contact boundary are constrained together
    // with their frames, all others at the end.
    set_normals(supports, contact);
    constrained   = ConstrainedDofs<dim>(dofs.n_dofs(), supports);
    contact_space = make_contact_space(
      contact, degree, conditions, supports, node_supports, constrained);
    const std::vector<Support<dim>> held = constrained.finish(node_supports);
    change_of_basis.set(BasisStep::frames, constrained.frames(), n_nodes);
    find_free_motions(held);
    check_neighbours(conditions);
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::make_jumps(const std::vector<BoundaryFace<dim>> &low,
                                   const BoundaryConditions &conditions,
                                   NodeSupports<dim>        &node_supports,
                                   std::vector<BoundaryFace<dim>> &contact)
  {
    // Where the nodes of both sides are at the same places one depends on one,
    // otherwise on several. glue() may exchange the nodes of a pair, so that
    // jumps are made afterwards.
    const auto with_ids = [](const std::vector<BoundaryFace<dim>> &faces,
                             const auto                           &ids) {
      std::vector<BoundaryFace<dim>> result;
      for (const BoundaryFace<dim> &face : faces)
        if (ids.count(face.id) > 0)
          result.push_back(face);
      return result;
    };
    std::vector<MortarInterface<dim>>                  mortars;
    std::map<dealii::types::boundary_id, unsigned int> mortar_of;
    for (const auto &[name, high_ids, low_ids] : conditions.interfaces)
      {
        const auto high     = with_ids(contact, high_ids),
                   low_side = with_ids(low, low_ids);
        if (node_pairs.add(high, low_side))
          continue;
        for (const auto id : high_ids)
          mortar_of.emplace(id, static_cast<unsigned int>(mortars.size()));
        mortars.emplace_back(name, high, low_side, node_supports, conditions);
      }
    node_supports.glue(node_pairs);
    std::vector<BasisRow<dim>> rows = node_pairs.jumps();
    for (const MortarInterface<dim> &mortar : mortars)
      rows.insert(rows.end(), mortar.rows().begin(), mortar.rows().end());

    // A node is one of a jump, or others depend on it: of two jumps at one node
    // none would be an unknown of its own.
    std::map<unsigned int, unsigned int> uses;
    for (const BasisRow<dim> &row : rows)
      uses[row.node] += 2;
    for (const BasisRow<dim> &row : rows)
      for (const auto &[other, unused] : row.others)
        if (const auto at = uses.find(other); at != uses.end())
          ++at->second;
    const auto check = [&uses](const std::vector<BoundaryFace<dim>> &side) {
      for (const BoundaryFace<dim> &face : side)
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          if (const auto at = uses.find(face.indices[n]);
              at != uses.end() && at->second > 2)
            throw EntryError(
              "Mesh/Interfaces",
              "more than two bodies meet in the point " +
                point_text(face.positions[n]) +
                ": let interfaces end before others, or name the side there "
                "last in both of them");
    };
    check(contact);
    check(low);
    change_of_basis.set(BasisStep::jumps, rows, n_dofs() / dim);

    // The faces of an interface are those of its high side, and its contact
    // nodes are those of the rows, whose unknowns are the jumps. If supports
    // have made the node on the low side the first one of a pair, the faces
    // take its number.
    std::map<unsigned int, unsigned int> first_of;
    for (const auto &pair : node_pairs.all())
      first_of[pair.second] = pair.first;
    for (BoundaryFace<dim> &face : contact)
      if (const auto mortar = mortar_of.find(face.id);
          mortar != mortar_of.end())
        mortars[mortar->second].set_jumps(face);
      else
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          if (const auto entry = first_of.find(face.indices[n]);
              entry != first_of.end())
            face.indices[n] = entry->second;
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::check_neighbours(
    const BoundaryConditions &conditions) const
  {
    if (n_bodies() == 1)
      return;
    // Faces of one body only meet at cracks. Those of interfaces are looked at
    // by their own.
    std::set<dealii::types::boundary_id> own_ids;
    for (const auto &cell : owned_cells(dofs))
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() &&
            conditions.high_sides.count(face->boundary_id()) == 0 &&
            conditions.low_sides.count(face->boundary_id()) == 0)
          own_ids.insert(face->boundary_id());
    const auto all_ids = union_of_ranks<dealii::types::boundary_id>(
      {own_ids.begin(), own_ids.end()}, communicator());
    if (all_ids.empty())
      return;
    const std::set<dealii::types::boundary_id> ids(all_ids.begin(),
                                                   all_ids.end());
    const std::vector<BoundaryFace<dim>>       faces =
      boundary_faces(dofs, ids, conditions.names);
    const std::vector<Facet<dim>> facets = apart(facets_of(faces));
    for (const Overlap<dim> &overlap : find_overlaps(facets, facets, 1.))
      {
        const BoundaryFace<dim> &face  = faces[overlap.first],
                                &other = faces[overlap.second];
        if (body_of(face.indices[0]) == body_of(other.indices[0]))
          continue;
        const std::string name   = boundary_name(conditions.names, face.id),
                          beside = boundary_name(conditions.names, other.id);
        const std::string at     = " at " + point_text(face.positions[0]) + ' ';
        if (conditions.contact.count(face.id) > 0)
          throw EntryError("Boundary conditions/Contact boundary",
                           name + at + "is next to " + beside +
                             " of another body, and contact with it is that "
                             "with a rigid foundation: Mesh/Interfaces lets "
                             "both sides touch each other, and so does "
                             "Mesh/Cuts where they are one mesh");
        for (const auto &point : overlap.points)
          if (std::abs(point.distance) <=
              Tolerance::touching *
                face.positions[0].distance(face.positions[1]))
            throw EntryError("Mesh/Interfaces",
                             name + at + "lies on " + beside +
                               " of another body, which it could go through: "
                               "name the two boundaries, or the two regions, "
                               "here. If they are one body, Coherence Mesh in "
                               "Gmsh joins nodes at the same place");
      }
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::find_free_motions(std::vector<Support<dim>> held)
  {
    // First the motions that supports leave free: with any of them A is
    // singular, and bonds and foundation have to hold the body. Then contact
    // nodes count as supports along their normals, and along tangents in which
    // bonds shear. A motion that remains moves no bond at all, so that nothing
    // in the problem resists it: it is an error of the scene.
    const double diameter = diameter_of(dofs.get_triangulation());
    const std::vector<std::string> places  = find_bodies();
    const auto                     in_body = [this](Support<dim> &support) {
      support.body = body_of(support.node);
      // At a node with a jump the prescribed displacement is the jump, relative
      // to the body of the other nodes, unless it is held by itself.
      const auto *row = basis().find(BasisStep::jumps, support.node);
      if (row != nullptr &&
          (support.direction * row->of_others).norm() > Tolerance::same_normal)
        support.other = body_of(row->others[0].first);
    };
    std::for_each(held.begin(), held.end(), in_body);
    free_motions = free_rigid_motions(held, symmetry(), diameter, places);
    if (free_motions.motions.empty())
      return;
    // The node is found from its unknown, to know the body or the two bodies
    // that it belongs to.
    const auto hold = [&](const dealii::Point<dim>     &position,
                          const dealii::Tensor<1, dim> &direction,
                          const unsigned int            unknown) {
      held.push_back(
        {position,
         direction,
         static_cast<unsigned int>(contact_space.dofs()[unknown] / dim)});
      in_body(held.back());
    };
    const ContactBoundary<dim> &boundary   = contact_space.boundary();
    const auto                  hold_along = [&](const auto &vertices) {
      for (const auto &vertex : vertices)
        for (const auto &tangent : vertex.tangents)
          if (!tangent.is_held)
            hold(vertex.position, tangent.direction, tangent.index);
    };
    for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
      hold(boundary.nodes[i].position, boundary.nodes[i].normal, i);
    hold_along(boundary.nodes);
    hold_along(boundary.held_vertices);
    const std::vector<std::string> motions =
      free_rigid_motions(held, symmetry(), diameter, places).names;
    if (!motions.empty())
      throw std::invalid_argument(
        "Boundary conditions leave a rigid motion free: " +
        join(motions, ", ") + ". Clamp a side" +
        (n_bodies() == 1 ?
           "." :
           "; nodes at the same place do not connect bodies, but "
           "Mesh/Interfaces does or, where they are one mesh, Mesh/Cuts."));
  }



  template <int dim>
  std::vector<std::string>
  ElasticUnknowns<dim>::find_bodies()
  {
    // Bodies are connected components of nodes that have cells in common. A
    // node leads to one with a lower number in its body, so that one pass over
    // the own cells joins all that they connect. Then ranks take the least
    // number for nodes that they share, until nothing changes; all ranks see
    // the same numbers, so that they stop at the same time.
    bodies.resize(n_dofs() / dim);
    std::iota(bodies.begin(), bodies.end(), 0u);
    const auto first_of = [this](unsigned int node) {
      while (bodies[node] != node)
        node = bodies[node] = bodies[bodies[node]];
      return node;
    };
    const auto join_nodes = [&](const unsigned int a, const unsigned int b) {
      const auto [low, high] = std::minmax({first_of(a), first_of(b)});
      bodies[high]           = low;
    };
    std::vector<dealii::types::global_dof_index> cell_dofs(fe.dofs_per_cell);
    for (const auto &cell : owned_cells(dofs))
      {
        cell->get_dof_indices(cell_dofs);
        for (const auto dof : cell_dofs)
          join_nodes(static_cast<unsigned int>(cell_dofs[0] / dim),
                     static_cast<unsigned int>(dof / dim));
      }
    const auto lead_to_first = [&]() {
      for (unsigned int node = 0; node < bodies.size(); ++node)
        bodies[node] = first_of(node);
    };
    std::vector<unsigned int> least, before;
    do
      {
        lead_to_first();
        before = std::exchange(least, bodies);
        dealii::Utilities::MPI::min(least, communicator(), least);
        for (unsigned int node = 0; node < bodies.size(); ++node)
          join_nodes(node, least[node]);
      }
    while (least != before);
    lead_to_first();
    const std::vector<dealii::Point<dim>> positions = node_positions();
    std::map<unsigned int, unsigned int>  numbers;
    std::vector<std::string>              places;
    for (unsigned int node = 0; node < bodies.size(); ++node)
      {
        const auto [entry, is_new] =
          numbers.emplace(bodies[node],
                          static_cast<unsigned int>(places.size()));
        if (is_new)
          places.push_back(" of the body at " + point_text(positions[node]));
        bodies[node] = entry->second;
      }
    if (places.size() == 1)
      {
        bodies.clear();
        places[0].clear();
      }
    return places;
  }



  template <int dim>
  std::vector<dealii::Point<dim>>
  ElasticUnknowns<dim>::node_positions() const
  {
    const std::vector<dealii::Point<dim>> &points =
      fe.get_unit_support_points();
    std::vector<double>                          coordinates(n_dofs());
    std::vector<dealii::types::global_dof_index> cell_dofs(fe.dofs_per_cell);
    const dealii::IndexSet &own = dofs.locally_owned_dofs();
    for (const auto &cell : owned_cells(dofs))
      {
        // The mapping is affine, x = x_0 + sum of xi_d (x_d - x_0), and
        // MappingFE would evaluate all its shape functions at each point. Each
        // rank fills in the nodes that it owns, and the sum over ranks makes
        // the list whole.
        const dealii::Point<dim> origin = cell->vertex(0);
        cell->get_dof_indices(cell_dofs);
        for (unsigned int i = 0; i < cell_dofs.size(); i += dim)
          if (own.is_element(cell_dofs[i]))
            {
              dealii::Point<dim> point = origin;
              for (unsigned int d = 0; d < dim; ++d)
                point += points[i][d] * (cell->vertex(d + 1) - origin);
              std::copy(point.begin_raw(),
                        point.end_raw(),
                        coordinates.begin() + cell_dofs[i]);
            }
      }
    dealii::Utilities::MPI::sum(coordinates, communicator(), coordinates);
    std::vector<dealii::Point<dim>> result(n_dofs() / dim);
    for (unsigned int i = 0; i < coordinates.size(); ++i)
      result[i / dim][i % dim] = coordinates[i];
    return result;
  }



  template <int dim>
  std::vector<dealii::types::global_dof_index>
  ElasticUnknowns<dim>::serial_order() const
  {
    std::vector<dealii::types::global_dof_index> order(n_dofs());
    std::iota(order.begin(), order.end(), 0U);
    if (number_of_ranks(communicator()) == 1)
      return order;
    // On one rank deal.II numbers degrees of freedom as the cells come to them.
    // The first visit of each, as the number of the cell in the whole mesh
    // times the unknowns of a cell plus the place there, is the same whatever
    // the number of ranks is; sorting by it gives the numbers of one rank.
    // Products may exceed 32 bits.
    const std::uint64_t                          n = fe.dofs_per_cell;
    std::vector<dealii::types::global_dof_index> cell_dofs(n);
    // The largest number would be -1 for MPI::min().
    std::vector<std::uint64_t> first_visits(
      n_dofs(), dofs.get_triangulation().n_global_active_cells() * n);
    for (const auto &cell : owned_cells(dofs))
      {
        cell->get_dof_indices(cell_dofs);
        for (unsigned int i = 0; i < n; ++i)
          first_visits[cell_dofs[i]] =
            std::min<std::uint64_t>(first_visits[cell_dofs[i]],
                                    cell->id().get_coarse_cell_id() * n + i);
      }
    dealii::Utilities::MPI::min(first_visits, communicator(), first_visits);
    auto visited = order;
    std::sort(visited.begin(),
              visited.end(),
              [&first_visits](const auto a, const auto b) {
                return first_visits[a] < first_visits[b];
              });
    for (unsigned int k = 0; k < visited.size(); ++k)
      order[visited[k]] = k;
    return order;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::lifting(const LoadFactors factors) const
  {
    // Prescribed displacements grow with their factor, gaps do not.
    DofVector G(n_dofs());
    if (has_prescribed_displacements())
      G.equ(factors.displacements, constrained.displacements());
    if (has_gap())
      G += constrained.gaps();
    return G;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::lifted(DofVector w, const LoadFactors factors) const
  {
    if (has_lifting())
      w += lifting(factors);
    return w;
  }



  template <int dim>
  DofVector
  ElasticUnknowns<dim>::from_cartesian(
    const DofVector &cartesian_displacement) const
  {
    // The lifting is that of the whole load. Constrained entries of w are zero
    // by definition, whatever the displacement has there.
    DofVector result = basis().to_unknowns(cartesian_displacement);
    if (has_lifting())
      result -= lifting();
    constraints().set_zero(result);
    return result;
  }



  template <int dim>
  std::vector<DofVector>
  ElasticUnknowns<dim>::displacements_of(
    const std::vector<std::vector<RigidMotion<dim>>> &motions) const
  {
    if (motions.empty())
      return {};
    const std::vector<dealii::Point<dim>> positions = node_positions();
    std::vector<DofVector>                result;
    for (const std::vector<RigidMotion<dim>> &of_bodies : motions)
      {
        DofVector &u = result.emplace_back(n_dofs());
        for (unsigned int node = 0; node < positions.size(); ++node)
          {
            const dealii::Tensor<1, dim> way =
              of_bodies[body_of(node)](positions[node]);
            for (unsigned int d = 0; d < dim; ++d)
              u(dim * node + d) = way[d];
          }
      }
    return result;
  }



  template <int dim>
  std::vector<DofVector>
  ElasticUnknowns<dim>::rigid_body_modes() const
  {
    // All bodies have the same motion, in which the jumps between them are
    // zero. A rotation turns the first axis of its plane to the second one,
    // which about y, in the plane of x and z, is the negative direction.
    constexpr unsigned int                     n = dim * (dim + 1) / 2;
    std::vector<std::vector<RigidMotion<dim>>> motions;
    for (unsigned int k = 0; k < n; ++k)
      {
        RigidMotion<dim> motion;
        if (k < dim)
          motion.translation[k] = 1.;
        else // in the planes of x and y, x and z, y and z
          motion.rotation[n - 1 - k] = k == 4 ? -1. : 1.;
        motions.emplace_back(n_bodies(), motion);
      }
    std::vector<DofVector> modes = displacements_of(motions);
    for (DofVector &mode : modes)
      {
        mode = basis().to_unknowns(mode);
        constraints().set_zero(mode);
      }
    return modes;
  }



  DEBOND_INSTANTIATE_CLASS(ElasticUnknowns);
} // namespace Debond
