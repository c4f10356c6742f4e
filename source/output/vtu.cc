// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/mesh/owned_cells.h>
#include <debond/output/vtu.h>
#include <debond/output/vtu_grid.h>

#include <filesystem>

namespace Debond
{
  namespace
  {
    /// The own cells of this rank with the displacement at their nodes.
    template <int dim>
    VtuGrid
    body_grid(const ElasticUnknowns<dim> &unknowns,
              const DofVector            &displacement)
    {
      // deal.II's own output would write each cell with points of its own. Here
      // each node becomes a point when the first cell with it is met, and later
      // cells refer to this point: the file is smaller, and fields at points
      // are continuous. The nodes of a cell are its vertices and then the
      // middles of its edges, and deal.II's order of edges is VTK's as well. Of
      // several ranks each has its own cells; nodes between them are points of
      // both.
      using Type                 = VtuGrid::CellType;
      const auto        &dofs    = unknowns.dof_handler();
      const bool         linear  = unknowns.degree() == 1;
      const unsigned int n_nodes = n_coefficients(dim + 1, unknowns.degree());

      VtuGrid grid = {dim == 2 ?
                        (linear ? Type::triangle : Type::quadratic_triangle) :
                        (linear ? Type::tetrahedron :
                                  Type::quadratic_tetrahedron),
                      n_nodes};
      VtuGrid::Field u = {"displacement", 3};
      grid.cells.reserve(std::size_t(n_nodes) *
                         dofs.get_triangulation().n_active_cells());
      std::vector<std::int32_t> point_of_node(dofs.n_dofs() / dim, -1);
      std::vector<dealii::types::global_dof_index> cell_dofs(dim * n_nodes);
      for (const auto &cell : owned_cells(dofs))
        {
          cell->get_dof_indices(cell_dofs);
          for (unsigned int n = 0; n < n_nodes; ++n)
            {
              // The degrees of freedom of a node are numbered one after the
              // other, the first one by dim times the number of the node.
              const auto    first = cell_dofs[dim * n];
              std::int32_t &point = point_of_node[first / dim];
              if (point < 0)
                {
                  dealii::Point<dim> position = cell->vertex(n <= dim ? n : 0);
                  if (n > dim)
                    {
                      const auto &[a, b] = simplex_edges[n - dim - 1];
                      position           = cell->vertex(a) +
                                 0.5 * (cell->vertex(b) - cell->vertex(a));
                    }
                  point = grid.add_point(position);
                  dealii::Tensor<1, dim> value;
                  for (unsigned int d = 0; d < dim; ++d)
                    value[d] = displacement(first + d);
                  u.add(value);
                }
              grid.cells.push_back(point);
            }
        }
      grid.at_points = {std::move(u)};
      return grid;
    }



