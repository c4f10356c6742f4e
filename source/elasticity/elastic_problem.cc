// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>

#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/crossed_mesh.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/rigid_motions.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>

namespace Debond
{
  namespace
  {
    /// Volume of a simplex and the (constant) gradients of its P1 basis.
    template <int dim>
    struct LinearSimplex
    {
      template <typename CellIterator>
      explicit LinearSimplex(const CellIterator &cell)
      {
        dealii::Tensor<2, dim> edges;
        for (unsigned int d = 0; d < dim; ++d)
          edges[d] = cell->vertex(d + 1) - cell->vertex(0);
        volume = dealii::determinant(edges) / (dim == 2 ? 2. : 6.);

        const dealii::Tensor<2, dim> inverse = dealii::invert(edges);
        for (unsigned int v = 1; v <= dim; ++v)
          for (unsigned int d = 0; d < dim; ++d)
            gradients[v][d] = inverse[d][v - 1];
        for (unsigned int v = 1; v <= dim; ++v)
          gradients[0] -= gradients[v];
      }

      double                                      volume;
      std::array<dealii::Tensor<1, dim>, dim + 1> gradients;
    };



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
                   const std::set<dealii::types::boundary_id> &boundaries)
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
          "Boundary conditions: " + boundary_name<dim>(*missing.begin()) +
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
  ElasticProblem<dim>::ElasticProblem(
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
          "Boundary conditions: " + boundary_name<dim>(id) +
          " is both clamped and a contact boundary.");

    dofs.distribute_dofs(fe);
    const double diameter = [&] {
      const auto corners =
        dealii::BoundingBox<dim>(triangulation.get_vertices())
          .get_boundary_points();
      return corners.first.distance(corners.second);
    }();

    std::vector<Support<dim>> supports;
    clamp(conditions.clamped, supports);
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

    constraints.close();

