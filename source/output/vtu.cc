// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <debond/base/atomic_file.h>
#include <debond/elasticity/cell_nodes.h>
#include <debond/output/vtu.h>
#include <debond/output/vtu_grid.h>

#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    /// Appends a number or, of a vector, three.
    void
    add(const double number, VtuGrid::Field &field)
    {
      field.numbers.push_back(static_cast<float>(number));
    }



    template <int dim>
    void
    add(const dealii::Tensor<1, dim> &vector, VtuGrid::Field &field)
    {
      for (unsigned int d = 0; d < 3; ++d)
        add(d < dim ? vector[d] : 0., field);
    }



    template <int dim>
    VtuGrid::CellType
    cell_type(const unsigned int degree)
    {
      using Type = VtuGrid::CellType;
      if (dim == 2)
        return degree == 1 ? Type::triangle : Type::quadratic_triangle;
      return degree == 1 ? Type::tetrahedron : Type::quadratic_tetrahedron;
    }



    /// The cells of the body, of @p piece its own ones, and their fields.
    template <int dim>
    VtuGrid
    body_grid(const ElasticProblem<dim>    &problem,
              const DofVector              &u,
              const LoadFactors             factors,
              const ErrorEstimate          *estimate,
              const std::vector<CellField> &more,
              const ProblemPiece<dim>      *piece)
    {
      const auto &dofs     = problem.unknowns().dof_handler();
      const auto &mesh     = dofs.get_triangulation();
      const auto  material = [&problem](const auto &cell) -> const Material  &{
        return problem.fields().material(cell);
      };
      const unsigned int degree = problem.unknowns().degree();
      const DofVector    displacement =
        problem.unknowns().cartesian_displacement(u, factors);
      const DofVector at_nodes = problem.unknowns().nodal_values(displacement);

      VtuGrid grid;
      grid.type      = cell_type<dim>(degree);
      grid.at_points = {{"displacement", 3, {}}};
      grid.points.reserve(3UL * n_nodes<dim>(mesh, degree));
      grid.at_points[0].numbers.reserve(3UL * n_nodes<dim>(mesh, degree));
      grid.cells.reserve(static_cast<std::size_t>(n_points(grid.type)) *
                         mesh.n_active_cells());

      const auto add_field = [&](const std::string &name) {
        grid.in_cells.push_back({name, 1, {}});
        grid.in_cells.back().numbers.reserve(mesh.n_active_cells());
      };
      constexpr unsigned int n_components =
        dealii::SymmetricTensor<2, dim>::n_independent_components;
      const std::string axes = "xyz";
      for (unsigned int c = 0; c < n_components; ++c)
        {
          const auto ij =
            dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(c);
          add_field(std::string("stress_") + axes[ij[0]] + axes[ij[1]]);
        }
      bool has_regions = false;
      for (const auto &cell : dofs.active_cell_iterators())
        has_regions |=
          cell->material_id() != dofs.begin_active()->material_id();
      const bool plane_strain =
        dim == 2 && material(dofs.begin_active()).hypothesis ==
                      Material::Hypothesis::plane_strain;
      if (plane_strain)
        add_field("stress_zz");
      if (has_regions)
        add_field("region");
      add_field("von_mises");
      add_field("strain_energy_density");
      if (estimate != nullptr)
        add_field("error_density");
      for (const auto &[name, unused] : more)
        add_field(name);

      constexpr std::uint32_t    none = -1;
      std::vector<std::uint32_t> point_of_node(n_nodes<dim>(mesh, degree),
                                               none);
      for (const auto &cell : dofs.active_cell_iterators())
        {
          if (piece != nullptr &&
              !piece->body().owns_cell(cell->active_cell_index()))
            continue;
          const CellNodes<dim> nodes(cell);
          for (unsigned int n = 0; n < nodes.size; ++n)
            {
              std::uint32_t &point = point_of_node[nodes.indices[n]];
              if (point == none)
                {
                  point = grid.add_point(node_position<dim>(cell, n));
                  dealii::Tensor<1, dim> value;
                  for (unsigned int d = 0; d < dim; ++d)
                    value[d] = at_nodes(nodes.dofs[n][d]);
                  add(value, grid.at_points[0]);
                }
              grid.cells.push_back(point);
            }

          const dealii::SymmetricTensor<2, 3> stress =
            problem.fields().solid_stress(cell, displacement, factors);
          auto       field    = grid.in_cells.begin();
          const auto add_next = [&field](const double number) {
            add(number, *field++);
          };
          for (unsigned int c = 0; c < n_components; ++c)
            add_next(stress[dealii::SymmetricTensor<2, dim>::
                              unrolled_to_component_indices(c)]);
          if (plane_strain)
            add_next(stress[2][2]);
          if (has_regions)
            add_next(cell->material_id());
          add_next(von_mises(stress));
          add_next(material(cell).energy_density(stress));
          if (estimate != nullptr)
            add_next(estimate->cells[cell->active_cell_index()] /
                     cell->measure());
          for (const auto &[unused, numbers] : more)
            add_next(numbers[cell->active_cell_index()]);
        }
      return grid;
    }



    /// The fields at points of the contact boundary, after two vectors.
    const std::vector<std::string> contact_scalars = {"u_nu",
                                                      "gap",
                                                      "normal_force_density",
                                                      "law_violation",
                                                      "bond_stiffness",
                                                      "bond_threshold",
                                                      "initial_gap"};

    template <int dim>
    using ContactValues = std::array<double, 2 * dim + 7>;



    /// Between points, without those at which a value is not known.
    template <int dim>
    ContactValues<dim>
    mean(const ContactValues<dim>              &own,
         const std::vector<ContactValues<dim>> &others)
    {
      ContactValues<dim> result;
      for (unsigned int c = 0; c < own.size(); ++c)
        {
          double       sum = own[c];
          unsigned int n   = 1;
          for (const ContactValues<dim> &other : others)
            if (!std::isnan(other[c]))
              {
                sum += other[c];
                ++n;
              }
          result[c] = sum / n;
        }
      return result;
    }



    /// The parts of a face with a node at each corner and none between.
    template <int dim>
    std::vector<std::array<unsigned int, dim>>
    parts_of_face(const unsigned int degree)
    {
      if constexpr (dim == 2)
        return degree == 1 ?
                 std::vector<std::array<unsigned int, 2>>{{{0, 1}}} :
                 std::vector<std::array<unsigned int, 2>>{{{0, 2}}, {{2, 1}}};
      else
        return degree == 1 ?
                 std::vector<std::array<unsigned int, 3>>{{{0, 1, 2}}} :
                 std::vector<std::array<unsigned int, 3>>{{{0, 3, 5}},
                                                          {{3, 1, 4}},
                                                          {{5, 4, 2}},
                                                          {{3, 4, 5}}};
    }
  } // namespace



  template <int dim>
  void
  write_body_vtu(const ElasticProblem<dim>    &problem,
                 const DofVector              &u,
                 const std::string            &file_name,
                 const LoadFactors             factors,
                 const ErrorEstimate          *estimate,
                 const std::vector<CellField> &more)
  {
    const VtuGrid grid =
      body_grid<dim>(problem, u, factors, estimate, more, nullptr);
    write_atomically(file_name,
                     [&grid](std::ostream &out) { write_vtu(grid, out); });
  }



  template <int dim>
  std::vector<std::string>
  write_body_pieces(const ElasticProblem<dim> &problem,
                    const ProblemPiece<dim>   &piece,
                    const DofVector           &u,
                    const ErrorEstimate       *estimate,
                    const std::string         &directory)
  {
    const VtuGrid grid = body_grid<dim>(problem, u, 1., estimate, {}, &piece);

    const MPI_Comm ranks = piece.nodes().communicator();
    const auto     name  = [](const unsigned int rank) {
      return "body.rank" + std::to_string(rank) + ".vtu";
    };
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(ranks);
    std::vector<std::string> written = {directory + "/" + name(rank)};
    write_atomically(written[0],
                     [&grid](std::ostream &out) { write_vtu(grid, out); });
    if (rank == 0)
      {
        std::vector<std::string> names;
        for (unsigned int k = 0;
             k < dealii::Utilities::MPI::n_mpi_processes(ranks);
             ++k)
          names.push_back(name(k));
        written.push_back(directory + "/body.pvtu");
        write_atomically(written[1], [&](std::ostream &out) {
          write_pvtu(grid, names, out);
        });
      }
    return written;
  }



  template <int dim>
  void
  write_contact_vtu(const ContactBoundary<dim>   &boundary,
                    const Verification<dim>      &verification,
                    const std::string            &file_name,
                    const std::vector<CellField> &more)
  {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();

    const auto values_of = [&](const unsigned int node) {
      ContactValues<dim> values = {};
      if (node == dealii::numbers::invalid_unsigned_int)
        {
          // What a clamp bears there is not the foundation's.
          std::fill(values.begin() + dim, values.begin() + 2 * dim, nan);
          std::fill(values.begin() + 2 * dim + 2, values.end(), nan);
          return values;
        }
      const ContactNodeState &state   = verification.nodes[node];
      const double            measure = boundary.nodes[node].measure;
      for (unsigned int d = 0; d < dim; ++d)
        {
          values[d]       = verification.displacements[node][d];
          values[dim + d] = verification.tangential_forces[node][d] / measure;
        }
      values[2 * dim]     = state.u_nu;
      values[2 * dim + 1] = -state.s;
      values[2 * dim + 2] = state.normal_force / measure;
      values[2 * dim + 3] = state.violation;
      values[2 * dim + 4] = state.bond_stiffness;
      values[2 * dim + 5] = state.bond_threshold;
      values[2 * dim + 6] = state.u_nu - state.s;
      return values;
    };

    // In the middle of an edge displacements are not its coefficients.
    const auto values_at = [&](const auto &face, const unsigned int k) {
      ContactValues<dim> values = values_of(face.node(k));
      if (k < dim)
        return values;
      const ContactValues<dim> a =
        values_of(face.node(simplex_edges[k - dim][0]));
      const ContactValues<dim> b =
        values_of(face.node(simplex_edges[k - dim][1]));
      const auto interpolate = [&](const unsigned int c) {
        values[c] = 0.5 * values[c] + 0.25 * (a[c] + b[c]);
      };
      for (unsigned int d = 0; d < dim; ++d)
        interpolate(d);
      interpolate(2 * dim);
      interpolate(2 * dim + 1);
      return values;
    };

    // Each vertex has its share of the face, so that its state can be shown
    // without a transition to that of its neighbours.
    VtuGrid grid;
    grid.type =
      dim == 2 ? VtuGrid::CellType::line : VtuGrid::CellType::quadrilateral;
    grid.at_points = {{"displacement", 3, {}},
                      {"tangential_force_density", 3, {}}};
    for (const std::string &name : contact_scalars)
      grid.at_points.push_back({name, 1, {}});
    grid.in_cells = {{"bond_state", 1, {}}};
    for (const auto &[name, unused] : more)
      grid.in_cells.push_back({name, 1, {}});
    const auto add_point = [&grid](const dealii::Point<dim> &position,
                                   const ContactValues<dim> &values) {
      grid.cells.push_back(grid.add_point(position));
      for (unsigned int v = 0; v < 2; ++v)
        {
          dealii::Tensor<1, dim> vector;
          for (unsigned int d = 0; d < dim; ++d)
            vector[d] = values[v * dim + d];
          add(vector, grid.at_points[v]);
        }
      for (unsigned int c = 0; c < contact_scalars.size(); ++c)
        add(values[2 * dim + c], grid.at_points[2 + c]);
    };
    for (unsigned int f = 0; f < boundary.faces.size(); ++f)
      for (const auto &part : parts_of_face<dim>(boundary.degree))
        {
          const auto                         &face = boundary.faces[f];
          std::array<ContactValues<dim>, dim> values;
          std::array<dealii::Point<dim>, dim> corners;
          for (unsigned int k = 0; k < dim; ++k)
            {
              values[k] = values_at(face, part[k]);
              corners[k] =
                part[k] < dim ?
                  face.vertices[part[k]] :
                  face.vertices[simplex_edges[part[k] - dim][0]] +
                    0.5 * (face.vertices[simplex_edges[part[k] - dim][1]] -
                           face.vertices[simplex_edges[part[k] - dim][0]]);
            }

          for (unsigned int k = 0; k < dim; ++k)
            {
              const auto add_middle = [&](const unsigned int other) {
                add_point(corners[k] + 0.5 * (corners[other] - corners[k]),
                          mean<dim>(values[k], {values[other]}));
              };
              const unsigned int next = (k + 1) % dim,
                                 last = (k + dim - 1) % dim;
              add_point(corners[k], values[k]);
              add_middle(next);
              if constexpr (dim == 3)
                {
                  add_point(corners[0] + (corners[1] - corners[0]) / 3. +
                              (corners[2] - corners[0]) / 3.,
                            mean<dim>(values[k], {values[next], values[last]}));
                  add_middle(last);
                }

              add(static_cast<double>(
                    face.is_held(part[k]) ?
                      BondState::held :
                      verification.nodes[face.node(part[k])].state),
                  grid.in_cells[0]);
              for (unsigned int m = 0; m < more.size(); ++m)
                add(more[m].second[f], grid.in_cells[m + 1]);
            }
        }
    write_atomically(file_name,
                     [&grid](std::ostream &out) { write_vtu(grid, out); });
  }



  template decltype(write_body_vtu<2>)    write_body_vtu<2>;
  template decltype(write_body_vtu<3>)    write_body_vtu<3>;
  template decltype(write_body_pieces<2>) write_body_pieces<2>;
  template decltype(write_body_pieces<3>) write_body_pieces<3>;
  template decltype(write_contact_vtu<2>) write_contact_vtu<2>;
  template decltype(write_contact_vtu<3>) write_contact_vtu<3>;
} // namespace Debond