    /// The numbers of the own cells of this rank.
    template <int dim>
    std::vector<VtuGrid::Field>
    cell_fields(const ElasticProblem<dim>    &problem,
                const DofVector              &displacement,
                const LoadFactors             factors,
                const ErrorEstimate          *estimate,
                const std::vector<CellField> &more)
    {
      // All ranks have to write the same fields, because one list of them
      // stands in the joining file. Whether there are regions or turned axes
      // anywhere is therefore asked of all ranks. The field of the stress
      // across the plane is for plane strain, which is also the hypothesis of a
      // body of revolution; there it is the stress around the axis.
      using Stress         = dealii::SymmetricTensor<2, dim>;
      const auto    &dofs  = problem.unknowns().dof_handler();
      unsigned int   least = dealii::numbers::invalid_material_id, most = 0;
      const auto    &fields   = problem.fields();
      const Symmetry symmetry = problem.unknowns().symmetry();
      bool           has_axes = false;
      for (const auto &cell : dofs.active_cell_iterators())
        {
          least = std::min<unsigned int>(least, cell->material_id());
          most  = std::max<unsigned int>(most, cell->material_id());
          has_axes |= fields.material(cell).orthotropy &&
                      fields.material(cell).axis_angle != 0.;
        }
      const MPI_Comm ranks       = problem.unknowns().communicator();
      const bool     has_regions = dealii::Utilities::MPI::min(least, ranks) <
                               dealii::Utilities::MPI::max(most, ranks);
      has_axes = any_rank(has_axes);
      const bool has_zz =
        dim == 2 && fields.material(dofs.begin_active()).hypothesis ==
                      Material::Hypothesis::plane_strain;
      // deal.II numbers the components of a symmetric tensor in a row, those of
      // the diagonal first.
      const auto names_of_components = [](const std::string &axes) {
        std::vector<std::string> names;
        for (unsigned int c = 0; c < Stress::n_independent_components; ++c)
          {
            const auto ij = Stress::unrolled_to_component_indices(c);
            names.push_back(std::string("stress_") + axes[ij[0]] + axes[ij[1]]);
          }
        return names;
      };
      const std::vector<std::string> components = names_of_components("xyz");
      const std::vector<std::string> along_axes = names_of_components("123");

      // The first cell makes the fields, in the order in which it adds its
      // numbers, and each next one adds its own in the same order; `next`
      // counts them. Therefore no number depends on the cell for being there.
      std::vector<VtuGrid::Field> all;
      std::size_t                 next = 0;
      const auto add = [&](const char *const name, const double number) {
        if (next == all.size())
          {
            all.push_back({name});
            all[next].numbers.reserve(
              dofs.get_triangulation().n_active_cells());
          }
        all[next++].numbers.push_back(static_cast<float>(number));
      };
      CellStresses<dim> means(fields, displacement, factors);
      for (const auto &cell : owned_cells(dofs))
        {
          next = 0;
          means.reinit(cell);
          const auto         stress = means.stress(0);
          const unsigned int index  = cell->active_cell_index();
          for (unsigned int c = 0; c < components.size(); ++c)
            add(components[c].c_str(),
                stress[Stress::unrolled_to_component_indices(c)]);
          if (has_zz)
            add(symmetry == Symmetry::axis ? "stress_tt" : "stress_zz",
                stress[2][2]);
          if (has_axes)
            {
              const auto own = fields.material(cell).along_axes(stress);
              for (unsigned int c = 0; c < along_axes.size(); ++c)
                add(along_axes[c].c_str(),
                    own[Stress::unrolled_to_component_indices(c)]);
            }
          if (has_regions)
            add("region", cell->material_id());
          add("von_mises", von_mises(stress));
          add("strain_energy_density",
              fields.material(cell).energy_density(stress));
          // What belongs to a cell is divided by its volume, so that cells of
          // different sizes can be compared. For a body of revolution that is
          // the volume of the ring.
          if (estimate != nullptr)
            add("error_density",
                estimate->cells[index] / cell->measure() /
                  circumference(symmetry, cell->center()));
          for (const auto &[name, numbers] : more)
            add(name.c_str(), numbers[index]);
        }
      return all;
    }



    /// A number at the nodes of the contact boundary.
    struct ContactScalar
    {
      std::string name;

      /// Gets a node's state and its measure.
      std::function<double(const ContactNodeState &, double)> value;

      /// As the displacement, of which edges have coefficients of degree 2.
      bool is_displacement = false;
    };

    const std::vector<ContactScalar> contact_scalars = {
      {"u_nu", [](const auto &node, const double) { return node.u_nu; }, true},
      {"gap", [](const auto &node, const double) { return -node.s; }, true},
      {"normal_force_density",
       [](const auto &node, const double measure) {
         return node.normal_force / measure;
       }},
      {"normal_traction",
       [](const auto &node, const double) { return node.normal_traction; }},
      {"law_violation",
       [](const auto &node, const double) { return node.violation; }},
      {"bond_stiffness",
       [](const auto &node, const double) { return node.bond_stiffness; }},
      {"bond_threshold",
       [](const auto &node, const double) { return node.bond_threshold; }},
      {"damage", [](const auto &node, const double) { return node.damage; }},
      {"initial_gap",
       [](const auto &node, const double) { return node.u_nu - node.s; },
       true}};

