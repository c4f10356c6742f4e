// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/parts.h>

#include <algorithm>

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
        // What is in no part keeps its id. Each combination of an old id and
        // parts that occurs gets one new id, so that a name stands for a set of
        // ids and parts may overlap without order.
        const auto [entry, is_new] = divided.emplace(std::pair(old, in), old);
        if (is_new && !in.empty())
          entry->second = next_id++;
        return entry->second;
      }

      /// The names with the ids that occur now.
      Names
      names(const Names &before) const
      {
        // An old name stands now for all ids that its own have been divided
        // into, and the name of a part for all combinations that contain it.
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



    /// Returns whether a part's edge goes through a face or cell: some of its
    /// vertices are in the part and others are not. Vertices are asked from a
    /// little within, since an edge of the part may follow the mesh, as that of
    /// "y < 1e-6" does.
    template <int dim, typename Iterator>
    bool
    is_cut(const Part<dim> &part, const Iterator &object)
    {
      // The centre decides where a face belongs. This only finds out whether
      // the user should know that the part is not a union of faces.
      const bool inside = part.contains(object->center());
      for (const unsigned int v : object->vertex_indices())
        if (part.contains(object->vertex(v) +
                          Tolerance::beside_vertex *
                            (object->center() - object->vertex(v))) != inside)
          return true;
      return false;
    }



    /// The place of a body, for messages.
    template <int dim>
    std::string
    extent_of(const dealii::Triangulation<dim> &mesh)
    {
      const dealii::BoundingBox<dim> box(mesh.get_vertices());
      std::string                    text = "; the body has ";
      for (unsigned int d = 0; d < dim; ++d)
        text += words(d == 0 ? "" : ", ",
                      "xyz"[d],
                      " from ",
                      box.lower_bound(d),
                      " to ",
                      box.upper_bound(d));
      return text;
    }
  } // namespace



  template <int dim>
  PieceNames
  name_parts(const std::vector<Part<dim>> &parts,
             const PieceNames             &before,
             dealii::Triangulation<dim>   &mesh)
  {
    // The mesh has the ids before the division; what is in parts gets ids above
    // them.
    std::set<dealii::types::boundary_id> boundary_ids;
    std::set<dealii::types::material_id> material_ids;
    for (const auto &cell : mesh.active_cell_iterators())
      material_ids.insert(cell->material_id());
    for (const dealii::types::boundary_id id : mesh.get_boundary_ids())
      boundary_ids.insert(id);
    Division<dealii::types::boundary_id, BoundaryNames> faces(boundary_ids);
    Division<dealii::types::material_id, RegionNames>   cells(material_ids);

    std::vector<unsigned int> n_inside(parts.size(), 0), n_cut(parts.size(), 0);
    // A cell is asked about parts of the body, a face about those of its own
    // boundary. Each of them is counted: a part without a face is an error, and
    // one whose edge cuts faces has a note.
    const auto parts_of = [&](const auto &object, const auto &may_be_in) {
      std::set<std::string> in;
      for (std::size_t p = 0; p < parts.size(); ++p)
        if (may_be_in(parts[p]))
          {
            if (is_cut(parts[p], object))
              ++n_cut[p];
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
          // A face on the boundary belongs to one cell, so that it is divided
          // once although all cells are visited.
          if (face->at_boundary())
            face->set_boundary_id(
              faces.id(face->boundary_id(),
                       parts_of(face, [&](const Part<dim> &part) {
                         const auto of = before.boundaries.find(part.boundary);
                         return of != before.boundaries.end() ?
                                  of->second.count(face->boundary_id()) > 0 :
                                  part.boundary == whole_boundary;
                       })));
      }

    PieceNames names = before;
    names.boundaries = faces.names(before.boundaries);
    names.regions    = cells.names(before.regions);
    for (std::size_t p = 0; p < parts.size(); ++p)
      {
        const std::string kind = parts[p].boundary.empty() ? "cell" : "face";
        // A part of all outer faces names no boundary that would tell where it
        // is; the numbers of faces and, if there is none, the extent of the
        // body show whether the condition was meant so.
        const bool is_of_all = parts[p].boundary == whole_boundary &&
                               before.boundaries.count(whole_boundary) == 0;
        if (n_inside[p] == 0)
          throw EntryError("Parts/" + parts[p].name,
                           words("no ",
                                 is_of_all ? "outer " : "",
                                 kind,
                                 " has its centre in this part",
                                 is_of_all ? extent_of(mesh) : ""));
        if (is_of_all)
          names.notes.push_back(words("the part ",
                                      parts[p].name,
                                      " has ",
                                      n_inside[p],
                                      n_inside[p] == 1 ? " face" : " faces"));
        if (n_cut[p] == 0)
          continue;
        names.notes.push_back(words("the edge of the part ",
                                    parts[p].name,
                                    " cuts ",
                                    n_cut[p],
                                    ' ' + kind,
                                    n_cut[p] == 1 ? "" : "s",
                                    "; where the centre is decides"));
      }
    return names;
  }



  DEBOND_INSTANTIATE(name_parts);
} // namespace Debond
