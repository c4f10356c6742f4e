// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/cell_search.h>
#include <debond/mesh/cuts.h>
#include <debond/mesh/parts.h>

namespace Debond
{
  std::string
  boundary_name(const BoundaryNames &names, const dealii::types::boundary_id id)
  {
    auto narrowest = names.end();
    for (auto named = names.begin(); named != names.end(); ++named)
      if (named->second.count(id) > 0 &&
          (narrowest == names.end() ||
           named->second.size() < narrowest->second.size()))
        narrowest = named;
    return narrowest != names.end() ? narrowest->first :
                                      "boundary " + std::to_string(id);
  }



  template <int dim>
  std::set<std::string>
  Body<dim>::boundaries() const
  {
    std::set<std::string> names;
    for (const auto &[name, unused] : whole_names().boundaries)
      names.insert(name);
    for (const Cut<dim> &cut : cuts)
      names.insert({cut.name, cut.name + "_low", cut.name + "_high"});
    for (const Part<dim> &part : parts)
      if (!part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  std::set<std::string>
  Body<dim>::regions() const
  {
    std::set<std::string> names;
    for (const auto &[name, unused] : whole_names().regions)
      names.insert(name);
    for (const Part<dim> &part : parts)
      if (part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  PieceNames
  Body<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    make_whole_mesh(mesh);
    PieceNames names = whole_names();
    if (!cuts.empty())
      names = cut_into_bodies(cuts, names, mesh);
    return parts.empty() ? names : name_parts(parts, names, mesh);
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  Body<dim>::coarser() const
  {
    if (!cuts.empty())
      return nullptr;
    std::unique_ptr<Body> body = coarser_whole();
    if (!body || parts.empty())
      return body;
    body->parts = parts;
    try
      {
        dealii::Triangulation<dim> mesh;
        body->make_mesh(mesh);
      }
    catch (const EntryError &)
      {
        return nullptr;
      }
    return body;
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  Body<dim>::coarser_level() const
  {
    return !cuts.empty() || n_vertices() < fewest_vertices_of_level ?
             nullptr :
             coarser_whole();
  }



  template <int dim>
  bool
  Body<dim>::has_coarse_levels() const
  {
    std::unique_ptr<const Body> last;
    for (auto level = coarser_level(); level; level = last->coarser_level())
      last = std::move(level);
    return last && last->n_vertices() <= most_coarsest_vertices;
  }



  template <int dim>
  LinearFields<dim>
  Body<dim>::linear_fields() const
  {
    const auto mesh = std::make_shared<dealii::Triangulation<dim>>();
    make_whole_mesh(*mesh);
    const auto search = std::make_shared<const CellSearch<dim>>(*mesh);
    return {
      mesh->get_vertices(), [mesh, search](const dealii::Point<dim> &point) {
        const auto                          found = (*search)(point);
        typename LinearFields<dim>::Weights weights;
        for (unsigned int v = 0; v <= dim; ++v)
          weights[v] = {found.cell->vertex_index(v), found.coordinates[v]};
        return weights;
      }};
  }



  template <int dim>
  std::vector<CoarseLevel<dim>>
  Body<dim>::coarse_levels(const std::vector<dealii::Point<dim>> &points,
                           const bool with_own) const
  {
    std::vector<CoarseLevel<dim>> levels;
    if (!has_coarse_levels())
      return levels;
    std::unique_ptr<const Body> coarse;
    for (const Body *body = this; body != nullptr;
         coarse = body->coarser_level(), body = coarse.get())
      {
        if (body == this && !with_own)
          continue;
        LinearFields<dim> fields = body->linear_fields();
        CoarseLevel<dim>  level;
        level.to_finer.n_nodes =
          static_cast<unsigned int>(fields.vertices.size());
        for (const dealii::Point<dim> &point :
             levels.empty() ? points : levels.back().vertices)
          {
            double     sum   = 0.;
            const auto found = fields.weights_at(point);
            for (const auto &[unused, weight] : found)
              sum += weight > Tolerance::zero_weight ? weight : 0.;
            for (const auto &[vertex, weight] : found)
              if (weight > Tolerance::zero_weight)
                {
                  level.to_finer.nodes.push_back(vertex);
                  level.to_finer.weights.push_back(
                    static_cast<float>(weight / sum));
                }
            level.to_finer.starts.push_back(level.to_finer.nodes.size());
          }
        level.vertices = std::move(fields.vertices);
        levels.push_back(std::move(level));
      }
    return levels;
  }



  DEBOND_INSTANTIATE_CLASS(Body);
} // namespace Debond