    /// With bonds that shear, besides.
    const std::vector<ContactScalar> shear_scalars = {
      {"mode_mixity",
       [](const auto &node, const double) {
         return node.mode_mixity.value_or(0.);
       }},
      {"shear_damage",
       [](const auto &node, const double) { return node.shear_damage; }}};

    /// Displacement, tangential force density and the numbers above, with bonds
    /// that shear also slip, shear traction and their numbers.
    using ContactValues = std::vector<double>;



    /// Returns the values of the k-th coefficient on a face. Of a held vertex
    /// the normal displacement is known, and no force is the foundation's.
    template <int dim>
    ContactValues
    values_of(const ContactBoundary<dim>                &boundary,
              const Verification<dim>                   &verification,
              const typename ContactBoundary<dim>::Face &face,
              const unsigned int                         k)
    {
      // The values are in the order of ContactValues, vectors with three
      // components. Forces are divided by the measure of the node, its share of
      // the boundary. Without `held_vertices` a held vertex is one that
      // supports fix at the foundation: its displacement and its opening are 0.
      // What the law would say there is not known and is NaN.
      constexpr double       nan = std::numeric_limits<double>::quiet_NaN();
      dealii::Tensor<1, dim> u, force, slip, shear;
      ContactNodeState       state   = {};
      double                 measure = 1.;
      if (!face.is_held(k))
        {
          const unsigned int node = face.node(k);
          u                       = verification.displacements[node];
          measure                 = boundary.nodes[node].measure;
          force = verification.tangential_forces[node] / measure;
          state = verification.nodes[node];
          if (!verification.slips.empty())
            {
              slip  = verification.slips[node];
              shear = verification.shear_tractions[node];
            }
        }
      else
        {
          if (!boundary.held_vertices.empty())
            {
              const auto &held = boundary.held_vertices[face.held_at(k)];
              state.u_nu =
                verification.displacement_factor * held.normal_displacement;
              state.s = state.u_nu - held.gap;
              u       = state.u_nu * held.normal;
            }
          for (unsigned int d = 0; d < dim; ++d)
            force[d] = slip[d] = shear[d] = nan;
          state.normal_force = state.violation = state.damage = nan;
          state.bond_stiffness = state.bond_threshold = nan;
          state.normal_traction                       = nan;
          state.shear_damage                          = nan;
          state.mode_mixity                           = nan;
        }
      ContactValues values;
      const auto    add = [&values](const dealii::Tensor<1, dim> &vector) {
        for (unsigned int d = 0; d < 3; ++d)
          values.push_back(d < dim ? vector[d] : 0.);
      };
      add(u);
      add(force);
      for (const ContactScalar &scalar : contact_scalars)
        values.push_back(scalar.value(state, measure));
      if (!verification.slips.empty())
        {
          add(slip);
          add(shear);
          for (const ContactScalar &scalar : shear_scalars)
            values.push_back(scalar.value(state, measure));
        }
      if (verification.has_friction)
        values.push_back(face.is_held(k) ? nan : state.slides.value_or(false));
      if (!verification.breaks.empty())
        {
          const BondBreak bond =
            face.is_held(k) ? BondBreak{} : verification.breaks[face.node(k)];
          values.push_back(bond.factor.value_or(nan));
          if (!verification.slips.empty())
            values.push_back(bond.mode.value_or(nan));
        }
      return values;
    }



    /// Returns the values at a vertex of a face or in the middle of an edge,
    /// where displacements are not its coefficients.
    template <int dim>
    ContactValues
    values_at(const ContactBoundary<dim>                &boundary,
              const Verification<dim>                   &verification,
              const typename ContactBoundary<dim>::Face &face,
              const unsigned int                         k)
    {
      // The value of a quadratic polynomial in the middle of an edge is half of
      // the coefficient of the edge and a quarter of those of both ends. That
      // is for the displacement, the slip, and those scalars that are
      // displacements. Forces and tractions at the node of an edge are its own
      // and stay as they are. The slip comes behind the n numbers that all laws
      // have.
      const auto of = [&](const unsigned int vertex) {
        return values_of(boundary, verification, face, vertex);
      };
      ContactValues values = of(k);
      if (k < dim)
        return values;
      const ContactValues a = of(simplex_edges[k - dim][0]),
                          b = of(simplex_edges[k - dim][1]);
      const std::size_t n   = 6 + contact_scalars.size();
      for (unsigned int c = 0; c < values.size(); ++c)
        if (c < 3 || (c >= n && c < n + 3) ||
            (c >= 6 && c < n && contact_scalars[c - 6].is_displacement))
          values[c] = 0.5 * values[c] + 0.25 * (a[c] + b[c]);
      return values;
    }



