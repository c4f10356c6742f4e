// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <debond/base/instantiate.h>
#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/temperature_load.h>

#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

namespace Debond
{
  namespace
  {
    /// Makes the pattern of A's rows of this rank: cells of other ranks around
    /// the own ones make them complete.
    template <int dim>
    void
    make_pattern(const ElasticUnknowns<dim> &unknowns,
                 dealii::SparsityPattern    &pattern)
    {
      // The dim unknowns of a node couple with the same nodes, so that the
      // pattern is found for nodes, which takes a dim^2-th of the work and of
      // the memory of the dynamic pattern. Constrained rows and columns are
      // left out in the end. All active cells are visited, the ghosts as well:
      // every cell with an own node is among them, therefore the rows of own
      // nodes are complete without communication.
      const auto                    &dofs    = unknowns.dof_handler();
      const unsigned int             n_nodes = unknowns.n_dofs() / dim;
      dealii::DynamicSparsityPattern neighbors(n_nodes, n_nodes);
      std::vector<dealii::types::global_dof_index> cell_dofs(
        dofs.get_fe().dofs_per_cell);
      std::vector<dealii::types::global_dof_index> nodes;
      const auto add = [&neighbors](const auto &of_cell) {
        for (const auto node : of_cell)
          neighbors.add_entries(node, of_cell.begin(), of_cell.end(), true);
      };
      // Cells at first nodes of pairs couple with the second nodes, whose rank
      // may have no cell at the first ones. Such cells are sent to all ranks,
      // each by its owner.
      std::vector<std::vector<dealii::types::global_dof_index>> glued;
      for (const auto &cell : dofs.active_cell_iterators())
        {
          // get_dof_indices() asks for the exact size, and the cell before may
          // have been glued.
          cell_dofs.resize(dofs.get_fe().dofs_per_cell);
          cell->get_dof_indices(cell_dofs);
          const std::size_t n_own = cell_dofs.size();
          unknowns.basis().add_others(cell_dofs);
          nodes.clear();
          for (unsigned int i = 0; i < cell_dofs.size(); i += dim)
            nodes.push_back(cell_dofs[i] / dim);
          std::sort(nodes.begin(), nodes.end());
          add(nodes);
          if (cell_dofs.size() > n_own && cell->is_locally_owned())
            glued.push_back(nodes);
        }
      if (unknowns.has_interfaces())
        {
          // Every rank takes part in this exchange if there is a pair anywhere,
          // as all of them know all pairs. It adds what it has not seen, and
          // adding an entry twice does no harm.
          for (const auto &of_rank :
               dealii::Utilities::MPI::all_gather(unknowns.communicator(),
                                                  glued))
            std::for_each(of_rank.begin(), of_rank.end(), add);
          // Some methods add the second derivative of the bonds' energy to A,
          // and its entries need a place in the pattern. On a foundation the
          // nodes of a contact face are coupled by their cell. Jumps of
          // neighbours belong to different bodies if supports have exchanged
          // the nodes of one of two pairs, and then no cell has both. All nodes
          // of each contact face are coupled, the tangents of held vertices
          // included.
          const ContactBoundary<dim> &boundary = unknowns.contact().boundary();
          for (const auto &face : boundary.faces)
            {
              nodes.clear();
              for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
                if (!face.is_held(k))
                  nodes.push_back(
                    unknowns.contact().normal_dofs()[face.node(k)] / dim);
                else if (!boundary.held_vertices.empty())
                  for (const auto &tangent :
                       boundary.held_vertices[face.held_at(k)].tangents)
                    if (!tangent.is_held)
                      nodes.push_back(unknowns.contact().dofs()[tangent.index] /
                                      dim);
              std::sort(nodes.begin(), nodes.end());
              add(nodes);
            }
        }

      // A SparsityPattern needs the lengths of its rows beforehand. Rows of
      // other ranks and constrained rows have only the diagonal entry that
      // deal.II stores first in each row of a square matrix. This costs one
      // entry for each unknown, and indices are global without any translation.
      const dealii::IndexSet   &own = dofs.locally_owned_dofs();
      std::vector<unsigned int> lengths(own.size(), 1);
      for (const auto row : own)
        if (!unknowns.is_constrained(row))
          lengths[row] = dim * neighbors.row_length(row / dim);
      pattern.reinit(own.size(), own.size(), lengths);
      std::vector<dealii::types::global_dof_index> columns;
      for (const auto row : own)
        {
          // The columns of a node's rows are the same, and are listed once for
          // all of them.
          if (row % dim == 0)
            {
              columns.clear();
              const auto node = row / dim;
              for (unsigned int k = 0; k < neighbors.row_length(node); ++k)
                for (unsigned int d = 0; d < dim; ++d)
                  if (const auto column =
                        dim * neighbors.column_number(node, k) + d;
                      !unknowns.is_constrained(column))
                    columns.push_back(column);
            }
          if (!unknowns.is_constrained(row))
            pattern.add_entries(row, columns.begin(), columns.end(), true);
        }
      pattern.compress();
    }



