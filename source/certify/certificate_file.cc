// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/certify/certificate_file.h>
#include <debond/output/proof_files.h>

namespace Debond
{
  namespace
  {
    using Json = nlohmann::ordered_json;



    /// Curvature and slope of a piece with the interval where it holds.
    Json
    json_of(const PiecewiseEnergy::Piece &piece)
    {
      return {piece.curvature,
              piece.slope,
              std::min(piece.upper, 0.),
              std::isfinite(piece.lower) ? Json(piece.lower) : Json()};
    }



    /// The Cartesian axis along a direction, if it is along one.
    std::optional<unsigned int>
    axis_of(const dealii::Tensor<1, 2> &direction)
    {
      for (const unsigned int axis : {0, 1})
        if (std::abs(direction[1 - axis]) <= Tolerance::same_normal)
          return axis;
      return {};
    }



    /// The sides of the boundary with supports, contact or tractions; null if
    /// some are not along an axis or are moved.
    Json
    json_of_sides(const EquilibriumProblem<2>        &equilibrium,
                  const std::vector<PiecewiseEnergy> &laws,
                  const std::vector<double>          &trace_constants)
    {
      const EquilibriumMesh<2>            &mesh = equilibrium.mesh;
      std::map<unsigned int, unsigned int> contact;
      for (unsigned int i = 0; i < laws.size(); ++i)
        contact[mesh.contact_sides[i].first_unknown] = i;
      Json sides = Json::array(), of_contact = sides;
      of_contact.get_ref<Json::array_t &>().resize(laws.size());
      for (const auto &cell : mesh.triangulation.active_cell_iterators())
        for (unsigned int corner = 0; corner < 3; ++corner)
          {
            const unsigned int first    = mesh.first_unknown(cell, corner);
            const auto        &rows     = mesh.directions(first);
            auto               vertices = mesh.vertices_of_side(cell, corner);
            std::sort(vertices.begin(), vertices.end());
            if (!mesh.lifting.segment<4>(first).isZero(0.))
              return {};
            Json side = {{"vertices", vertices}};
            for (const unsigned int d : {0, 1})
              if (mesh.is_fixed[first + d])
                {
                  const auto axis = axis_of(rows[d]);
                  if (!axis)
                    return {};
                  side["fixed"].push_back(*axis);
                }
            // The moments of a traction are half of the side's length times
            // what it is at the corners.
            const Eigen::Vector4d moments =
              mesh.loads_on_sides.segment<4>(first);
            if (!moments.isZero(0.))
              for (const unsigned int k : {0, 1})
                {
                  dealii::Tensor<1, 2> force;
                  for (const unsigned int d : {0, 1})
                    force += moments(2 * k + d) * rows[d];
                  const double length =
                    (mesh.triangulation.get_vertices()[vertices[0]] -
                     mesh.triangulation.get_vertices()[vertices[1]])
                      .norm();
                  side["traction"].push_back(
                    {2. / length * force[0], 2. / length * force[1]});
                }
            if (const auto i = contact.find(first); i != contact.end())
              {
                if (!axis_of(rows[0]))
                  return {};
                const PiecewiseEnergy &law = laws[i->second];
                for (unsigned int k = 0; k < law.size(); ++k)
                  side["law"].push_back(json_of(law[k]));
                side["trace_constant"] = trace_constants[i->second];
                of_contact[i->second]  = side;
              }
            else if (side.size() > 1)
              sides.push_back(side);
          }
      return {{"contact", of_contact}, {"others", sides}};
    }



    /// The tree of a record, whose rounds are added to @p rounds.
    void
    add_node(const ProofRecord &nodes,
             const unsigned int number,
             const Json        &end_without_record,
             Json              &rounds,
             Json              &tree)
    {
      const auto node = nodes.find(number);
      if (node == nodes.end())
        {
          tree.push_back(end_without_record);
          return;
        }
      // Of its rounds a node ends with the last ones, which have cut nothing
      // off, and its halves with the one by which it was divided.
      Json end = Json::array({"leaf"});
      for (const ProofRound &round : node->second.rounds)
        {
          const std::size_t last = rounds.size();
          rounds.push_back(
            {{"D", json_numbers(round.D)}, {"x", json_numbers(round.x)}});
          if (round.lower.size() == 0)
            {
              end.push_back(last);
              continue;
            }
          end = {"leaf", last};
          tree.push_back({"cut",
                          last,
                          json_numbers(round.lower),
                          json_numbers(round.upper)});
          if ((round.lower.array() > round.upper.array()).any())
            return;
        }
      if (!node->second.unknown)
        {
          tree.push_back(end);
          return;
        }
      const unsigned int unknown = *node->second.unknown;
      tree.push_back({"split", unknown, node->second.split});
      for (const unsigned int half : node->second.halves)
        add_node(nodes, half, {"grow", end.back(), unknown}, rounds, tree);
    }



