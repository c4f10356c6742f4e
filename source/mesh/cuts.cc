// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/mesh/cuts.h>
#include <debond/mesh/face_groups.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/mesh_data.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    using Cell = typename dealii::Triangulation<dim>::active_cell_iterator;

    template <typename Object>
    std::vector<unsigned int>
    vertices_of(const Object &object)
    {
      std::vector<unsigned int> vertices;
      for (const unsigned int v : object->vertex_indices())
        vertices.push_back(object->vertex_index(v));
      return vertices;
    }

    bool
    has(const std::vector<unsigned int> &vertices, const unsigned int vertex)
    {
      return std::count(vertices.begin(), vertices.end(), vertex) > 0;
    }



    /// They are found by their numbers in the mesh.
    template <int dim>
    using CutFaces = std::map<unsigned int, CutFace<dim>>;



    template <int dim>
    CutFaces<dim>
    find_faces(const std::vector<Cut<dim>>      &cuts,
               const PieceNames                 &names,
               const dealii::Triangulation<dim> &mesh)
    {
      CutFaces<dim>     faces;
      std::vector<char> has_faces(cuts.size(), 0);
      const auto        add = [&](const unsigned int k, CutFace<dim> face) {
        // A face in two cuts would have two interfaces at one place, whose
        // bonds would both act.
        face.cut = k;
        if (!faces.emplace(face.index, face).second)
          throw std::invalid_argument(cuts[k].text +
                                      " overlaps a cut before it");
        has_faces[k] = 1;
      };
      for (unsigned int k = 0; k < cuts.size(); ++k)
        if (!cuts[k].group.empty())
          for (const CutFace<dim> &face : faces_of_group(cuts[k], names, mesh))
            add(k, face);
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          {
            if (cell->face(f)->at_boundary())
              continue;
            // Each inner face is visited from both of its cells, but only the
            // visit from the low one counts. For a cut by a condition that is
            // the cell from which the normal points to the other one, for a cut
            // between regions the cell in the low region.
            const auto other = cell->neighbor(f);
            for (unsigned int k = 0; k < cuts.size(); ++k)
              {
                if (!cuts[k].group.empty())
                  continue;
                // A cell may belong to several regions, therefore its id is
                // looked up in the ids that the region has.
                const auto is_in = [&](const auto        &of,
                                       const std::string &region) {
                  return names.regions.at(region).count(of->material_id()) > 0;
                };
                const bool is_cut =
                  cuts[k].low.empty() ?
                    (other->center() - cell->center()) * cuts[k].normal > 0. &&
                      cuts[k].contains(cell->face(f)) :
                    is_in(cell, cuts[k].low) && is_in(other, cuts[k].high);
                if (!is_cut)
                  continue;
                const auto vertices = vertices_of(cell->face(f));
                add(k,
                    {cell->face_index(f),
                     {{cell, other}},
                     {{vertices, vertices}}});
              }
          }
      for (unsigned int k = 0; k < cuts.size(); ++k)
        if (has_faces[k] == 0)
          throw std::invalid_argument(
            words(cuts[k].text,
                  cuts[k].low.empty() ?
                    " is no line of faces inside the mesh" :
                    ": the regions have no face in common"));
      return faces;
    }



    /// Gives the cells around a vertex that lie on the high side of cuts a
    /// vertex of their own, unless they are joined with the others by faces
    /// that are not cut. Throws std::invalid_argument if they are of more than
    /// two bodies.
    template <int dim>
    void
    open_vertex(const unsigned int            vertex,
                const std::vector<Cell<dim>> &cells,
                const CutFaces<dim>          &faces,
                MeshData<dim>                &data)
    {
      // The cells around the vertex are joined through their faces at it that
      // are not cut. What remains apart are the bodies that meet there. If the
      // cells remain one piece, the cut ends at this vertex, which stays common
      // to both sides: the jump is zero there. Otherwise there must be two
      // pieces, one with all low sides and one with all high sides, and the
      // high one gets a new vertex at the same place. Numbers of pieces are
      // exchanged by a walk over all cells of the vertex, of which there are
      // few.
      std::map<unsigned int, unsigned int> body; // of a cell, by a cell of it
      for (const auto &cell : cells)
        body[cell->active_cell_index()] = cell->active_cell_index();
      std::set<unsigned int> cut;
      for (const auto &cell : cells)
        for (const unsigned int f : cell->face_indices())
          if (!cell->at_boundary(f) && has(vertices_of(cell->face(f)), vertex))
            {
              const unsigned int a = body[cell->active_cell_index()],
                                 b =
                                   body[cell->neighbor(f)->active_cell_index()];
              if (faces.count(cell->face_index(f)) > 0)
                cut.insert(cell->face_index(f));
              else
                for (auto &[unused, of_cell] : body)
                  if (of_cell == a)
                    of_cell = b;
            }
      std::set<unsigned int> bodies, low, high;
      for (const auto &[unused, of_cell] : body)
        bodies.insert(of_cell);
      if (bodies.size() == 1)
        return;
      for (const unsigned int face : cut)
        {
          // If one piece has low and high sides, the cut turns around and no
          // jump has one sign for it.
          const auto &[low_cell, high_cell] = faces.at(face).cells;
          low.insert(body[low_cell->active_cell_index()]);
          high.insert(body[high_cell->active_cell_index()]);
        }
      const dealii::Point<dim> place = data.vertices[vertex];
      if (bodies.size() > 2 || low.size() > 1 || high.size() > 1 || low == high)
        throw std::invalid_argument(
          "more than two bodies meet in the point " + point_text(place) +
          ": let cuts end before others, or join two of the bodies there");
      for (const auto &[cell, of_cell] : body)
        if (of_cell == *high.begin())
          std::replace(data.cells[cell].vertices.begin(),
                       data.cells[cell].vertices.end(),
                       vertex,
                       static_cast<unsigned int>(data.vertices.size()));
      // The place is copied bit by bit, by which Bisection and NodePairs find
      // that both vertices belong together.
      data.vertices.push_back(place);
    }



    /// The id of the low side of a cut, the next one being that of the high
    /// side, by the cut and by the id that its faces have had.
    using SideIds =
      std::map<std::pair<unsigned int, dealii::types::boundary_id>,
               dealii::types::boundary_id>;

    /// Finds them and changes the names.
    template <int dim>
    SideIds
    name_sides(const std::vector<Cut<dim>>      &cuts,
               const CutFaces<dim>              &faces,
               const dealii::Triangulation<dim> &mesh,
               PieceNames                       &names)
    {
      // The ids are above all that are in use, in the order of the cuts. Such a
      // boundary id is unique to the side of one cut, which keeps the names of
      // outer boundaries as they are. Outer faces that become a cut keep other
      // names that they have, and no other face has the ids that they had.
      SideIds ids;
      for (const auto &[unused, face] : faces)
        ids[{face.cut, face.before}] = 0;
      dealii::types::boundary_id next = 0;
      for (const auto id : mesh.get_boundary_ids())
        next = std::max<dealii::types::boundary_id>(next, id + 1);
      std::vector<std::array<std::set<dealii::types::boundary_id>, 2>> sides(
        cuts.size());
      for (auto &[key, id] : ids)
        {
          for (auto &[unused, named] : names.boundaries)
            if (named.erase(key.second) > 0)
              named.insert({next, next + 1u});
          id = next++;
          sides[key.first][0].insert(id);
          sides[key.first][1].insert(next++);
        }
      for (unsigned int k = 0; k < cuts.size(); ++k)
        {
          auto both = sides[k][0];
          both.insert(sides[k][1].begin(), sides[k][1].end());
          names.interfaces.insert(cuts[k].name);
          const BoundaryNames own = {{"", both},
                                     {"_low", sides[k][0]},
                                     {"_high", sides[k][1]}};
          for (const auto &[side, named] : own)
            {
              names.boundaries[cuts[k].name + side] = named;
              if (!cuts[k].group.empty())
                names.boundaries.emplace(cuts[k].group + side, named);
              names.inner_groups.erase(cuts[k].group);
            }
        }
      return ids;
    }



    /// The note on the faces of a cut that do not open, one of them at
    /// @p place. Throws std::invalid_argument if there are no others.
    template <int dim>
    std::string
    note_on_closed(const std::string        &cut,
                   const bool                has_others,
                   const std::size_t         n,
                   const dealii::Point<dim> &place)
    {
      // In 3D unstructured meshes have such faces in the corners of a surface.
      if (!has_others)
        throw std::invalid_argument(
          words(cut,
                " has a single face at ",
                point_text(place),
                " between two points inside, which does not open"));
      return words(n,
                   " of the faces of ",
                   cut,
                   ", such as at ",
                   point_text(place),
                   ", have all of their corners at its end inside the body, "
                   "and do not open");
    }
  } // namespace



  template <int dim>
  PieceNames
  cut_into_bodies(const std::vector<Cut<dim>> &cuts,
                  const PieceNames            &before,
                  dealii::Triangulation<dim>  &mesh)
  {
    // The mesh is taken apart into arrays, changed there and made anew, since
    // deal.II cannot separate cells that share a face. All lookups use the old
    // mesh, whose connections between cells are needed until the end. Only
    // vertices on a cut are looked at, so that the work is proportional to the
    // length of the cut beside one pass over all cells.
    const CutFaces<dim> faces = find_faces(cuts, before, mesh);
    PieceNames          names = before;
    MeshData<dim>       data;
    data.vertices = mesh.get_vertices();
    std::map<unsigned int, std::vector<Cell<dim>>> cells_at; // the cuts
    std::set<unsigned int>                         twins;
    for (const auto &[unused, face] : faces)
      if (face.is_inner())
        for (const unsigned int v : face.vertices[0])
          cells_at[v];
      else
        for (unsigned int v = 0; v < dim; ++v)
          if (const unsigned int low = face.vertices[0][v],
              high                   = face.vertices[1][v];
              low != high)
            {
              // Files have the places of both with some digits.
              data.vertices[high] = data.vertices[low];
              twins.insert({low, high});
            }
    names.n_twins -= std::min(names.n_twins, twins.size());
    for (const auto &cell : mesh.active_cell_iterators())
      {
        data.add_cell(vertices_of(cell), cell->material_id());
        for (const unsigned int v : vertices_of(cell))
          if (const auto at = cells_at.find(v); at != cells_at.end())
            at->second.push_back(cell);
      }
    for (const auto &[v, cells] : cells_at)
      open_vertex(v, cells, faces, data);

    const SideIds ids = name_sides(cuts, faces, mesh, names);
    std::set<dealii::types::boundary_id> is_left; // by all faces that had it
    for (const auto &[side, unused] : ids)
      is_left.insert(side.second);

    // The vertices that a cell has now on a face of the old mesh. After the
    // vertices have been opened they differ between the two cells at a cut
    // face, except at the ends of the cut.
    const auto side = [&data](const auto                      &cell,
                              const std::vector<unsigned int> &face) {
      std::vector<unsigned int> vertices;
      for (const unsigned int v : cell->vertex_indices())
        if (has(face, cell->vertex_index(v)))
          vertices.push_back(data.cells[cell->active_cell_index()].vertices[v]);
      return vertices;
    };
    for (const auto &cell : mesh.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && is_left.count(face->boundary_id()) == 0)
          data.add_face(side(cell, vertices_of(face)), face->boundary_id());
    std::map<unsigned int, std::vector<unsigned int>> open, closed; // by cuts
    for (const auto &[unused, face] : faces)
      {
        const auto low  = side(face.cells[0], face.vertices[0]),
                   high = side(face.cells[1], face.vertices[1]);
        // Both cells have the same vertices on a face if none of them could be
        // opened. Such a face would remain inside the mesh, where deal.II does
        // not accept a boundary id.
        const bool is_closed =
          std::is_permutation(low.begin(), low.end(), high.begin());
        (is_closed ? closed : open)[face.cut].push_back(face.vertices[0][0]);
        if (is_closed)
          continue;
        const auto id = ids.at({face.cut, face.before});
        data.add_face(low, id);
        data.add_face(high, id + 1);
      }
    for (const auto &[k, vertices] : closed)
      names.notes.push_back(note_on_closed(cuts[k].text,
                                           open.count(k) > 0,
                                           vertices.size(),
                                           data.vertices[vertices[0]]));
    mesh.clear();
    data.make_mesh(mesh);
    return names;
  }



  DEBOND_INSTANTIATE(cut_into_bodies);
} // namespace Debond
