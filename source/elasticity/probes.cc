// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/fe_values.h>

#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/probes.h>
#include <debond/mesh/cell_search.h>
#include <debond/mesh/owned_cells.h>

namespace Debond
{
  namespace
  {
    /// Weights by the first degree of freedom of a node, in the order of the
    /// unknowns, which is the same for any number of ranks.
    using Weights = std::map<dealii::types::global_dof_index, double>;



    /// The values of the basis at a point.
    template <int dim>
    Weights
    weights_at(const ElasticUnknowns<dim> &unknowns, const Probe<dim> &probe)
    {
      // A rank finds the point in its own cells only. At a face between ranks
      // several may find it, each with a depth; the reductions choose the
      // largest depth and, among equal ones, the first rank. All ranks then
      // know whether the point is in the body, and throw together or go into
      // the broadcast together.
      const auto &dof_handler = unknowns.dof_handler();
      const auto &fe          = dof_handler.get_fe();
      const auto  found =
        CellSearch<dim>(dof_handler.get_triangulation())(probe.point);
      // The first of the ranks in which it lies deepest has the point.
      const MPI_Comm     ranks = unknowns.communicator();
      const unsigned int rank  = rank_of_this(ranks);
      const double deepest = dealii::Utilities::MPI::max(found.depth, ranks);
      const unsigned int first = dealii::Utilities::MPI::min(
        found.depth == deepest ? rank : number_of_ranks(ranks), ranks);
      if (deepest < -Tolerance::point_in_body)
        throw EntryError("Probes/" + probe.name,
                         "the point is not in the body");

      Weights weights;
      if (rank == first)
        {
          std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
          found.cell_of(dof_handler)->get_dof_indices(dofs);
          // Shape functions of all components of a node are the same, so that
          // the first one stands for them.
          for (unsigned int i = 0; i < dofs.size(); i += dim)
            weights[dofs[i]] += fe.shape_value(i, found.unit_point());
        }
      return number_of_ranks(ranks) == 1 ?
               weights :
               dealii::Utilities::MPI::broadcast(ranks, weights, first);
    }



    /// The weights of all ranks together.
    Weights
    sum(const Weights &own, const MPI_Comm ranks)
    {
      if (number_of_ranks(ranks) == 1)
        return own;
      // The ranks are added up in their order on each rank, so that all have
      // the same sums.
      Weights result;
      for (const Weights &of_rank :
           dealii::Utilities::MPI::all_gather(ranks, own))
        for (const auto &[dof, weight] : of_rank)
          result[dof] += weight;
      return result;
    }



    /// Adds the integrals over a cell or a face, of its nodes.
    template <typename Values>
    void
    add_integrals(const Values                                       &fe_values,
                  const std::vector<dealii::types::global_dof_index> &dofs,
                  const Symmetry                                      symmetry,
                  Weights                                            &weights)
    {
      // The weight of a node is int phi_k over the piece, around an axis with
      // the factor 2 pi r. Divided by their sum the weights make a mean over
      // the piece.
      constexpr unsigned int dim = Values::dimension;
      for (unsigned int i = 0; i < dofs.size(); i += dim)
        {
          // Nodes of the cell that are not on the face have values of rounding
          // there, and no part in the forces on it.
          double largest = 0.;
          for (const unsigned int q : fe_values.quadrature_point_indices())
            largest = std::max(largest, std::abs(fe_values.shape_value(i, q)));
          if (largest > Tolerance::decimals)
            for (const unsigned int q : fe_values.quadrature_point_indices())
              weights[dofs[i]] +=
                fe_values.JxW(q) * fe_values.shape_value(i, q) *
                circumference(symmetry, fe_values.quadrature_point(q));
        }
    }