    dealii::DynamicSparsityPattern pattern(dofs.n_dofs());
    dealii::DoFTools::make_sparsity_pattern(dofs,
                                            pattern,
                                            constraints,
                                            /*keep_constrained_dofs=*/false);
    sparsity.copy_from(pattern);
    system_matrix.reinit(sparsity);
  }



  template <int dim>
  void
  ElasticProblem<dim>::clamp(
    const std::set<dealii::types::boundary_id> &boundaries,
    std::vector<Support<dim>>                  &supports)
  {
    for (const BoundaryFace<dim> &face : boundary_faces(dofs, boundaries))
      for (unsigned int v = 0; v < dim; ++v)
        clamp_vertex(face.dofs[v], face.vertices[v], supports);
  }



  template <int dim>
  void
  ElasticProblem<dim>::clamp_vertex(
    const std::array<dealii::types::global_dof_index, dim> &vertex_dofs,
    const dealii::Point<dim>                               &position,
    std::vector<Support<dim>>                              &supports)
  {
    if (constraints.is_constrained(vertex_dofs[0]))
      return;
    for (unsigned int d = 0; d < dim; ++d)
      {
        constraints.add_line(vertex_dofs[d]);
        supports.push_back({position, dealii::Point<dim>::unit_vector(d)});
      }
  }



  template <int dim>
  void
  ElasticProblem<dim>::make_contact_boundary(
    const BoundaryConditions  &conditions,
    const double               diameter,
    std::vector<Support<dim>> &supports)
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    const std::vector<BoundaryFace<dim>> faces =
      boundary_faces(dofs, conditions.contact);

    // By vertex index; clamped vertices are left out. For each face, the group
    // of normals that it belongs to at each of its vertices.
    std::map<unsigned int, ContactVertex<dim>> vertices;
    std::vector<std::array<unsigned int, dim>> groups(faces.size());
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (unsigned int v = 0; v < dim; ++v)
        if (!constraints.is_constrained(faces[f].dofs[v][0]))
          {
            ContactVertex<dim> &vertex = vertices[faces[f].indices[v]];
            vertex.dofs                = faces[f].dofs[v];
            vertex.position            = faces[f].vertices[v];
            groups[f][v] =
              vertex.normals.add_face(faces[f].normal, faces[f].measure);
          }

    std::vector<typename ContactBoundary<dim>::Node> nodes;
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
        frame_of_vertex[index] = frames.size();
        frames.push_back(frame);

        if (conditions.tangential_displacement_fixed)
          for (unsigned int d = 1; d < dim; ++d)
            {
              constraints.add_line(vertex.dofs[d]);
              supports.push_back({vertex.position, frame.to_frame[d]});
              ++n_fixed_tangential_dofs;
            }

        vertex.first_node = nodes.size();
        for (unsigned int k = 0; k < n_normals; ++k)
          nodes.push_back({vertex.dofs[k],
                           vertex.position,
                           normals[k],
                           vertex.normals.measure(k)});
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

    std::vector<unsigned int> place(nodes.size());
    for (unsigned int k = 0; k < order.size(); ++k)
      {
        place[order[k]] = k;
        contact.nodes.push_back(nodes[order[k]]);
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
        contact.faces.push_back(face);
      }
  }



  template <int dim>
  void
  ElasticProblem<dim>::assemble(const Material   &new_material,
                                const Loads<dim> &loads)
  {
    new_material.validate<dim>();
    applied_forces   = load_vector(dofs, loads);
    elastic_material = new_material;
    stiffness        = new_material.elasticity_tensor<dim>();

    system_load = in_frames(applied_forces);
    constraints.set_zero(system_load);

    system_matrix                          = 0.;
    const unsigned int         n_cell_dofs = fe.n_dofs_per_cell();
    dealii::FullMatrix<double> cell_matrix(n_cell_dofs);
    std::vector<dealii::types::global_dof_index> cell_dofs(n_cell_dofs);
    std::array<dealii::SymmetricTensor<2, dim>, dim *(dim + 1)> strains;

    for (const auto &cell : dofs.active_cell_iterators())
      {
        const LinearSimplex<dim> simplex(cell);

        // The basis function of the unknown k of vertex v is phi_v times the
        // direction of the unknown.
        for (unsigned int v = 0; v <= dim; ++v)
          {
            const unsigned int frame = frame_of_vertex[cell->vertex_index(v)];
            for (unsigned int k = 0; k < dim; ++k)
              {
                dealii::Tensor<1, dim> direction;
                if (frame == dealii::numbers::invalid_unsigned_int)
                  direction[k] = 1.;
                else
                  for (unsigned int d = 0; d < dim; ++d)
                    direction[d] = frames[frame].to_cartesian[d][k];

                const unsigned int i = v * dim + k;
                cell_dofs[i]         = cell->vertex_dof_index(v, k);
                strains[i]           = dealii::symmetrize(
                  dealii::outer_product(direction, simplex.gradients[v]));
              }
          }

        for (unsigned int i = 0; i < n_cell_dofs; ++i)
          {
            const dealii::SymmetricTensor<2, dim> weighted_stress =
              simplex.volume * (stiffness * strains[i]);
            for (unsigned int j = 0; j < n_cell_dofs; ++j)
              cell_matrix(i, j) = weighted_stress * strains[j];
          }
        constraints.distribute_local_to_global(cell_matrix,
                                               cell_dofs,
                                               system_matrix);
      }
  }



  template <int dim>
  dealii::Vector<double>
  ElasticProblem<dim>::in_frames(const dealii::Vector<double> &forces) const
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
  ElasticProblem<dim>::cartesian_forces(
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
  dealii::Vector<double>
  ElasticProblem<dim>::cartesian_displacement(
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
  ElasticProblem<dim>::residual(const dealii::Vector<double> &u) const
  {
    const dealii::Vector<double> displacement = cartesian_displacement(u);

    dealii::Vector<double> forces(dofs.n_dofs());
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const LinearSimplex<dim>              simplex(cell);
        const dealii::SymmetricTensor<2, dim> sigma =
          stress(cell, displacement);
        for (unsigned int v = 0; v <= dim; ++v)
          {
            const dealii::Tensor<1, dim> force =
              simplex.volume * (sigma * simplex.gradients[v]);
            for (unsigned int d = 0; d < dim; ++d)
              forces[cell->vertex_dof_index(v, d)] += force[d];
          }
      }
    forces -= applied_forces;
    return in_frames(forces);
  }



  template <int dim>
  dealii::SymmetricTensor<2, dim>
  ElasticProblem<dim>::stress(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const dealii::Vector<double> &cartesian_displacement) const
  {
    const LinearSimplex<dim> simplex(cell);
    dealii::Tensor<2, dim>   gradient;
    for (unsigned int v = 0; v <= dim; ++v)
      {
        dealii::Tensor<1, dim> displacement;
        for (unsigned int d = 0; d < dim; ++d)
          displacement[d] =
            cartesian_displacement[cell->vertex_dof_index(v, d)];
        gradient += dealii::outer_product(displacement, simplex.gradients[v]);
      }
    return stiffness * dealii::symmetrize(gradient);
  }



  template <int dim>
  dealii::Tensor<1, dim>
  ElasticProblem<dim>::total_load() const
  {
    dealii::Tensor<1, dim> result;
    std::vector<bool>      visited(frame_of_vertex.size(), false);
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (!visited[cell->vertex_index(v)])
          {
            visited[cell->vertex_index(v)] = true;
            for (unsigned int d = 0; d < dim; ++d)
              result[d] += applied_forces[cell->vertex_dof_index(v, d)];
          }
    return result;
  }



  template <int dim>
  const dealii::DoFHandler<dim> &
  ElasticProblem<dim>::dof_handler() const
  {
    return dofs;
  }



  template <int dim>
  const dealii::Mapping<dim> &
  ElasticProblem<dim>::mapping() const
  {
    return mapping_p1;
  }



  template <int dim>
  const dealii::SparseMatrix<double> &
  ElasticProblem<dim>::matrix() const
  {
    return system_matrix;
  }



  template <int dim>
  const dealii::Vector<double> &
  ElasticProblem<dim>::load() const
  {
    return system_load;
  }



  template <int dim>
  const ContactBoundary<dim> &
  ElasticProblem<dim>::contact_boundary() const
  {
    return contact;
  }



  template <int dim>
  unsigned int
  ElasticProblem<dim>::n_dofs() const
  {
    return dofs.n_dofs();
  }



  template <int dim>
  unsigned int
  ElasticProblem<dim>::n_free_dofs() const
  {
    return n_dofs() - constraints.n_constraints();
  }



  template <int dim>
  unsigned int
  ElasticProblem<dim>::n_dofs_paper() const
  {
    return n_free_dofs() + n_fixed_tangential_dofs;
  }



  template <int dim>
  bool
  ElasticProblem<dim>::is_constrained(
    const dealii::types::global_dof_index dof) const
  {
    return constraints.is_constrained(dof);
  }



  template <int dim>
  const Material &
  ElasticProblem<dim>::material() const
  {
    return elastic_material;
  }



  template class ElasticProblem<2>;
  template class ElasticProblem<3>;
} // namespace Debond