    /// Returns the mean of values at points, without those that are not known.
    ContactValues
    mean(const ContactValues &own, const std::vector<ContactValues> &others)
    {
      // If the own value is not known, neither is the mean: the share of a held
      // vertex has no forces. If that of a neighbour is not known, the own one
      // alone counts.
      ContactValues result;
      for (unsigned int c = 0; c < own.size(); ++c)
        {
          double       sum = own[c];
          unsigned int n   = 1;
          for (const ContactValues &other : others)
            if (!std::isnan(other[c]))
              {
                sum += other[c];
                ++n;
              }
          result.push_back(sum / n);
        }
      return result;
    }



    /// The parts of a face with a node at each corner and none between.
    template <int dim>
    std::vector<std::array<unsigned int, dim>>
    parts_of_face(const unsigned int degree)
    {
      // Numbers below dim are vertices, the next ones the edges in the order of
      // simplex_edges. Of degree 2 a face has twice as many parts in 2D and
      // four times as many in 3D: one at each corner and one between the
      // middles of the edges.
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
    // The grid is that of the own cells of this rank. One rank writes it under
    // the name that is asked for. Of several each writes a file of its own at
    // the same time, and none of them communicates while it does;
    // on_all_ranks() tells all of them if one could not write. The joining file
    // comes last, so that it never refers to a piece that is not complete. It
    // names the pieces without their folder, so that a directory can be moved.
    const ElasticUnknowns<dim> &unknowns = problem.unknowns();
    const DofVector displacement = unknowns.cartesian_displacement(u, factors);
    VtuGrid         grid         = body_grid(unknowns, displacement);
    grid.in_cells = cell_fields(problem, displacement, factors, estimate, more);
    const auto write = [&grid](std::ostream &file) { write_vtu(grid, file); };

    const MPI_Comm     ranks   = unknowns.communicator();
    const unsigned int n_ranks = number_of_ranks(ranks);
    if (n_ranks == 1)
      {
        write_atomically(file_name, write);
        return;
      }
    std::vector<std::string> names;
    for (unsigned int rank = 0; rank < n_ranks; ++rank)
      names.push_back(
        std::filesystem::path(piece_file(file_name, rank)).filename().string());
    on_all_ranks(ranks, [&]() {
      write_own_file(piece_file(file_name, rank_of_this(ranks)), write);
    });
    write_atomically(joined_file(file_name, ranks), [&](std::ostream &file) {
      write_pvtu(grid, names, file);
    });
  }



  std::string
  joined_file(const std::string &file_name, const MPI_Comm ranks)
  {
    return number_of_ranks(ranks) == 1 ? file_name :
                                         std::filesystem::path(file_name)
                                           .replace_extension(".pvtu")
                                           .string();
  }



  std::string
  piece_file(const std::string &file_name, const unsigned int rank)
  {
    return std::filesystem::path(file_name)
      .replace_extension(".rank" + std::to_string(rank) + ".vtu")
      .string();
  }