    Json
    json_of_stage(const BoundStage &stage)
    {
      const MeanProblem &problem = *stage.problem;
      Json               terms = Json::array(), rounds = Json::array();
      Json               bound = Json::array(), ranges = Json::array();
      for (unsigned int i = 0; i < problem.n_sides(); ++i)
        {
          terms.push_back({{"D", problem.shifts[i]},
                           {"certain", problem.pieces[i].has_value()}});
          for (const PiecewiseEnergy::Piece &piece : problem.laws[i])
            terms.back()["pieces"].push_back(json_of(piece));
        }
      if (!stage.bound.empty())
        add_node(stage.bound, 0, {}, rounds, bound);
      for (const ProofRecord &record : stage.ranges)
        if (!record.empty())
          {
            Json tree = Json::array();
            add_node(record, 0, {}, rounds, tree);
            ranges.push_back(tree);
          }
      return {{"terms", terms},
              {"kept", problem.kept},
              {"rounds", rounds},
              {"bound", bound},
              {"ranges", ranges}};
    }
  } // namespace



  Json
  certificate_proof(const EquilibriumProblem<2>        &equilibrium,
                    const ElasticFields<2>             &fields,
                    const DofVector                    &displacement,
                    const std::vector<PiecewiseEnergy> &laws,
                    const std::vector<double>          &trace_constants,
                    const std::vector<BoundStage>      &stages)
  {
    const EquilibriumMesh<2> &mesh = equilibrium.mesh;
    const Json sides = json_of_sides(equilibrium, laws, trace_constants);
    if (sides.is_null() || !mesh.loads_are_exact)
      return {};
    Json points = Json::array(), cells = points, middles = points;
    for (const auto &point : mesh.triangulation.get_vertices())
      points.push_back({{"place", {point[0], point[1]}}, {"u", {0., 0.}}});
    const auto &dofs = fields.unknowns().dof_handler();
    std::vector<dealii::types::global_dof_index> own(
      dofs.get_fe().dofs_per_cell);
    for (const auto &cell : dofs.active_cell_iterators())
      {
        const Material &material = fields.material(cell);
        const auto     &load = mesh.loads_of_cells[cell->active_cell_index()];
        if (material.orthotropy || load(2) != 0.)
          return {};
        cell->get_dof_indices(own);
        const auto vertex = [&cell](const unsigned int v) {
          return cell->vertex_index(v % 3);
        };
        for (unsigned int i = 0; i < own.size(); ++i)
          {
            // Nodes are the vertices and the middles of the lines from each of
            // them to the next one.
            const auto [component, node] =
              dofs.get_fe().system_to_component_index(i);
            const double value = displacement(own[i]);
            if (node < 3)
              points[vertex(node)]["u"][component] = value;
            else if (component == 0)
              middles.push_back({std::min(vertex(node), vertex(node + 1)),
                                 std::max(vertex(node), vertex(node + 1)),
                                 value});
            else
              middles.back().push_back(value);
          }
        cells.push_back(
          {{"vertices", {vertex(0), vertex(1), vertex(2)}},
           {"lame", {material.lame_lambda<2>(), material.shear_modulus()}},
           {"force", {load(0), load(1)}}});
      }
    Json of_stages = Json::array();
    for (const BoundStage &stage : stages)
      of_stages.push_back(json_of_stage(stage));
    return {{"format", "debond certificate 1"},
            {"points", points},
            {"cells", cells},
            {"sides", sides["others"]},
            {"contact", sides["contact"]},
            {"middles", middles},
            {"stages", of_stages}};
  }
} // namespace Debond
