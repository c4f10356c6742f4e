// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/cell_search.h>
#include <debond/mesh/cuts.h>
#include <debond/mesh/interfaces.h>
#include <debond/mesh/parts.h>

namespace Debond
{
  std::string
  boundary_name(const BoundaryNames &names, const dealii::types::boundary_id id)
  {
    // An id may have several names, as parts and groups overlap. The name with
    // the fewest ids says most about the place of an error.
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
    // The names follow from the description of the body alone, so that a scene
    // is checked before a mesh is made. A cut has a name for each of its sides
    // and one for both, and three more if it is along a group.
    std::set<std::string> names;
    for (const auto &[name, unused] : whole_names().boundaries)
      names.insert(name);
    for (const Cut<dim> &cut : cuts)
      for (const std::string &name : cut.names())
        names.insert({name, name + "_low", name + "_high"});
    for (const Interface &interface : interfaces)
      names.insert(
        {interface.name, interface.name + "_low", interface.name + "_high"});
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
    // The cuts come before the parts, so that a part may be a piece of a cut,
    // and the interfaces after them, so that a part may be a side. All of them
    // change the ids in the mesh and the names that stand for them.
    make_whole_mesh(mesh);
    PieceNames names = whole_names();
    if (!cuts.empty())
      names = cut_into_bodies(cuts, names, mesh);
    for (const auto &[unused, group] : names.inner_groups)
      names.notes.insert(names.notes.end(),
                         group.notes.begin(),
                         group.notes.end());
    if (names.n_twins > 0)
      names.notes.push_back(names.note_on_twins);
    names.inner_groups.clear();
    names.n_twins = 0;
    if (!parts.empty())
      names = name_parts(parts, names, mesh);
    return interfaces.empty() ? names :
                                name_interfaces(interfaces, names, mesh);
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  Body<dim>::coarser() const
  {
    // Whether a part has a face on the coarser mesh is known only after that
    // mesh has been made, and then an EntryError says that it has none. The
    // mesh of the coarser body has about a 2^dim-th of the cells, so that this
    // costs little.
    if (has_interfaces())
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
    return has_interfaces() || n_vertices() < fewest_vertices_of_level ?
             nullptr :
             coarser_whole();
  }



  template <int dim>
  bool
  Body<dim>::has_coarse_levels() const
  {
    // Levels are descriptions without a mesh, so that the whole sequence is
    // followed at no cost. It is of use only if its last level is small enough
    // for a factorisation.
    std::unique_ptr<const Body> last;
    for (auto level = coarser_level(); level; level = last->coarser_level())
      last = std::move(level);
    return last && last->n_vertices() <= most_coarsest_vertices;
  }



  template <int dim>
  LinearFields<dim>
  Body<dim>::linear_fields() const
  {
    // The general case makes the coarse mesh and looks for the cell of each
    // point in a tree of boxes. The function keeps both alive. Boxes find the
    // cell by arithmetic instead.
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
    // For each level the P1 basis functions of the coarser mesh are evaluated
    // at the vertices of the finer one, or at the given points for the finest
    // level. These are the rows of the prolongation. Vertices come in the order
    // of the level's own mesh.
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
            // A point beside the coarse mesh, as on the curved side of a finer
            // one, has negative weights. They are left out, and the others are
            // scaled so that they sum to one: constants are interpolated
            // exactly, and the weights are means. Weights are stored in single
            // precision, which is enough for a preconditioner and halves their
            // memory.
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