  template <int dim>
  void
  write_contact_vtu(const ContactBoundary<dim>   &boundary,
                    const Verification<dim>      &verification,
                    const std::string            &file_name,
                    const std::vector<CellField> &more)
  {
    // The shares of nodes are lines in 2D and quadrilaterals in 3D. The names
    // of the fields at points have the order of ContactValues, whose numbers
    // are handed out to the fields one after the other.
    VtuGrid grid = {dim == 2 ? VtuGrid::CellType::line :
                               VtuGrid::CellType::quadrilateral,
                    2 * (dim - 1)};
    grid.at_points = {{"displacement", 3}, {"tangential_force_density", 3}};
    for (const ContactScalar &scalar : contact_scalars)
      grid.at_points.push_back({scalar.name});
    if (!verification.slips.empty())
      {
        grid.at_points.push_back({"slip", 3});
        grid.at_points.push_back({"shear_traction", 3});
        for (const ContactScalar &scalar : shear_scalars)
          grid.at_points.push_back({scalar.name});
      }
    if (verification.has_friction)
      grid.at_points.push_back({"slides"});
    if (!verification.breaks.empty())
      grid.at_points.push_back({"broken_at"});
    if (!verification.breaks.empty() && !verification.slips.empty())
      grid.at_points.push_back({"broken_mode"});
    grid.in_cells = {{"bond_state"}};
    for (const auto &[name, unused] : more)
      grid.in_cells.push_back({name});
    const auto add_point = [&grid](const dealii::Point<dim> &position,
                                   const ContactValues      &values) {
      grid.cells.push_back(grid.add_point(position));
      auto value = values.begin();
      for (VtuGrid::Field &field : grid.at_points)
        for (unsigned int c = 0; c < field.n_components; ++c)
          field.numbers.push_back(static_cast<float>(*value++));
    };

    // Each node has its share of the face, so that its state can be shown
    // without a transition to that of its neighbours: from the node to the
    // middle of the line to the next one, in 3D with the centre of the part.
    // Shares have points of their own, since a value at a point between two
    // nodes may be known in one share and not in the other. A face of degree 2
    // is cut into parts first, whose corners are all of its nodes.
    for (unsigned int f = 0; f < boundary.faces.size(); ++f)
      for (const auto &part : parts_of_face<dim>(boundary.degree))
        {
          const auto                         &face = boundary.faces[f];
          std::array<ContactValues, dim>      values;
          std::array<dealii::Point<dim>, dim> corners;
          for (unsigned int k = 0; k < dim; ++k)
            {
              values[k] = values_at(boundary, verification, face, part[k]);
              corners[k] =
                part[k] < dim ?
                  // The middle of an edge is on the straight line between its
                  // ends.
                  face.vertices[part[k]] :
                  face.vertices[simplex_edges[part[k] - dim][0]] +
                    0.5 * (face.vertices[simplex_edges[part[k] - dim][1]] -
                           face.vertices[simplex_edges[part[k] - dim][0]]);
            }

          for (unsigned int k = 0; k < dim; ++k)
            {
              // The four points of a quadrilateral go around it: the node, the
              // middle towards the next one, the centre, the middle towards the
              // one before. Of a line there are the first two.
              const auto add_middle = [&](const unsigned int other) {
                add_point(corners[k] + 0.5 * (corners[other] - corners[k]),
                          mean(values[k], {values[other]}));
              };
              const unsigned int next = (k + 1) % dim,
                                 last = (k + dim - 1) % dim;
              add_point(corners[k], values[k]);
              add_middle(next);
              if constexpr (dim == 3)
                {
                  add_point(corners[0] + (corners[1] - corners[0]) / 3. +
                              (corners[2] - corners[0]) / 3.,
                            mean(values[k], {values[next], values[last]}));
                  add_middle(last);
                }

              const BondState state =
                face.is_held(part[k]) ?
                  BondState::held :
                  verification.nodes[face.node(part[k])].state;
              grid.in_cells[0].numbers.push_back(static_cast<float>(state));
              for (unsigned int m = 0; m < more.size(); ++m)
                grid.in_cells[m + 1].numbers.push_back(
                  static_cast<float>(more[m].second[f]));
            }
        }
    write_atomically(file_name,
                     [&grid](std::ostream &out) { write_vtu(grid, out); });
  }



  DEBOND_INSTANTIATE(write_body_vtu);
  DEBOND_INSTANTIATE(write_contact_vtu);
} // namespace Debond
