// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/check/probes.h>
#include <debond/elasticity/cell_nodes.h>

#include <algorithm>
#include <array>
#include <limits>

namespace Debond
{
  template <int dim>
  Probes<dim>::Probes(const ElasticUnknowns<dim>    &unknowns,
                      const PieceNames              &pieces,
                      const std::vector<Probe<dim>> &probes)
  {
    using Kind = typename Probe<dim>::Kind;
    for (const Probe<dim> &probe : probes)
      {
        // In the order of the unknowns, which is the same for any number of
        // ranks.
        std::map<dealii::types::global_dof_index, double> weights;
        const auto add = [&weights](const CellNodes<dim> &nodes,
                                    const unsigned int    node,
                                    const double          weight) {
          const auto &dofs = nodes.dofs[node];
          for (unsigned int d = 1; d < dim; ++d)
            Assert(dofs[d] == dofs[0] + d, dealii::ExcInternalError());
          weights[dofs[0]] += weight;
        };

        if (probe.kind == Kind::point)
          {
            // The cell in which the point lies deepest.
            double least = -std::numeric_limits<double>::max();
            typename dealii::DoFHandler<dim>::active_cell_iterator inside;
            std::array<double, dim + 1> barycentric = {};
            for (const auto &cell :
                 unknowns.dof_handler().active_cell_iterators())
              {
                const LinearSimplex<dim>    simplex(cell);
                std::array<double, dim + 1> coordinates;
                coordinates.fill(0.);
                coordinates[0] = 1.;
                for (unsigned int v = 0; v <= dim; ++v)
                  coordinates[v] +=
                    simplex.gradients[v] * (probe.point - cell->vertex(0));
                const double here =
                  *std::min_element(coordinates.begin(), coordinates.end());
                if (here > least)
                  {
                    least       = here;
                    inside      = cell;
                    barycentric = coordinates;
                  }
              }
            constexpr double rounding = 1e-8;
            if (least < -rounding)
              throw ProbeError(probe.name, "the point is not in the body");
            const CellNodes<dim> nodes(inside);
            const auto basis = bernstein(barycentric, unknowns.degree());
            for (unsigned int n = 0; n < nodes.size; ++n)
              add(nodes, n, basis[n]);
          }
        else if (const auto boundary = pieces.boundaries.find(probe.piece);
                 boundary != pieces.boundaries.end())
          for (const auto &cell :
               unknowns.dof_handler().active_cell_iterators())
            for (const unsigned int f : cell->face_indices())
              {
                if (!cell->face(f)->at_boundary() ||
                    boundary->second.count(cell->face(f)->boundary_id()) == 0)
                  continue;
                // All basis functions of a face have the same integral.
                const CellNodes<dim>          nodes(cell);
                std::array<unsigned int, dim> in_cell;
                for (unsigned int v = 0; v < dim; ++v)
                  {
                    in_cell[v] =
                      cell->reference_cell().face_to_cell_vertices(f, v, 1);
                    add(nodes, in_cell[v], cell->face(f)->measure());
                  }
                for (unsigned int k = dim;
                     k < n_coefficients(dim, unknowns.degree());
                     ++k)
                  add(nodes,
                      dim + 1 +
                        edge_between(in_cell[simplex_edges[k - dim][0]],
                                     in_cell[simplex_edges[k - dim][1]]),
                      cell->face(f)->measure());
              }
        else
          {
            const auto &ids = pieces.regions.at(probe.piece);
            for (const auto &cell :
                 unknowns.dof_handler().active_cell_iterators())
              if (ids.count(cell->material_id()) > 0)
                {
                  const CellNodes<dim> nodes(cell);
                  for (unsigned int n = 0; n < nodes.size; ++n)
                    add(nodes, n, LinearSimplex<dim>(cell).volume);
                }
          }

        Sum sum = {probe.name, probe.kind == Kind::force, {}};
        for (const auto &[dof, weight] : weights)
          sum.weights.emplace_back(dof, sum.of_forces ? 1. : weight);
        sums.push_back(sum);
      }
  }



  template <int dim>
  ProbeValues<dim>
  Probes<dim>::values(const ElasticProblem<dim> &problem,
                      const DofVector           &u,
                      const LoadFactors          factors,
                      const ProblemPiece<dim>   *piece) const
  {
    const auto whole = [piece](const DofVector &v) {
      return piece == nullptr ? v : piece->gather(v);
    };
    const DofVector displacement =
      whole(problem.unknowns().cartesian_displacement(u, factors));
    DofVector forces;
    if (std::any_of(sums.begin(), sums.end(), [](const Sum &sum) {
          return sum.of_forces;
        }))
      forces = whole(problem.unknowns().cartesian_forces(
        problem.fields().residual(u, factors)));

    ProbeValues<dim> result;
    for (const Sum &sum : sums)
      {
        auto weights = sum.weights;
        if (piece != nullptr)
          {
            DofVector of_unknowns(problem.unknowns().n_dofs());
            for (const auto &[dof, weight] : weights)
              of_unknowns(dof) = weight;
            of_unknowns = whole(of_unknowns);
            weights.clear();
            for (unsigned int dof = 0; dof < of_unknowns.size(); dof += dim)
              if (of_unknowns(dof) != 0.)
                weights.emplace_back(dof, of_unknowns(dof));
          }
        double total = sum.of_forces ? 1. : 0.;
        if (!sum.of_forces)
          for (const auto &[unused, weight] : weights)
            total += weight;
        dealii::Tensor<1, dim> value;
        for (const auto &[dof, weight] : weights)
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



  template class Probes<2>;
  template class Probes<3>;
  template decltype(means_of_pieces<2>) means_of_pieces<2>;
  template decltype(means_of_pieces<3>) means_of_pieces<3>;
} // namespace Debond
