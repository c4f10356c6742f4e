// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/tolerances.h>
#include <debond/mesh/body.h>
#include <debond/mesh/cuts.h>
#include <debond/mesh/parts.h>

#include <algorithm>
#include <limits>
#include <utility>

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
    std::set<std::string> names = whole_boundaries();
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
    std::set<std::string> names = whole_regions();
    for (const Part<dim> &part : parts)
      if (part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  PieceNames
  Body<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    PieceNames names = make_whole_mesh(mesh);
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



  namespace
  {
    /// Finds the cells of a mesh of simplices that points lie in, or next to.
    template <int dim>
    class CellSearch
    {
    public:
      explicit CellSearch(const dealii::Triangulation<dim> &mesh)
        : boxes(boxes_of(mesh))
        , tree(dealii::pack_rtree_of_indices(boxes))
      {
        for (const auto &cell : mesh.active_cell_iterators())
          cells.push_back(cell);
      }

      /// The tree keeps a reference to the boxes.
      CellSearch(const CellSearch &) = delete;

      /// The vertices of a cell that the point is inside of, or least outside,
      /// and its barycentric coordinates there.
      typename LinearFields<dim>::Weights
      operator()(const dealii::Point<dim> &point) const
      {
        namespace index = boost::geometry::index;
        std::vector<std::size_t> nearest;
        double                   farthest = -std::numeric_limits<double>::max();
        typename LinearFields<dim>::Weights result;
        const auto look_at = [&](const std::size_t candidate) {
          const auto              &cell   = cells[candidate];
          const dealii::Point<dim> origin = cell->vertex(0);
          dealii::Tensor<2, dim>   edges; // as columns
          for (unsigned int d = 0; d < dim; ++d)
            for (unsigned int c = 0; c < dim; ++c)
              edges[c][d] = cell->vertex(d + 1)[c] - origin[c];
          const dealii::Tensor<1, dim> xi =
            dealii::invert(edges) * (point - origin);
          double first = 1., least = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            {
              first -= xi[d];
              least = std::min(least, xi[d]);
            }
          least = std::min(least, first);
          if (least <= farthest)
            return;
          farthest  = least;
          result[0] = {cell->vertex_index(0), first};
          for (unsigned int d = 0; d < dim; ++d)
            result[d + 1] = {cell->vertex_index(d + 1), xi[d]};
        };
        // Any cell that the point is inside of will do.
        for (auto found = tree.qbegin(index::intersects(point));
             found != tree.qend() && farthest < -Tolerance::same_cell;
             ++found)
          look_at(*found);
        if (farthest == -std::numeric_limits<double>::max())
          tree.query(index::nearest(point, 1), std::back_inserter(nearest));
        for (const std::size_t candidate : nearest)
          look_at(candidate);
        return result;
      }

    private:
      static std::vector<dealii::BoundingBox<dim>>
      boxes_of(const dealii::Triangulation<dim> &mesh)
      {
        std::vector<dealii::BoundingBox<dim>> boxes;
        for (const auto &cell : mesh.active_cell_iterators())
          boxes.push_back(cell->bounding_box());
        return boxes;
      }

      std::vector<typename dealii::Triangulation<dim>::active_cell_iterator>
                                                  cells;
      const std::vector<dealii::BoundingBox<dim>> boxes;
      const decltype(dealii::pack_rtree_of_indices(
        std::vector<dealii::BoundingBox<dim>>())) tree;
    };
  } // namespace



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  Body<dim>::interpolate(const dealii::Triangulation<dim>          &mesh,
                         const std::vector<dealii::Tensor<1, dim>> &values,
                         const std::vector<dealii::Point<dim>> &points) const
  {
    const CellSearch<dim>               search(mesh);
    std::vector<dealii::Tensor<1, dim>> result(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
      for (const auto &[vertex, weight] : search(points[p]))
        result[p] += weight * values[vertex];
    return result;
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
  LinearFields<dim>
  Body<dim>::linear_fields() const
  {
    const auto mesh = std::make_shared<dealii::Triangulation<dim>>();
    make_whole_mesh(*mesh);
    const auto search = std::make_shared<const CellSearch<dim>>(*mesh);
    return {mesh->get_vertices(),
            [mesh, search](const dealii::Point<dim> &point) {
              return (*search)(point);
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



  template class Body<2>;
  template class Body<3>;
} // namespace Debond
