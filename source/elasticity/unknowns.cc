// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/linear_simplex.h>
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
        const auto   reference = cell->reference_cell();
        unsigned int opposite  = dim * (dim + 1) / 2;
        for (unsigned int v = 0; v < dim; ++v)
          {
            const unsigned int cell_vertex =
              reference.face_to_cell_vertices(face_no, v, 1);
            opposite -= cell_vertex;
            indices[v]  = cell->vertex_index(cell_vertex);
            vertices[v] = cell->vertex(cell_vertex);
            for (unsigned int d = 0; d < dim; ++d)
              dofs[v][d] = cell->vertex_dof_index(cell_vertex, d);
          }

        // The basis function of the opposite vertex grows inwards.
        const LinearSimplex<dim>     simplex(cell);
        const dealii::Tensor<1, dim> inward = simplex.gradients[opposite];

        measure = dim * simplex.volume * inward.norm();
        normal  = -inward / inward.norm();
      }

      std::array<unsigned int, dim>       indices;
      std::array<dealii::Point<dim>, dim> vertices;
      std::array<std::array<dealii::types::global_dof_index, dim>, dim> dofs;
      double                                                            measure;
      dealii::Tensor<1, dim>                                            normal;
    };



    /// All faces of the given boundaries, each of which must exist.
    template <int dim>
    std::vector<BoundaryFace<dim>>
    boundary_faces(const dealii::DoFHandler<dim>              &dofs,
                   const std::set<dealii::types::boundary_id> &boundaries,
                   const BoundaryNames                        &names)
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
      if (!missing.empty())
        throw std::invalid_argument(
          "Boundary conditions: " + boundary_name(names, *missing.begin()) +
          " is clamped or a contact boundary, but the mesh has no such "
          "boundary.");
      return faces;
    }



    /// A vertex of the contact boundary that is not clamped.
    template <int dim>
    struct ContactVertex
    {
      std::array<dealii::types::global_dof_index, dim> dofs;
      dealii::Point<dim>                               position;
      VertexNormals<dim>                               normals;
      unsigned int first_node = dealii::numbers::invalid_unsigned_int;
    };



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
    const BoundaryConditions         &conditions)
    : mapping_p1(dealii::FE_SimplexP<dim>(1))
    , fe(dealii::FE_SimplexP<dim>(1), dim)
    , dofs(triangulation)
    , frame_of_vertex(triangulation.n_vertices(),
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
    const double diameter = [&] {
      const auto corners =
        dealii::BoundingBox<dim>(triangulation.get_vertices())
          .get_boundary_points();
      return corners.first.distance(corners.second);
    }();

    std::vector<Support<dim>> supports;
    clamp(conditions, supports);
    make_contact_boundary(conditions, diameter, supports);

    const std::vector<std::string> motions =
      free_rigid_motions(supports, diameter);
    if (!motions.empty())
      {
        std::string list = motions.front();
        for (unsigned int k = 1; k < motions.size(); ++k)
          list += ", " + motions[k];
        throw std::invalid_argument(
          "Boundary conditions leave a rigid motion free: " + list +
          ". Clamp a side.");
      }

    fixed.close();
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::clamp(const BoundaryConditions  &conditions,
                              std::vector<Support<dim>> &supports)
  {
    for (const BoundaryFace<dim> &face :
         boundary_faces(dofs, conditions.clamped, conditions.names))
      for (unsigned int v = 0; v < dim; ++v)
        clamp_vertex(face.dofs[v], face.vertices[v], supports);
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::clamp_vertex(
    const std::array<dealii::types::global_dof_index, dim> &vertex_dofs,
    const dealii::Point<dim>                               &position,
    std::vector<Support<dim>>                              &supports)
  {
    if (fixed.is_constrained(vertex_dofs[0]))
      return;
    for (unsigned int d = 0; d < dim; ++d)
      {
        fixed.add_line(vertex_dofs[d]);
        supports.push_back({position, dealii::Point<dim>::unit_vector(d)});
      }
  }



  template <int dim>
  void
  ElasticUnknowns<dim>::make_contact_boundary(
    const BoundaryConditions  &conditions,
    const double               diameter,
    std::vector<Support<dim>> &supports)
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    const std::vector<BoundaryFace<dim>> faces =
      boundary_faces(dofs, conditions.contact, conditions.names);

    // By vertex index; clamped vertices are left out. For each face, the group
    // of normals that it belongs to at each of its vertices.
    std::map<unsigned int, ContactVertex<dim>> vertices;
    std::vector<std::array<unsigned int, dim>> groups(faces.size());
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (unsigned int v = 0; v < dim; ++v)
        if (!fixed.is_constrained(faces[f].dofs[v][0]))
          {
            ContactVertex<dim> &vertex = vertices[faces[f].indices[v]];
            vertex.dofs                = faces[f].dofs[v];
            vertex.position            = faces[f].vertices[v];
            groups[f][v] =
              vertex.normals.add_face(faces[f].normal, faces[f].measure);
          }

    std::vector<typename ContactBoundary<dim>::Node> nodes;
    std::vector<dealii::types::global_dof_index>     normal_dofs;
    for (auto &[index, vertex] : vertices)
      {
        const unsigned int n_normals = vertex.normals.n_groups();
        if (conditions.tangential_displacement_fixed && n_normals > 1)
          {
            clamp_vertex(vertex.dofs, vertex.position, supports);
            continue;
          }

        const std::vector<dealii::Tensor<1, dim>> normals =
          vertex.normals.normals();
        Frame frame;
        frame.dofs             = vertex.dofs;
        frame.to_frame         = contact_frame(normals);
        frame.to_cartesian     = dealii::invert(frame.to_frame);
        frame_of_vertex[index] = static_cast<unsigned int>(frames.size());
        frames.push_back(frame);

        if (conditions.tangential_displacement_fixed)
          for (unsigned int d = 1; d < dim; ++d)
            {
              fixed.add_line(vertex.dofs[d]);
              supports.push_back({vertex.position, frame.to_frame[d]});
            }

        vertex.first_node = static_cast<unsigned int>(nodes.size());
        for (unsigned int k = 0; k < n_normals; ++k)
          {
            normal_dofs.push_back(vertex.dofs[k]);
            nodes.push_back(
              {vertex.position, normals[k], vertex.normals.measure(k)});
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

    ContactBoundary<dim>                         boundary;
    std::vector<dealii::types::global_dof_index> boundary_normals;
    std::vector<unsigned int>                    place(nodes.size());
    for (unsigned int k = 0; k < order.size(); ++k)
      {
        place[order[k]] = k;
        boundary.nodes.push_back(nodes[order[k]]);
        boundary_normals.push_back(normal_dofs[order[k]]);
      }

    for (unsigned int f = 0; f < faces.size(); ++f)
      {
        typename ContactBoundary<dim>::Face face;
        face.vertices = faces[f].vertices;
        face.normal   = faces[f].normal;
        face.measure  = faces[f].measure;
        for (unsigned int v = 0; v < dim; ++v)
          {
            const auto vertex = vertices.find(faces[f].indices[v]);
            face.nodes[v] =
              (vertex == vertices.end() || vertex->second.first_node == none) ?
                none :
                place[vertex->second.first_node + groups[f][v]];
          }
        boundary.faces.push_back(face);
      }
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
  const ContactSpace<dim> &
  ElasticUnknowns<dim>::contact() const
  {
    return contact_space;
  }



  template <int dim>
  const std::vector<typename ElasticUnknowns<dim>::Frame> &
  ElasticUnknowns<dim>::contact_frames() const
  {
    return frames;
  }



  template <int dim>
  const dealii::Tensor<2, dim> *
  ElasticUnknowns<dim>::directions(const unsigned int vertex_index) const
  {
    const unsigned int frame = frame_of_vertex[vertex_index];
    return frame == dealii::numbers::invalid_unsigned_int ?
             nullptr :
             &frames[frame].to_cartesian;
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
  ElasticUnknowns<dim>::cartesian_displacement(
    const dealii::Vector<double> &u) const
  {
    dealii::Vector<double> result = u;
    for (const Frame &frame : frames)
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
  ElasticUnknowns<dim>::from_cartesian(
    const dealii::Vector<double> &cartesian_displacement) const
  {
    dealii::Vector<double> result = cartesian_displacement;
    for (const Frame &frame : frames)
      for (unsigned int k = 0; k < dim; ++k)
        {
          result[frame.dofs[k]] = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            result[frame.dofs[k]] +=
              frame.to_frame[k][d] * cartesian_displacement[frame.dofs[d]];
        }
    fixed.set_zero(result);
    return result;
  }



  template <int dim>
  dealii::Vector<double>
  ElasticUnknowns<dim>::in_frames(const dealii::Vector<double> &forces) const
  {
    dealii::Vector<double> result = forces;
    for (const Frame &frame : frames)
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
    for (const Frame &frame : frames)
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
      for (const unsigned int v : cell->vertex_indices())
        {
          for (unsigned int d = 0; d < dim; ++d)
            modes[d][cell->vertex_dof_index(v, d)] = 1.;
          // The rotation in the plane of the axes d and e.
          unsigned int rotation = dim;
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int e = d + 1; e < dim; ++e, ++rotation)
              {
                modes[rotation][cell->vertex_dof_index(v, d)] =
                  -cell->vertex(v)[e];
                modes[rotation][cell->vertex_dof_index(v, e)] =
                  cell->vertex(v)[d];
              }
        }
    for (dealii::Vector<double> &mode : modes)
      mode = from_cartesian(mode);
    return modes;
  }



  template class ElasticUnknowns<2>;
  template class ElasticUnknowns<3>;
} // namespace Debond