    /// The matrix of a cell for the Cartesian values at its nodes. @p
    /// stiffness: Material::solid_tensor().
    template <int dim>
    void
    set_products(const SimplexValues<dim>            &values,
                 const Material                      &material,
                 const dealii::SymmetricTensor<4, 3> &stiffness,
                 dealii::FullMatrix<double>          &cell_matrix)
    {
      // The weak form int C eps(v) : eps(u) with shape functions for v and u,
      // for one node and component after the other. An orthotropic material, or
      // the hoop strain u_r / r, needs the tensor of the solid: column j is the
      // stress C eps(phi_j) times the weight, and its rows are the forces of
      // that stress on all nodes. The strain across a plane body is zero here,
      // and plane stress is in the tensor.
      cell_matrix = 0.;
      if (material.orthotropy || values.has_axis())
        {
          for (const unsigned int q : values.quadrature_point_indices())
            for (unsigned int j = 0; j < cell_matrix.n(); ++j)
              {
                const dealii::SymmetricTensor<2, 3> stress =
                  values.JxW(q) *
                  (stiffness * values.strain(j / dim, j % dim, q));
                for (unsigned int k = 0; k < values.n_nodes(); ++k)
                  {
                    const dealii::Tensor<1, dim> force =
                      values.force(stress, k, q);
                    for (unsigned int c = 0; c < dim; ++c)
                      cell_matrix(dim * k + c, j) += force[c];
                  }
              }
          return;
        }
      // With an isotropic tensor the entry for the components c of node k and d
      // of node l is
      // lambda d_c phi_k d_d phi_l + mu d_d phi_k d_c phi_l
      //   + mu delta_cd grad phi_k . grad phi_l,
      // which needs far fewer products than the tensor. In plane stress lambda
      // is that of the plane problem.
      const double lambda = material.template lame_lambda<dim>();
      const double mu     = material.shear_modulus();
      for (const unsigned int q : values.quadrature_point_indices())
        for (unsigned int k = 0; k < values.n_nodes(); ++k)
          for (unsigned int l = 0; l < values.n_nodes(); ++l)
            {
              const dealii::Tensor<1, dim> &g = values.shape_grad(k, q);
              const dealii::Tensor<1, dim>  h =
                values.JxW(q) * values.shape_grad(l, q);
              const double product = mu * (g * h);
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int d = 0; d < dim; ++d)
                  cell_matrix(dim * k + c, dim * l + d) +=
                    lambda * g[c] * h[d] + mu * g[d] * h[c] +
                    (c == d ? product : 0.);
            }
    }



