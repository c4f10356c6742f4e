// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/parted_body.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// Gives faces (cells) that are in parts ids of their own, one for each
    /// combination of an id and parts.
    template <typename Id, typename Names>
    class Division
    {
    public:
      explicit Division(const std::set<Id> &ids)
        : next_id(ids.empty() ? 0 : *ids.rbegin() + 1)
      {}

      /// The id of what has had the id @p old and is in these parts.
      Id
      id(const Id old, const std::set<std::string> &in)
      {
        const auto [entry, is_new] = divided.emplace(std::pair(old, in), old);
        if (is_new && !in.empty())
          entry->second = next_id++;
        return entry->second;
      }

      /// The names with the ids that occur now.
      Names
      names(const Names &before) const
      {
        Names result;
        for (const auto &[piece, id] : divided)
          {
            for (const auto &[name, ids] : before)
              if (ids.count(piece.first) > 0)
                result[name].insert(id);
            for (const std::string &name : piece.second)
              result[name].insert(id);
          }
        return result;
      }

    private:
      std::map<std::pair<Id, std::set<std::string>>, Id> divided;
      Id                                                 next_id;
    };



    /// Whether a part contains a vertex of a face or cell, asked from a little
    /// within, since an edge of the part may follow the mesh.
    template <int dim, typename Iterator>
    bool
    contains_vertex(const Part<dim>   &part,
                    const Iterator    &object,
                    const unsigned int v)
    {
      return part.contains(object->vertex(v) +
                           1e-6 * (object->center() - object->vertex(v)));
    }



    /// Whether a part's edge goes through a face or cell: some of its vertices
    /// are in the part and others are not.
    template <int dim, typename Iterator>
    bool
    is_cut(const Part<dim> &part, const Iterator &object)
    {
      const bool inside = part.contains(object->center());
      for (const unsigned int v : object->vertex_indices())
        if (contains_vertex(part, object, v) != inside)
          return true;
      return false;
    }



    /// Coordinates at which a part's edge cuts lines of the mesh, by the axis
    /// along which these run.
    using CutPositions = std::array<std::set<double>, 3>;

    /// Adds those on the edges of a face or cell.
    template <int dim, typename Iterator>
    void
    add_cuts(const Part<dim> &part,
             const Iterator  &object,
             CutPositions    &positions)
    {
      for (const unsigned int v : object->vertex_indices())
        for (const unsigned int w : object->vertex_indices())
          for (unsigned int axis = 0; axis < dim; ++axis)
            {
              dealii::Point<dim> in  = object->vertex(v),
                                 out = object->vertex(w);
              if (std::abs(std::abs(in[axis] - out[axis]) - in.distance(out)) >
                    1e-9 * in.distance(out) ||
                  !contains_vertex(part, object, v) ||
                  contains_vertex(part, object, w) || v == w)
                continue;
              for (unsigned int halving = 0; halving < 50; ++halving)
                {
                  const dealii::Point<dim> middle    = 0.5 * (in + out);
                  (part.contains(middle) ? in : out) = middle;
                }
              positions[axis].insert(out[axis]);
            }
    }



    /// The least numbers of cells of a box, not below its own, with which there
    /// are vertices at the cuts; nothing if it takes more than ten times as
    /// many, or an edge is not along the mesh: that cuts at many places.
    std::optional<std::array<unsigned int, 3>>
    fitting_cells(const CutPositions &positions, const BodyShape &box)
    {
      constexpr double            tolerance  = 1e-6;
      constexpr std::size_t       most_edges = 2;
      bool                        is_other   = false;
      std::array<unsigned int, 3> cells;
      for (unsigned int axis = 0; axis < 3; ++axis)
        {
          const auto own = static_cast<unsigned int>(box.cells[axis]);
          cells[axis]    = own;
          std::set<double> places;
          for (const double position : positions[axis])
            places.insert(std::round(position / box.lengths[axis] / tolerance));
          if (places.size() > most_edges)
            return {};
          const auto is_between = [&](const double position) {
            const double lines = position / box.lengths[axis] * cells[axis];
            return std::abs(lines - std::round(lines)) > tolerance;
          };
          while (std::any_of(positions[axis].begin(),
                             positions[axis].end(),
                             is_between))
            if (++cells[axis] > 10 * own)
              return {};
          is_other = is_other || cells[axis] != own;
        }
      if (!is_other)
        return {};
      return cells;
    }
  } // namespace



  template <int dim>
  PartedBody<dim>::PartedBody(const std::shared_ptr<const Body<dim>> &whole,
                              const std::vector<Part<dim>>           &parts)
    : whole(whole)
    , parts(parts)
  {
    this->inner_groups = whole->inner_groups;
  }



  template <int dim>
  std::set<std::string>
  PartedBody<dim>::boundaries() const
  {
    std::set<std::string> names = whole->boundaries();
    for (const Part<dim> &part : parts)
      if (!part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  std::set<std::string>
  PartedBody<dim>::regions() const
  {
    std::set<std::string> names = whole->regions();
    for (const Part<dim> &part : parts)
      if (part.boundary.empty())
        names.insert(part.name);
    return names;
  }



  template <int dim>
  double
  PartedBody<dim>::n_cells() const
  {
    return whole->n_cells();
  }



  template <int dim>
  double
  PartedBody<dim>::n_vertices() const
  {
    return whole->n_vertices();
  }



  template <int dim>
  double
  PartedBody<dim>::n_vertices_on(const std::string &boundary) const
  {
    for (const Part<dim> &part : parts)
      if (part.name == boundary)
        return whole->n_vertices_on(part.boundary);
    return whole->n_vertices_on(boundary);
  }



  template <int dim>
  BodyShape
  PartedBody<dim>::shape() const
  {
    return whole->shape();
  }



  template <int dim>
  bool
  PartedBody<dim>::has_coarse_levels() const
  {
    return whole->has_coarse_levels();
  }



  template <int dim>
  PieceNames
  PartedBody<dim>::make_mesh(dealii::Triangulation<dim> &mesh) const
  {
    const PieceNames before = whole->make_mesh(mesh);

    std::set<dealii::types::boundary_id> boundary_ids;
    std::set<dealii::types::material_id> material_ids;
    for (const auto &cell : mesh.active_cell_iterators())
      material_ids.insert(cell->material_id());
    for (const dealii::types::boundary_id id : mesh.get_boundary_ids())
      boundary_ids.insert(id);
    Division<dealii::types::boundary_id, BoundaryNames> faces(boundary_ids);
    Division<dealii::types::material_id, RegionNames>   cells(material_ids);

    std::vector<unsigned int> n_inside(parts.size(), 0), n_cut(parts.size(), 0);
    std::vector<CutPositions> positions(parts.size());
    const auto parts_of = [&](const auto &object, const auto &may_be_in) {
      std::set<std::string> in;
      for (std::size_t p = 0; p < parts.size(); ++p)
        if (may_be_in(parts[p]))
          {
            if (is_cut(parts[p], object))
              {
                ++n_cut[p];
                add_cuts(parts[p], object, positions[p]);
              }
            if (parts[p].contains(object->center()))
              {
                in.insert(parts[p].name);
                ++n_inside[p];
              }
          }
      return in;
    };
    for (const auto &cell : mesh.active_cell_iterators())
      {
        cell->set_material_id(
          cells.id(cell->material_id(),
                   parts_of(cell, [](const Part<dim> &part) {
                     return part.boundary.empty();
                   })));
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            face->set_boundary_id(
              faces.id(face->boundary_id(),
                       parts_of(face, [&](const Part<dim> &part) {
                         return !part.boundary.empty() &&
                                before.boundaries.at(part.boundary)
                                    .count(face->boundary_id()) > 0;
                       })));
      }

    PieceNames names = before;
    names.boundaries = faces.names(before.boundaries);
    names.regions    = cells.names(before.regions);
    for (std::size_t p = 0; p < parts.size(); ++p)
      {
        const std::string kind = parts[p].boundary.empty() ? "cell" : "face";
        if (n_inside[p] == 0)
          throw PartError(parts[p].name,
                          "no " + kind + " has its centre in this part");
        if (n_cut[p] == 0)
          continue;
        std::string note = "the edge of the part " + parts[p].name + " cuts " +
                           std::to_string(n_cut[p]) + ' ' + kind +
                           (n_cut[p] == 1 ? "" : "s") +
                           "; where the centre is decides";
        const BodyShape box = shape();
        if (box.is_box)
          if (const auto fitting = fitting_cells(positions[p], box))
            {
              note += "; with ";
              for (unsigned int axis = 0; axis < dim; ++axis)
                note +=
                  (axis == 0 ? "" : ", ") + std::to_string((*fitting)[axis]);
              note += " cells it would cut none";
            }
        names.notes.push_back(note);
      }
    return names;
  }



  template <int dim>
  std::unique_ptr<const Body<dim>>
  PartedBody<dim>::coarser() const
  {
    const std::shared_ptr<const Body<dim>> coarse = whole->coarser();
    if (!coarse)
      return nullptr;
    auto body = std::make_unique<const PartedBody>(coarse, parts);
    try
      {
        dealii::Triangulation<dim> mesh;
        body->make_mesh(mesh);
      }
    catch (const PartError &)
      {
        return nullptr;
      }
    return body;
  }



  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  PartedBody<dim>::interpolate(
    const dealii::Triangulation<dim>          &mesh,
    const std::vector<dealii::Tensor<1, dim>> &values,
    const std::vector<dealii::Point<dim>>     &points) const
  {
    return whole->interpolate(mesh, values, points);
  }



  template <int dim>
  std::vector<CoarseLevel<dim>>
  PartedBody<dim>::coarse_levels(
    const dealii::Triangulation<dim> &mesh,
    const std::vector<unsigned int>  &vertices) const
  {
    return whole->coarse_levels(mesh, vertices);
  }



  template <int dim>
  std::vector<unsigned int>
  PartedBody<dim>::slabs(const dealii::Triangulation<dim> &mesh) const
  {
    return whole->slabs(mesh);
  }



  template class PartedBody<2>;
  template class PartedBody<3>;
} // namespace Debond
