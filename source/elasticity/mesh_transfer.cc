// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/mesh_transfer.h>
#include <debond/mesh/cell_search.h>
#include <debond/mesh/owned_cells.h>

namespace Debond
{
  namespace
  {
    /// The unknowns of Cartesian components, of which each rank has its own
    /// ones, without what would enter the foundation: between nodes a gap is
    /// not what a coarser mesh sees.
    template <int dim>
    DofVector
    admissible(const ElasticUnknowns<dim> &unknowns, DofVector cartesian)
    {
      // Each rank has filled in its own unknowns, so that the sum over ranks is
      // the whole vector. from_cartesian() takes it to the frames of the target
      // and subtracts the target's lifting.
      add_over_ranks(cartesian, unknowns.communicator());
      DofVector result = unknowns.from_cartesian(cartesian);
      if (unknowns.has_gap())
        unknowns.contact().enforce_bounds(result);
      return result;
    }
  } // namespace



  template <int dim>
  DofVector
  divided_displacement(const ElasticProblem<dim>       &source,
                       const DofVector                 &u,
                       const std::vector<unsigned int> &ancestors,
                       const ElasticProblem<dim>       &target)
  {
    // An ancestor may be on another rank than its descendants, as each mesh is
    // partitioned by itself. Therefore the corners and nodal values of all
    // cells of the source are put into one array by the number of the cell in
    // the whole mesh, first the dim + 1 vertices and then the values, and
    // summed up over ranks: each cell is one of one rank. This takes dim (dim +
    // 1) and as many numbers as a cell has unknowns for each cell, on each
    // rank, for the time of the transfer.
    const auto        &source_dofs = source.unknowns().dof_handler();
    const auto        &fe          = source_dofs.get_fe();
    const unsigned int n           = fe.dofs_per_cell;
    const std::size_t  n_of_cell   = dim * (dim + 1) + n;
    const DofVector displacement = source.unknowns().cartesian_displacement(u);
    std::vector<double> of_cells(
      n_of_cell * source_dofs.get_triangulation().n_global_active_cells());
    std::vector<dealii::types::global_dof_index> cell_dofs(n);
    for (const auto &cell : owned_cells(source_dofs))
      {
        auto next =
          of_cells.begin() + n_of_cell * cell->id().get_coarse_cell_id();
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            *next++ = cell->vertex(v)[d];
        cell->get_dof_indices(cell_dofs);
        for (const auto dof : cell_dofs)
          *next++ = displacement(dof);
      }
    dealii::Utilities::MPI::sum(of_cells,
                                source.unknowns().communicator(),
                                of_cells);

    const ElasticUnknowns<dim>           &unknowns  = target.unknowns();
    const std::vector<dealii::Point<dim>> positions = unknowns.node_positions();
    const dealii::IndexSet &own = unknowns.dof_handler().locally_owned_dofs();
    DofVector               result(unknowns.n_dofs());
    // A node has several cells, in each of which it has the same value, as the
    // displacement is continuous. Its value is taken from the first one, so
    // that it is no sum.
    std::vector<bool> is_done(result.size(), false);
    for (const auto &cell : owned_cells(unknowns.dof_handler()))
      {
        const double *values =
          of_cells.data() +
          n_of_cell * ancestors[cell->id().get_coarse_cell_id()];
        std::array<dealii::Point<dim>, dim + 1> vertices;
        for (dealii::Point<dim> &vertex : vertices)
          for (unsigned int d = 0; d < dim; ++d)
            vertex[d] = *values++;
        cell->get_dof_indices(cell_dofs);
        for (unsigned int i = 0; i < n; ++i)
          {
            if (is_done[cell_dofs[i]] || !own.is_element(cell_dofs[i]))
              continue;
            is_done[cell_dofs[i]] = true;
            // The polynomial of the ancestor is evaluated at the node: the
            // coordinates but the first one are those of the reference cell.
            // The basis functions of component i % dim are each dim-th one. The
            // result is exact, as a part of a cell has the same polynomial.
            const auto coordinates =
              barycentric_coordinates<dim>(vertices,
                                           positions[cell_dofs[i] / dim]);
            dealii::Point<dim> point;
            std::copy(coordinates.begin() + 1,
                      coordinates.end(),
                      point.begin_raw());
            for (unsigned int j = i % dim; j < n; j += dim)
              result(cell_dofs[i]) += fe.shape_value(j, point) * values[j];
          }
      }
    return admissible(unknowns, result);
  }



  template <int dim>
  DofVector
  interpolate_displacement(const ElasticProblem<dim> &source,
                           const DofVector           &u,
                           const ElasticProblem<dim> &target)
  {
    const dealii::DoFHandler<dim> &dofs = source.unknowns().dof_handler();
    const DofVector displacement = source.unknowns().cartesian_displacement(u);
    // The source is whole on each rank, so that every rank finds the cells of
    // its own nodes without asking others. With the barycentric coordinates as
    // weights the P1 field is evaluated, and beside the mesh extrapolated from
    // the nearest cell.
    const CellSearch<dim>                 search(dofs.get_triangulation());
    const ElasticUnknowns<dim>           &unknowns  = target.unknowns();
    const std::vector<dealii::Point<dim>> positions = unknowns.node_positions();
    DofVector                             result(unknowns.n_dofs());
    for (const auto i : unknowns.dof_handler().locally_owned_dofs())
      if (i % dim == 0)
        {
          const auto found = search(positions[i / dim]);
          const auto cell  = found.cell_of(dofs);
          for (unsigned int v = 0; v <= dim; ++v)
            for (unsigned int d = 0; d < dim; ++d)
              result(i + d) += found.coordinates[v] *
                               displacement(cell->vertex_dof_index(v, d));
        }
    return admissible(unknowns, result);
  }



  DEBOND_INSTANTIATE(divided_displacement);
  DEBOND_INSTANTIATE(interpolate_displacement);
} // namespace Debond