    /// The number of columns before this one in a row, of which the diagonal
    /// entry is the first one.
    unsigned int
    n_columns_below(const dealii::types::global_dof_index column,
                    const dealii::SparsityPattern        &sparsity,
                    const dealii::types::global_dof_index row)
    {
      // deal.II stores the diagonal entry first and the other columns of a row
      // in increasing order, so that the search is among the entries from 1 on.
      // If the diagonal's column is below the one sought it counts as well,
      // though it is stored elsewhere.
      unsigned int below = 0, length = sparsity.row_length(row) - 1;
      while (length > 0)
        {
          const unsigned int half = length / 2;
          const bool         is_below =
            sparsity.column_number(row, 1 + below + half) < column;
          below += is_below ? half + 1 : 0;
          length = is_below ? length - half - 1 : half;
        }
      return below + (row < column ? 1 : 0);
    }
  } // namespace



  template <int dim>
  void
  ElasticProblem<dim>::assemble(const ByRegion<Material> &materials,
                                const Loads<dim>         &loads,
                                const Loads<dim>         &dead_loads)
  {
    // Everything that can fail on one rank alone (a load that is not finite at
    // a point of that rank, for instance) is done within on_all_ranks(), here
    // or in load_vector(), and no rank communicates within it. So all ranks
    // leave this function in the same way, and none waits for another one.
    const dealii::DoFHandler<dim> &dofs = elastic_unknowns.dof_handler();
    const dealii::AffineConstraints<double> &constraints =
      elastic_unknowns.constraints();

    // transformed() calls the function for the material of each region, which
    // is used here for what it throws.
    materials.transformed([](const Material &material) {
      material.validate<dim>();
      return true;
    });
    notes.clear();
    const MPI_Comm      ranks        = elastic_unknowns.communicator();
    const Symmetry      symmetry     = elastic_unknowns.symmetry();
    const bool          heat_is_dead = dead_loads.temperature_change != nullptr;
    std::vector<double> temperatures;
    DofVector           applied_forces, dead_forces;
    on_all_ranks(ranks, [&]() {
      temperatures = temperature_changes(dofs.get_triangulation(),
                                         heat_is_dead ? dead_loads : loads,
                                         dofs.get_fe().degree);
    });
    // Forces are Cartesian nodal forces at all degrees of freedom, also at
    // those that supports prescribe: their reactions are found from them. Dead
    // loads are apart, since they do not grow with the load factor. A change of
    // temperature is a load as well, int C alpha theta : eps(v), and belongs to
    // one of both sets.
    applied_forces = load_vector(dofs, loads, symmetry, &notes);
    if (dead_loads.body_force || !dead_loads.tractions.empty() || heat_is_dead)
      dead_forces = load_vector(dofs, dead_loads, symmetry, &notes);
    on_all_ranks(ranks, [&]() {
      add_thermal_forces(dofs,
                         materials,
                         temperatures,
                         symmetry,
                         heat_is_dead ? dead_forces : applied_forces);
    });
    // Each rank has integrated over its own cells and their faces. The sums are
    // completed here, once for each vector.
    notes = union_of_ranks(notes, ranks);
    add_over_ranks(applied_forces, ranks);
    if (dead_forces.size() > 0)
      {
        add_over_ranks(dead_forces, ranks);
        applied_forces += dead_forces;
      }
    elastic_fields = std::make_unique<ElasticFields<dim>>(elastic_unknowns,
                                                          materials,
                                                          applied_forces,
                                                          temperatures,
                                                          dead_forces,
                                                          heat_is_dead);

    // The load on the unknowns w in u = w + G is f - A G, which is minus the
    // residual A u - f at w = 0. It is taken from the strains of the lifting in
    // the cells, so that A needs no entries for constrained columns. At
    // constrained degrees of freedom the residual has reactions, which are no
    // load.
    const auto load_with = [&](const LoadFactors factors) {
      DofVector load =
        elastic_fields->residual(DofVector(dofs.n_dofs()), factors);
      load *= -1.;
      constraints.set_zero(load);
      return load;
    };
    // load() returns f_0 + t f_1 + d f_2 for the factors t of loads and d of
    // prescribed displacements. The residual is affine in both factors. With
    // the load at factors (0, 0), f_0, that at (0, 1), f_0 + f_2, and the whole
    // one at (1, 1), all others follow without another loop over the cells.
    f_0.reinit(0);
    f_2.reinit(0);
    if (elastic_unknowns.has_gap() || dead_forces.size() > 0)
      f_0 = load_with(0.);
    if (elastic_unknowns.has_prescribed_displacements())
      {
        f_2 = load_with(LoadFactors(0., 1.));
        if (f_0.size() > 0)
          f_2 -= f_0;
      }
    // Without a lifting the load is that of the forces alone, and no strains
    // are computed.
    if (elastic_unknowns.has_lifting())
      whole_load = load_with(1.);
    else
      whole_load = elastic_unknowns.basis().forces_to_unknowns(applied_forces);
    constraints.set_zero(whole_load);

    // The matrix is released before its pattern changes, since it keeps a
    // reference to that. The copy for several ranks is made anew when it is
    // asked for.
    system_matrix.clear();
    distributed.reset();
    make_pattern(elastic_unknowns, sparsity);
    system_matrix.reinit(sparsity);
    add_cell_matrices();
  }



  template <int dim>
  void
  ElasticProblem<dim>::add_cell_matrices()
  {
    // Each rank computes the matrices of all cells that it has, ghosts
    // included, and keeps the rows of its own nodes. The cells along the border
    // of a rank are computed twice, but no entry is sent and the sum of each
    // row is complete at the end of the loop. A matrix of a cell is T' K T,
    // with K for Cartesian nodal values and T the change of basis.
    const auto                &dofs = elastic_unknowns.dof_handler();
    SimplexValues<dim>         values(dofs.get_fe().base_element(0),
                              strain_rule<dim>(elastic_unknowns.degree()),
                              elastic_unknowns.symmetry());
    const unsigned int         n = dofs.get_fe().dofs_per_cell;
    dealii::FullMatrix<double> cell_matrix;
    std::vector<dealii::types::global_dof_index> cell_dofs;
    std::vector<char>                            is_free;
    // Adds the rows of the nodes from `begin` to `end` to those of A, if they
    // are own ones. The usual AffineConstraints::distribute_local_to_global()
    // would sort the unknowns of each cell and look for each entry, which takes
    // about half of the assembly. Here the place of a node's columns is found
    // by one binary search for all dim rows of another node: if its columns are
    // in one of these rows they are in all of them, next to each other, but for
    // the diagonal entry, which is stored first and in constrained rows is the
    // only one. Constrained rows and columns are skipped apart from their
    // diagonal, which sums up the cells' own entries: a positive number of the
    // right size.
    const auto add_rows = [&](const unsigned int begin,
                              const unsigned int end) {
      is_free.resize(cell_dofs.size());
      for (unsigned int i = 0; i < cell_dofs.size(); ++i)
        is_free[i] = !elastic_unknowns.is_constrained(cell_dofs[i]);
      for (unsigned int k = begin; k < end; k += dim)
        {
          if (!dofs.locally_owned_dofs().is_element(cell_dofs[k]))
            continue;
          // Any row of the node that is not constrained shows where the columns
          // are. If all are constrained, only diagonal entries are written, and
          // the place found does not matter.
          unsigned int a_row = k;
          while (!is_free[a_row] && a_row + 1 < k + dim)
            ++a_row;
          for (unsigned int l = 0; l < cell_dofs.size(); l += dim)
            {
              const unsigned int below =
                n_columns_below(cell_dofs[l], sparsity, cell_dofs[a_row]);
              for (unsigned int i = k; i < k + dim; ++i)
                {
                  // deal.II stores the values of a row one after the other, the
                  // diagonal one first. So the address of the diagonal entry is
                  // that of the row.
                  double *const entries =
                    &system_matrix.diag_element(cell_dofs[i]);
                  unsigned int position = below;
                  for (unsigned int j = l; j < l + dim; ++j)
                    {
                      // `position` counts the columns of the row below the
                      // column j, the diagonal one included. If j is above the
                      // diagonal, that entry in the front makes the count the
                      // index itself; if it is below, the index is one more.
                      if (i == j)
                        entries[0] += cell_matrix(i, i);
                      else if (is_free[i] && is_free[j])
                        entries[position +
                                (cell_dofs[j] < cell_dofs[i] ? 1 : 0)] +=
                          cell_matrix(i, j);
                      position += is_free[j];
                    }
                }
            }
        }
    };
    // The jump couples cells at a first node with the second node, whose rank
    // may not have these cells. Their matrices are sent to all ranks, each by
    // the owner of the cell, which then add the rows of the appended nodes. The
    // rows of the cell's own nodes are added without that, so that nothing is
    // added twice.
    using Dofs = std::vector<dealii::types::global_dof_index>;
    std::vector<std::pair<Dofs, std::vector<double>>> glued;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        values.reinit(*cell);
        cell_dofs.resize(n);
        cell->get_dof_indices(cell_dofs);
        cell_matrix.reinit(n, n);
        set_products(values,
                     elastic_fields->material(cell),
                     elastic_fields->solid_tensor(cell),
                     cell_matrix);
        elastic_unknowns.basis().to_unknowns(cell_dofs, cell_matrix);
        if (cell_dofs.size() > n && cell->is_locally_owned())
          glued.emplace_back(cell_dofs,
                             std::vector<double>(&cell_matrix(0, 0),
                                                 &cell_matrix(0, 0) +
                                                   cell_matrix.n_elements()));
        add_rows(0, n);
      }
    if (!elastic_unknowns.has_interfaces())
      return;
    for (const auto &of_rank :
         dealii::Utilities::MPI::all_gather(elastic_unknowns.communicator(),
                                            glued))
      for (const auto &[of_cell, entries] : of_rank)
        {
          cell_dofs           = of_cell;
          const auto n_of_all = static_cast<unsigned int>(cell_dofs.size());
          cell_matrix =
            dealii::FullMatrix<double>(n_of_all, n_of_all, entries.data());
          add_rows(n, n_of_all);
        }
  }



  template <int dim>
  DofVector
  ElasticProblem<dim>::diagonal() const
  {
    // Each degree of freedom belongs to one rank, so that the sum over the
    // ranks is its entry.
    DofVector result(elastic_unknowns.n_dofs());
    for (const auto i : elastic_unknowns.dof_handler().locally_owned_dofs())
      result(i) = system_matrix.diag_element(i);
    add_over_ranks(result, elastic_unknowns.communicator());
    return result;
  }



  template <int dim>
  const ElasticFields<dim> &
  ElasticProblem<dim>::fields() const
  {
    Assert(elastic_fields, dealii::ExcInvalidState());
    return *elastic_fields;
  }



  template <int dim>
  const DistributedMatrix &
  ElasticProblem<dim>::distributed_matrix() const
  {
    // The matrix of Trilinos is a copy of the rows and needs MPI, which a small
    // problem on one rank does without. Therefore it is made by the first one
    // who asks.
    if (!distributed)
      distributed = std::make_unique<const DistributedMatrix>(
        MatrixOnRanks(system_matrix,
                      elastic_unknowns.dof_handler().locally_owned_dofs(),
                      elastic_unknowns.communicator()));
    return *distributed;
  }



  template <int dim>
  DofVector
  ElasticProblem<dim>::load(const LoadFactors factors) const
  {
    // With whole_load = f_0 + f_1 + f_2 this is f_0 + t f_1 + d f_2: the first
    // line has t in front of all three.
    DofVector load = whole_load;
    load *= factors.loads;
    if (f_0.size() > 0)
      load.add(1. - factors.loads, f_0);
    if (f_2.size() > 0)
      load.add(factors.displacements - factors.loads, f_2);
    return load;
  }



  template <int dim>
  double
  ElasticProblem<dim>::lifting_energy(const LoadFactors factors) const
  {
    // J at w = 0 is that of the lifting, 1/2 <A G, G> - <f, G>, from the
    // strains of G.
    return elastic_unknowns.has_lifting() ?
             elastic_fields->elastic_functional(
               DofVector(elastic_unknowns.n_dofs()), factors) :
             0.;
  }



  DEBOND_INSTANTIATE_CLASS(ElasticProblem);
} // namespace Debond
