// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/base/text.h>
#include <debond/contact/field_value.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/rigid_motions.h>
#include <debond/elasticity/unknowns.h>
#include <debond/mesh/crossed_mesh.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

namespace Debond
{
  namespace
  {
    /// A boundary face, with what the degrees of freedom know of it.
    template <int dim>
    struct BoundaryFace
    {
      template <typename CellIterator>
      BoundaryFace(const CellIterator &cell, const unsigned int face_no)
      {
        id                             = cell->face(face_no)->boundary_id();
        const auto           reference = cell->reference_cell();
        const CellNodes<dim> cell_nodes(cell);
        n_nodes = n_coefficients(dim, cell->get_fe().degree);
        unsigned int                  opposite = dim * (dim + 1) / 2;
        std::array<unsigned int, dim> cell_vertices;
        for (unsigned int v = 0; v < dim; ++v)
          {
            cell_vertices[v] = reference.face_to_cell_vertices(face_no, v, 1);
            opposite -= cell_vertices[v];
          }
        for (unsigned int n = 0; n < n_nodes; ++n)
          {
            const unsigned int node =
              n < dim ?
                cell_vertices[n] :
                dim + 1 +
                  edge_between(cell_vertices[simplex_edges[n - dim][0]],
                               cell_vertices[simplex_edges[n - dim][1]]);
            indices[n]   = cell_nodes.indices[node];
            positions[n] = node_position<dim>(cell, node);
            dofs[n]      = cell_nodes.dofs[node];
          }

        // The basis function of the opposite vertex grows inwards.
        const LinearSimplex<dim>     simplex(cell);
        const dealii::Tensor<1, dim> inward = simplex.gradients[opposite];

        measure = dim * simplex.volume * inward.norm();
        normal  = -inward / inward.norm();
      }

      static constexpr unsigned int maximum = n_coefficients(dim, 2);

      /// The coefficient of a node of a function with these values at the
      /// nodes' positions.
      template <typename Values>
      double
      coefficient(const unsigned int n, const Values &value) const
      {
        if (n < dim)
          return value(positions[n]);
        const auto &[a, b] = simplex_edges[n - dim];
        return 2. * value(positions[n]) -
               0.5 * (value(positions[a]) + value(positions[b]));
      }

      dealii::types::boundary_id              id;
      unsigned int                            n_nodes; ///< vertices come first
      std::array<unsigned int, maximum>       indices;
      std::array<dealii::Point<dim>, maximum> positions;
      std::array<std::array<dealii::types::global_dof_index, dim>, maximum>
                             dofs;
      double                 measure;
      dealii::Tensor<1, dim> normal;
    };



    /// All faces of the given boundaries, each of which must exist unless the
    /// mesh is a piece.
    template <int dim>
    std::vector<BoundaryFace<dim>>
    boundary_faces(const dealii::DoFHandler<dim>              &dofs,
                   const std::set<dealii::types::boundary_id> &boundaries,
                   const BoundaryNames                        &names,
                   const bool                                  is_piece)
    {
      std::vector<BoundaryFace<dim>>       faces;
      std::set<dealii::types::boundary_id> missing = boundaries;
      for (const auto &cell : dofs.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() &&
              boundaries.count(cell->face(f)->boundary_id()) > 0)
            {
              missing.erase(cell->face(f)->boundary_id());
              faces.emplace_back(cell, f);
            }
      if (!missing.empty() && !is_piece)
        throw std::invalid_argument(
          "Boundary conditions: " + boundary_name(names, *missing.begin()) +
          " is clamped or a contact boundary, but the mesh has no such "
          "boundary.");
      return faces;
    }



    /// What the clamp of a face is called: the widest piece that is clamped as
    /// a whole.
    std::string
    clamp_name(const BoundaryConditions        &conditions,
               const dealii::types::boundary_id id)
    {
      std::string name = boundary_name(conditions.names, id);
      std::size_t size = 0;
      for (const auto &[piece, ids] : conditions.names)
        if (ids.count(id) > 0 && ids.size() > size &&
            std::includes(conditions.clamped.begin(),
                          conditions.clamped.end(),
                          ids.begin(),
                          ids.end()))
          {
            name = piece;
            size = ids.size();
          }
      return name;
    }



    /// A vertex of the contact boundary that is not clamped.
    template <int dim>
    struct ContactVertex
    {
      std::array<dealii::types::global_dof_index, dim> dofs;
      dealii::Point<dim>                               position;
      VertexNormals<dim>                               normals;

