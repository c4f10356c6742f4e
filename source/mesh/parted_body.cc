// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/parted_body.h>

#include <algorithm>
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



    /// Whether a part's edge goes through a face or cell: some of its vertices
    /// are in the part and others are not. They are asked from a little within,
    /// since an edge may follow the mesh.
    template <int dim, typename Iterator>
    bool
    is_cut(const Part<dim> &part, const Iterator &object)
    {
      const dealii::Point<dim> centre = object->center();
      const bool               inside = part.contains(centre);
      for (const unsigned int v : object->vertex_indices())
        if (part.contains(object->vertex(v) +
                          1e-6 * (centre - object->vertex(v))) != inside)
          return true;
      return false;
    }
  } // namespace



  template <int dim>
  PartedBody<dim>::PartedBody(const std::shared_ptr<const Body<dim>> &whole,
                              const std::vector<Part<dim>>           &parts)
    : whole(whole)
    , parts(parts)
  {}



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
    const auto parts_of = [&](const auto &object, const auto &may_be_in) {
      std::set<std::string> in;
      for (std::size_t p = 0; p < parts.size(); ++p)
        if (may_be_in(parts[p]))
          {
            n_cut[p] += is_cut(parts[p], object);
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
        if (n_cut[p] > 0)
          names.notes.push_back("the edge of the part " + parts[p].name +
                                " cuts " + std::to_string(n_cut[p]) + ' ' +
                                kind + (n_cut[p] == 1 ? "" : "s") +
                                "; where the centre is decides");
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



  template class PartedBody<2>;
  template class PartedBody<3>;
} // namespace Debond