    /// Over a piece of the boundary or of the body.
    template <int dim>
    Weights
    integrals(const ElasticUnknowns<dim> &unknowns,
              const PieceNames           &pieces,
              const std::string          &piece,
              const Symmetry              symmetry)
    {
      // The rule is exact for the products of a shape function of degree 2 with
      // constants, and for linear ones with the radius.
      const auto &fe    = unknowns.dof_handler().get_fe();
      const auto  flags = dealii::update_values | dealii::update_JxW_values |
                         dealii::update_quadrature_points;
      std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
      Weights                                      weights;
      if (const auto boundary = pieces.boundaries.find(piece);
          boundary != pieces.boundaries.end())
        {
          dealii::FEFaceValues<dim> fe_values(unknowns.mapping(),
                                              fe,
                                              dealii::QGaussSimplex<dim - 1>(2),
                                              flags);
          for (const auto &cell : owned_cells(unknowns.dof_handler()))
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary() &&
                  boundary->second.count(cell->face(f)->boundary_id()) > 0)
                {
                  fe_values.reinit(cell, f);
                  cell->get_dof_indices(dofs);
                  add_integrals(fe_values, dofs, symmetry, weights);
                }
          return sum(weights, unknowns.communicator());
        }
      const auto           &ids = pieces.regions.at(piece);
      dealii::FEValues<dim> fe_values(unknowns.mapping(),
                                      fe,
                                      dealii::QGaussSimplex<dim>(2),
                                      flags);
      for (const auto &cell : owned_cells(unknowns.dof_handler()))
        if (ids.count(cell->material_id()) > 0)
          {
            fe_values.reinit(cell);
            cell->get_dof_indices(dofs);
            add_integrals(fe_values, dofs, symmetry, weights);
          }
      return sum(weights, unknowns.communicator());
    }
  } // namespace



  template <int dim>
  Probes<dim>::Probes(const ElasticUnknowns<dim>    &unknowns,
                      const PieceNames              &pieces,
                      const std::vector<Probe<dim>> &probes)
  {
    for (const Probe<dim> &probe : probes)
      {
        // Weights depend on the mesh alone, so that they are found once and
        // serve all states of a load path.
        const auto over = [&](const Symmetry symmetry) {
          return integrals(unknowns, pieces, probe.piece, symmetry);
        };
        Weights weights = probe.kind == Probe<dim>::Kind::point ?
                            weights_at(unknowns, probe) :
                            over(unknowns.symmetry());
        // The axis has no area, but a mean along it.
        if (std::all_of(weights.begin(), weights.end(), [](const auto &entry) {
              return entry.second == 0.;
            }))
          weights = over(Symmetry::none);
        Sum sum = {probe.name, probe.kind == Probe<dim>::Kind::force, {}};
        // A force is a sum over nodes without weights, unlike a mean.
        for (const auto &[dof, weight] : weights)
          sum.weights.emplace_back(dof, sum.of_forces ? 1. : weight);
        sums.push_back(sum);
      }
  }



  template <int dim>
  ProbeValues<dim>
  Probes<dim>::values(const ElasticProblem<dim> &problem,
                      const DofVector           &u,
                      const LoadFactors          factors) const
  {
    const DofVector displacement =
      problem.unknowns().cartesian_displacement(u, factors);
    DofVector forces;
    if (std::any_of(sums.begin(), sums.end(), [](const Sum &sum) {
          return sum.of_forces;
        }))
      // The residual A u - f at a node is what supports and foundation exert on
      // it, since the internal forces balance all forces there. It takes a loop
      // over all cells, which is left out if no probe asks for forces.
      forces = problem.unknowns().cartesian_forces(
        problem.fields().residual(u, factors));

    ProbeValues<dim> result;
    for (const Sum &sum : sums)
      {
        // The sum of the weights is the measure of the piece, and 1 for a
        // point.
        double total = sum.of_forces ? 1. : 0.;
        if (!sum.of_forces)
          for (const auto &[unused, weight] : sum.weights)
            total += weight;
        dealii::Tensor<1, dim> value;
        for (const auto &[dof, weight] : sum.weights)
          for (unsigned int d = 0; d < dim; ++d)
            value[d] +=
              weight / total *
              (sum.of_forces ? forces(dof + d) : displacement(dof + d));
        result.emplace_back(sum.name, value);
      }
    return result;
  }



  template <int dim>
  std::vector<Probe<dim>>
  means_of_pieces(const PieceNames &pieces)
  {
    std::vector<Probe<dim>> probes;
    const auto              add = [&probes](const std::string &name) {
      probes.push_back({name, Probe<dim>::Kind::mean, {}, name});
    };
    for (const auto &[name, unused] : pieces.boundaries)
      add(name);
    if (pieces.regions.size() > 1)
      for (const auto &[name, unused] : pieces.regions)
        add(name);
    return probes;
  }



  DEBOND_INSTANTIATE_CLASS(Probes);
  DEBOND_INSTANTIATE(means_of_pieces);
} // namespace Debond