      /// On one of its faces.
      bool is_tangential_fixed = false;

      /// For each group of normals the least gap, and the node or the held
      /// vertex.
      std::vector<double>       gaps;
      std::vector<unsigned int> nodes;
      std::vector<unsigned int> held;
    };



    /// Of the foundation below a point of the boundary.
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
          return nonnegative_value(*gap->second.value, point);
        }
      catch (const std::invalid_argument &error)
        {
          throw SupportError(SupportError::Subject::gap,
                             gap->second.name,
                             error.what());
        }
    }



    /// Ranks of numbers, where those that differ by rounding share one.
    std::vector<unsigned int>
    ranks(const std::vector<double> &values, const double tolerance)
    {
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
  } // namespace



  template <int dim>
  ElasticUnknowns<dim>::ElasticUnknowns(
    const dealii::Triangulation<dim> &triangulation,
    const BoundaryConditions         &conditions,
    const Supports<dim>              &supports,
    const unsigned int                degree,
    const std::vector<unsigned int>  &node_order)
    : is_piece(!node_order.empty())
    , mapping_p1(dealii::FE_SimplexP<dim>(1))
    , fe(dealii::FE_SimplexP<dim>(degree), dim)
    , dofs(triangulation)
    , frame_of_node(n_nodes(triangulation, degree),
                    dealii::numbers::invalid_unsigned_int)
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

    dofs.distribute_dofs(fe);
    if (is_piece)
      {
        std::vector<dealii::types::global_dof_index> numbers(dofs.n_dofs());
        for (const auto &cell : dofs.active_cell_iterators())
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int d = 0; d < dim; ++d)
              numbers[cell->vertex_dof_index(v, d)] =
                node_order[cell->vertex_index(v)] * dim + d;
        dofs.renumber_dofs(numbers);
      }
    const double diameter = [&] {
      const auto corners =
        dealii::BoundingBox<dim>(triangulation.get_vertices())
          .get_boundary_points();
      return corners.first.distance(corners.second);
    }();

    // G of most scenes is zero, and then there is none.
    prescribed.reinit(supports.displacements.empty() ? 0 : dofs.n_dofs());
    gap.reinit(supports.gaps.empty() ? 0 : dofs.n_dofs());

    std::vector<Support<dim>> held;
    clamp(conditions, held);
    PrescribedVertices vertices;
    for (const PrescribedDisplacement<dim> &condition : supports.displacements)
      prescribe(condition, conditions, vertices);
    make_contact_boundary(conditions, supports, vertices, diameter, held);
    for (const auto &[index, vertex] : vertices)
      constrain(vertex, index, held);
    for (dealii::Vector<double> *part : {&prescribed, &gap})
      if (part->size() > 0 && part->all_zero())
        part->reinit(0);

    if (!is_piece)
      free_motions = free_rigid_motions(held, diameter);
    if (!free_motions.motions.empty())
      {
        for (const auto &node : contact_space.boundary().nodes)
          held.push_back({node.position, node.normal});
        const std::vector<std::string> motions =
          free_rigid_motions(held, diameter).names;
        if (!motions.empty())
          throw std::invalid_argument(
            "Boundary conditions leave a rigid motion free: " +
            join(motions, ", ") + ". Clamp a side.");
      }

    fixed.close();
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::clamp(const BoundaryConditions  &conditions,
                              std::vector<Support<dim>> &held)
  {
    std::map<std::string, unsigned int> numbers;
    for (const BoundaryFace<dim> &face :
         boundary_faces(dofs, conditions.clamped, conditions.names, is_piece))
      {
        const auto [entry, is_new] =
          numbers.emplace(clamp_name(conditions, face.id),
                          static_cast<unsigned int>(names_of_supports.size()));
        if (is_new)
          names_of_supports.push_back(entry->first);
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          clamp_vertex(face.dofs[n], face.positions[n], held, entry->second);
      }
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::clamp_vertex(
    const std::array<dealii::types::global_dof_index, dim> &vertex_dofs,
    const dealii::Point<dim>                               &position,
    std::vector<Support<dim>>                              &held,
    const unsigned int                                      support)
  {
    if (fixed.is_constrained(vertex_dofs[0]))
      return;
    for (unsigned int d = 0; d < dim; ++d)
      {
        constrain(vertex_dofs[d], 0., support);
        held.push_back({position, dealii::Point<dim>::unit_vector(d)});
      }
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::constrain(const dealii::types::global_dof_index dof,
                                  const double                          value,
                                  const unsigned int                    support)
  {
    fixed.add_line(dof);
    if (value != 0.)
      prescribed(dof) = value;
    if (support != dealii::numbers::invalid_unsigned_int)
      supported_dofs.push_back({dof, support});
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::prescribe(const PrescribedDisplacement<dim> &condition,
                                  const BoundaryConditions          &conditions,
                                  PrescribedVertices                &vertices)
  {
    const auto fail = [&](const std::string &message) {
      throw SupportError(condition.is_roller ?
                           SupportError::Subject::roller :
                           SupportError::Subject::displacement,
                         condition.name,
                         message);
    };
    const unsigned int support =
      static_cast<unsigned int>(names_of_supports.size());
    names_of_supports.push_back(condition.name);

    std::vector<bool>                    is_done(frame_of_node.size(), false);
    const std::vector<BoundaryFace<dim>> faces =
      boundary_faces(dofs, condition.boundaries, conditions.names, is_piece);
    for (const BoundaryFace<dim> &face : faces)
      {
        constexpr double rounding = 1e-8;
        if (condition.is_roller &&
            (face.normal - faces[0].normal).norm() > rounding)
          fail("a roller is flat, but the normals of " + condition.name +
               " differ: prescribe components by Displacement " +
               condition.name);
        // What of the normal is not prescribed.
        double free_part = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          if (!condition.is_roller && !condition.components[d])
            free_part = std::max(free_part, std::abs(face.normal[d]));
        if (conditions.contact.count(face.id) > 0 && free_part <= rounding)
          fail(condition.name +
               " is a contact boundary, whose normal displacement is left to "
               "the foundation and cannot be prescribed");

        for (unsigned int v = 0; v < face.n_nodes; ++v)
          {
            if (is_done[face.indices[v]])
              continue;
            is_done[face.indices[v]] = true;
            std::vector<Row> rows;
            if (condition.is_roller)
              {
                // Sides along the axes have exact normals.
                dealii::Tensor<1, dim> normal = faces[0].normal;
                for (unsigned int d = 0; d < dim; ++d)
                  if (std::abs(normal[d]) < 1e-14)
                    normal[d] = 0.;
                rows.push_back({normal / normal.norm(), 0., support});
              }
            else
              for (unsigned int d = 0; d < dim; ++d)
                if (condition.components[d])
                  rows.push_back({dealii::Point<dim>::unit_vector(d),
                                  condition.values == nullptr ?
                                    0. :
                                    [&] {
                                      try
                                        {
                                          return face.coefficient(
                                            v, [&](const auto &position) {
                                              return field_value(
                                                *condition.values, position, d);
                                            });
                                        }
                                      catch (const std::invalid_argument &error)
                                        {
                                          fail(error.what());
                                          return 0.;
                                        }
                                    }(),
                                  support});
            if (fixed.is_constrained(face.dofs[v][0]))
              {
                for (const Row &row : rows)
                  if (row.value != 0.)
                    fail("the displacement at " +
                         point_text(face.positions[v]) +
                         " is prescribed, but the vertex is clamped: leave its "
                         "side out of Clamped boundaries");
                continue;
              }

            PrescribedVertex &vertex = vertices[face.indices[v]];
            vertex.dofs              = face.dofs[v];
            vertex.position          = face.positions[v];
            for (Row row : rows)
              {
                const double value = row.value;
                double       size  = std::abs(value);
                for (const Row &other : vertex.rows)
                  {
                    const double part = row.direction * other.direction;
                    row.direction -= part * other.direction;
                    row.value -= part * other.value;
                    size = std::max(size, std::abs(other.value));
                  }
                const double length = row.direction.norm();
                if (length > rounding)
                  {
                    row.direction /= length;
                    row.value /= length;
                    vertex.rows.push_back(row);
                  }
                else if (std::abs(row.value) > rounding * size)
                  fail("the displacement at " + point_text(vertex.position) +
                       " is prescribed otherwise by " +
                       names_of_supports[vertex.rows[0].support]);
              }
          }
      }
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::constrain(const PrescribedVertex    &vertex,
                                  const unsigned int         index,
                                  std::vector<Support<dim>> &held)
  {
    if (vertex.rows.empty() || fixed.is_constrained(vertex.dofs[0]) ||
        frame_of_node[index] != dealii::numbers::invalid_unsigned_int)
      return;
    for (const Row &row : vertex.rows)
      held.push_back({vertex.position, row.direction});

    // Along the axes the unknowns stay Cartesian, and so they do if nothing is
    // unknown.
    const auto axis = [](const dealii::Tensor<1, dim> &direction) {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(direction[d]) == 1.)
          return d;
      return static_cast<unsigned int>(dim);
    };
    if (vertex.rows.size() == dim)
      {
        const dealii::Tensor<1, dim> displacement = displacement_of(vertex);
        for (unsigned int d = 0; d < dim; ++d)
          {
            unsigned int bearing = 0;
            for (unsigned int k = 1; k < dim; ++k)
              if (std::abs(vertex.rows[k].direction[d]) >
                  std::abs(vertex.rows[bearing].direction[d]))
                bearing = k;
            constrain(vertex.dofs[d],
                      displacement[d],
                      vertex.rows[bearing].support);
          }
      }
    else if (std::all_of(vertex.rows.begin(),
                         vertex.rows.end(),
                         [&](const Row &row) {
                           return axis(row.direction) < dim;
                         }))
      for (const Row &row : vertex.rows)
        {
          const unsigned int d = axis(row.direction);
          constrain(vertex.dofs[d], row.direction[d] * row.value, row.support);
        }
    else
      {
        std::vector<dealii::Tensor<1, dim>> directions;
        for (const Row &row : vertex.rows)
          directions.push_back(row.direction);
        add_frame(index, vertex.dofs, directions);
        for (unsigned int k = 0; k < vertex.rows.size(); ++k)
          constrain(vertex.dofs[k],
                    vertex.rows[k].value,
                    vertex.rows[k].support);
      }
  }



  template <int dim>
  dealii::Tensor<1, dim>
  ElasticUnknowns<dim>::displacement_of(const PrescribedVertex &vertex)
  {
    dealii::Tensor<1, dim> displacement;
    for (const Row &row : vertex.rows)
      displacement += row.value * row.direction;
    return displacement;
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::fix_rest(PrescribedVertex &vertex)
  {
    while (vertex.rows.size() < dim)
      {
        dealii::Tensor<1, dim> best;
        for (unsigned int d = 0; d < dim; ++d)
          {
            dealii::Tensor<1, dim> rest = dealii::Point<dim>::unit_vector(d);
            for (const Row &row : vertex.rows)
              rest -= row.direction[d] * row.direction;
            if (rest.norm() > best.norm())
              best = rest;
          }
        vertex.rows.push_back(
          {best / best.norm(), 0., dealii::numbers::invalid_unsigned_int});
      }
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::add_frame(
    const unsigned int                                      index,
    const std::array<dealii::types::global_dof_index, dim> &vertex_dofs,
    const std::vector<dealii::Tensor<1, dim>>              &rows)
  {
    Frame frame;
    frame.dofs           = vertex_dofs;
    frame.to_frame       = contact_frame(rows);
    frame.to_cartesian   = dealii::invert(frame.to_frame);
    frame_of_node[index] = static_cast<unsigned int>(node_frames.size());
    node_frames.push_back(frame);
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::make_contact_boundary(
    const BoundaryConditions  &conditions,
    const Supports<dim>       &supports,
    const PrescribedVertices  &prescribed_vertices,
    const double               diameter,
    std::vector<Support<dim>> &held)
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    const std::vector<BoundaryFace<dim>> faces =
      boundary_faces(dofs, conditions.contact, conditions.names, is_piece);

    // By node index; clamped vertices are left out. For each face, the group
    // of normals that it belongs to at each of its vertices.
    std::map<unsigned int, ContactVertex<dim>>                        vertices;
    std::vector<std::array<unsigned int, BoundaryFace<dim>::maximum>> groups(
      faces.size());
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (unsigned int v = 0; v < faces[f].n_nodes; ++v)
        if (!fixed.is_constrained(faces[f].dofs[v][0]))
          {
            ContactVertex<dim> &vertex = vertices[faces[f].indices[v]];
            vertex.dofs                = faces[f].dofs[v];
            vertex.position            = faces[f].positions[v];
            groups[f][v] =
              vertex.normals.add_face(faces[f].normal, faces[f].measure);
            vertex.is_tangential_fixed =
              vertex.is_tangential_fixed ||
              conditions.fixes_tangential(faces[f].id);
            const double gap_here =
              gap_value(supports, faces[f].id, vertex.position);
            if (groups[f][v] < vertex.gaps.size())
              vertex.gaps[groups[f][v]] =
                std::min(vertex.gaps[groups[f][v]], gap_here);
            else
              vertex.gaps.push_back(gap_here);
          }

    ContactBoundary<dim> boundary;
    boundary.degree = degree();
    // All basis functions of a face have the same integral.
    const double part_of_face =
      static_cast<double>(dim) / boundary.n_face_nodes();
    std::vector<typename ContactBoundary<dim>::Node> nodes;
    std::vector<dealii::types::global_dof_index>     normal_dofs;
    for (auto &[index, vertex] : vertices)
      {
        const std::vector<dealii::Tensor<1, dim>> normals =
          vertex.normals.normals();
        PrescribedVertex at_supports = {vertex.dofs, vertex.position, {}};
        if (const auto entry = prescribed_vertices.find(index);
            entry != prescribed_vertices.end())
          at_supports = entry->second;
        const std::vector<Row> &rows = at_supports.rows;

        // A normal displacement is unknown unless supports prescribe it.
        std::vector<unsigned int> unknown;
        for (unsigned int k = 0; k < normals.size(); ++k)
          {
            dealii::Tensor<1, dim> rest = normals[k];
            for (const Row &row : rows)
              rest -= (normals[k] * row.direction) * row.direction;
            if (rest.norm() > 1e-6)
              unknown.push_back(k);
          }
        if (vertex.is_tangential_fixed &&
            (normals.size() > 1 || unknown.empty()))
          {
            // Where normals differ, all displacements are tangential to one,
            // also if supports prescribe one of the normal ones.
            unknown.clear();
            fix_rest(at_supports);
            constrain(at_supports, index, held);
          }

        vertex.nodes.assign(normals.size(), none);
        vertex.held.assign(normals.size(), 0);
        std::vector<dealii::Tensor<1, dim>> directions;
        for (const unsigned int k : unknown)
          {
            vertex.nodes[k] = static_cast<unsigned int>(nodes.size());
            normal_dofs.push_back(vertex.dofs[directions.size()]);
            const double gap_here = vertex.gaps[k];
            if (gap_here > 0.)
              gap(normal_dofs.back()) = gap_here;
            directions.push_back(normals[k]);
            nodes.push_back({vertex.position,
                             normals[k],
                             part_of_face * vertex.normals.measure(k),
                             gap_here});
          }
        for (unsigned int k = 0; k < normals.size(); ++k)
          if (vertex.nodes[k] == none)
            {
              vertex.held[k] =
                static_cast<unsigned int>(boundary.held_vertices.size());
              boundary.held_vertices.push_back(
                {displacement_of(at_supports) * normals[k],
                 vertex.gaps[k],
                 rows.empty() ? none : rows[0].support,
                 normals[k],
                 vertex.position});
            }
        if (unknown.empty())
          continue;

        for (const Row &row : rows)
          directions.push_back(row.direction);
        if (directions.size() > dim)
          throw SupportError(SupportError::Subject::displacement,
                             names_of_supports[rows[0].support],
                             "too much is prescribed at " +
                               point_text(vertex.position) +
                               ", where contact sides meet");
        add_frame(index, vertex.dofs, directions);
        for (unsigned int k = 0; k < rows.size(); ++k)
          {
            constrain(vertex.dofs[unknown.size() + k],
                      rows[k].value,
                      rows[k].support);
            held.push_back({vertex.position, rows[k].direction});
          }
        if (vertex.is_tangential_fixed)
          for (unsigned int d = static_cast<unsigned int>(directions.size());
               d < dim;
               ++d)
            {
              constrain(vertex.dofs[d], 0., none);
              held.push_back({vertex.position, node_frames.back().to_frame[d]});
            }
      }

    // Rounding of the coordinates, as in a turned body, must not change the
    // order.
    std::array<std::vector<unsigned int>, dim> coordinate_ranks;
    for (unsigned int d = 0; d < dim; ++d)
      {
        std::vector<double> coordinates;
        for (const auto &node : nodes)
          coordinates.push_back(node.position[d]);
        coordinate_ranks[d] = ranks(coordinates, 1e-10 * diameter);
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

    std::vector<dealii::types::global_dof_index> boundary_normals;
    std::vector<unsigned int>                    place(nodes.size());
    for (unsigned int k = 0; k < order.size(); ++k)
      {
        place[order[k]] = k;
        boundary.nodes.push_back(nodes[order[k]]);
        boundary_normals.push_back(normal_dofs[order[k]]);
      }

    std::map<dealii::types::global_dof_index, unsigned int> supports_of_dofs;
    if (!supports.gaps.empty())
      for (const Supported &supported : supported_dofs)
        supports_of_dofs.emplace(supported.dof, supported.support);
    const auto support_of = [&](const dealii::types::global_dof_index dof) {
      const auto entry = supports_of_dofs.find(dof);
      return entry == supports_of_dofs.end() ? none : entry->second;
    };
    for (unsigned int f = 0; f < faces.size(); ++f)
      {
        typename ContactBoundary<dim>::Face face;
        std::copy_n(faces[f].positions.begin(), dim, face.vertices.begin());
        face.normal  = faces[f].normal;
        face.measure = faces[f].measure;
        face.id      = faces[f].id;
        for (unsigned int v = 0; v < faces[f].n_nodes; ++v)
          {
            unsigned int &face_node =
              v < dim ? face.nodes[v] : face.edge_nodes[v - dim];
            unsigned int &face_held =
              v < dim ? face.held[v] : face.edge_held[v - dim];
            const auto entry = vertices.find(faces[f].indices[v]);
            if (entry == vertices.end())
              {
                // Clamped, as far from the foundation as at rest.
                face_node = none;
                face_held =
                  static_cast<unsigned int>(boundary.held_vertices.size());
                boundary.held_vertices.push_back(
                  {0.,
                   gap_value(supports, faces[f].id, faces[f].positions[v]),
                   support_of(faces[f].dofs[v][0]),
                   faces[f].normal,
                   faces[f].positions[v]});
                continue;
              }
            const ContactVertex<dim> &vertex = entry->second;
            const unsigned int        node   = vertex.nodes[groups[f][v]];
            face_node = node == none ? none : place[node];
            face_held = vertex.held[groups[f][v]];
          }
        boundary.faces.push_back(face);
      }
    if (std::all_of(boundary.held_vertices.begin(),
                    boundary.held_vertices.end(),
                    [](const auto &vertex) {
                      return vertex.normal_displacement == 0. &&
                             vertex.gap == 0.;
                    }))
      boundary.held_vertices.clear();
    contact_space = ContactSpace<dim>(boundary, boundary_normals);
  }



  template <int dim>
  const dealii::DoFHandler<dim> &
  ElasticUnknowns<dim>::dof_handler() const
  {
    return dofs;
  }



  template <int dim>
  const dealii::Mapping<dim> &
  ElasticUnknowns<dim>::mapping() const
  {
    return mapping_p1;
  }



  template <int dim>
  unsigned int
  ElasticUnknowns<dim>::degree() const
  {
    return fe.degree;
  }



  template <int dim>
  const ContactSpace<dim> &
  ElasticUnknowns<dim>::contact() const
  {
    return contact_space;
  }



  template <int dim>
  const std::vector<typename ElasticUnknowns<dim>::Frame> &
  ElasticUnknowns<dim>::frames() const
  {
    return node_frames;
  }



  template <int dim>
  const dealii::Tensor<2, dim> *
  ElasticUnknowns<dim>::directions(const unsigned int node_index) const
  {
    const unsigned int frame = frame_of_node[node_index];
    return frame == dealii::numbers::invalid_unsigned_int ?
             nullptr :
             &node_frames[frame].to_cartesian;
  }



  template <int dim>
  const std::vector<std::string> &
  ElasticUnknowns<dim>::support_names() const
  {
    return names_of_supports;
  }



  template <int dim>
  const FreeRigidMotions<dim> &
  ElasticUnknowns<dim>::held_by_contact() const
  {
    return free_motions;
  }



  template <int dim>
  const std::vector<typename ElasticUnknowns<dim>::Supported> &
  ElasticUnknowns<dim>::supported() const
  {
    return supported_dofs;
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::has_lifting() const
  {
    return prescribed.size() > 0 || gap.size() > 0;
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::has_prescribed_displacements() const
  {
    return prescribed.size() > 0;
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::has_gap() const
  {
    return gap.size() > 0;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::lifting(const LoadFactors factors) const
  {
    dealii::Vector<double> G(n_dofs());
    if (prescribed.size() > 0)
      G.equ(factors.displacements, prescribed);
    if (gap.size() > 0)
      G += gap;
    return G;
  }



  template <int dim>
  unsigned int
  ElasticUnknowns<dim>::n_dofs() const
  {
    return dofs.n_dofs();
  }



  template <int dim>
  unsigned int
  ElasticUnknowns<dim>::n_free_dofs() const
  {
    return n_dofs() - fixed.n_constraints();
  }



  template <int dim>
  bool
  ElasticUnknowns<dim>::is_constrained(
    const dealii::types::global_dof_index dof) const
  {
    return fixed.is_constrained(dof);
  }



  template <int dim>
  const dealii::AffineConstraints<double> &
  ElasticUnknowns<dim>::constraints() const
  {
    return fixed;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::cartesian_displacement(const dealii::Vector<double> &w,
                                               const LoadFactors factors) const
  {
    dealii::Vector<double> u = w;
    if (has_lifting())
      u += lifting(factors);
    dealii::Vector<double> result = u;
    for (const Frame &frame : node_frames)
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[frame.dofs[d]] = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result[frame.dofs[d]] +=
              frame.to_cartesian[d][k] * u[frame.dofs[k]];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::nodal_values(
    const dealii::Vector<double> &cartesian_displacement) const
  {
    dealii::Vector<double> result = cartesian_displacement;
    if (degree() == 2)
      for (const auto &cell : dofs.active_cell_iterators())
        {
          const CellNodes<dim> nodes(cell);
          for (unsigned int n = dim + 1; n < nodes.size; ++n)
            {
              const auto &[a, b] = simplex_edges[n - (dim + 1)];
              for (unsigned int d = 0; d < dim; ++d)
                result(nodes.dofs[n][d]) =
                  0.5 * cartesian_displacement(nodes.dofs[n][d]) +
                  0.25 * (cartesian_displacement(nodes.dofs[a][d]) +
                          cartesian_displacement(nodes.dofs[b][d]));
            }
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::to_frames(const dealii::Vector<double> &cartesian) const
  {
    dealii::Vector<double> result = cartesian;
    for (const Frame &frame : node_frames)
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_frame[k][d] * cartesian[frame.dofs[d]];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::from_cartesian(
    const dealii::Vector<double> &cartesian_displacement) const
  {
    dealii::Vector<double> result = to_frames(cartesian_displacement);
    if (has_lifting())
      result -= lifting();
    fixed.set_zero(result);
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::in_frames(const dealii::Vector<double> &forces) const
  {
    dealii::Vector<double> result = forces;
    for (const Frame &frame : node_frames)
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_cartesian[d][k] * forces[frame.dofs[d]];
        }
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::cartesian_forces(
    const dealii::Vector<double> &forces) const
  {
    dealii::Vector<double> result = forces;
    for (const Frame &frame : node_frames)
      for (unsigned int d = 0; d < dim; ++d)
        {
          result[frame.dofs[d]] = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            result[frame.dofs[d]] +=
              frame.to_frame[k][d] * forces[frame.dofs[k]];
        }
    return result;
  }



  template <int dim>
  std::vector<dealii::Vector<double>>
  ElasticUnknowns<dim>::rigid_body_modes() const
  {
    constexpr unsigned int              n_rotations = dim * (dim - 1) / 2;
    std::vector<dealii::Vector<double>> modes(
      dim + n_rotations, dealii::Vector<double>(dofs.n_dofs()));
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const CellNodes<dim> nodes(cell);
        for (unsigned int n = 0; n < nodes.size; ++n)
          {
            const dealii::Point<dim> position = node_position<dim>(cell, n);
            for (unsigned int d = 0; d < dim; ++d)
              modes[d][nodes.dofs[n][d]] = 1.;
            // The rotation in the plane of the axes d and e.
            unsigned int rotation = dim;
            for (unsigned int d = 0; d < dim; ++d)
              for (unsigned int e = d + 1; e < dim; ++e, ++rotation)
                {
                  modes[rotation][nodes.dofs[n][d]] = -position[e];
                  modes[rotation][nodes.dofs[n][e]] = position[d];
                }
          }
      }
    for (dealii::Vector<double> &mode : modes)
      {
        mode = to_frames(mode);
        fixed.set_zero(mode);
      }
    return modes;
  }



  template class ElasticUnknowns<2>;
  template class ElasticUnknowns<3>;
} // namespace Debond
