// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/cuts.h>
#include <debond/mesh/field_value.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// The numbers of its vertices in ascending order.
    template <int dim>
    using CutKey = std::array<unsigned int, dim>;



    template <int dim, typename Face>
    CutKey<dim>
    cut_key(const Face &face)
    {
      CutKey<dim> key;
      for (unsigned int v = 0; v < dim; ++v)
        key[v] = face->vertex_index(v);
      std::sort(key.begin(), key.end());
      return key;
    }



    /// A face between two cells through which a cut goes.
    struct CutFace
    {
      unsigned int                cut;
      std::array<unsigned int, 2> cells; ///< on the low side, on the high one
    };

    template <int dim>
    using CutFaces = std::map<CutKey<dim>, CutFace>;



    template <int dim>
    CutFaces<dim>
    find_faces(const std::vector<Cut<dim>>      &cuts,
               const RegionNames                &regions,
               const dealii::Triangulation<dim> &mesh)
    {
      CutFaces<dim>     faces;
      std::vector<char> has_faces(cuts.size(), 0);
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          {
            if (cell->face(f)->at_boundary())
              continue;
            const auto other = cell->neighbor(f);
            for (unsigned int k = 0; k < cuts.size(); ++k)
              {
                // Of the two sides this one looks from the low cell only.
                const auto is_in = [&](const auto        &of,
                                       const std::string &region) {
                  return regions.at(region).count(of->material_id()) > 0;
                };
                const bool is_cut =
                  cuts[k].low.empty() ?
                    (other->center() - cell->center()) * cuts[k].normal > 0. &&
                      cuts[k].contains(cell->face(f)) :
                    is_in(cell, cuts[k].low) && is_in(other, cuts[k].high);
                if (!is_cut)
                  continue;
                const CutFace face = {
                  k, {{cell->active_cell_index(), other->active_cell_index()}}};
                if (!faces.emplace(cut_key<dim>(cell->face(f)), face).second)
                  throw std::invalid_argument(cuts[k].text +
                                              " overlaps a cut before it");
                has_faces[k] = 1;
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
  } // namespace



  template <int dim>
  PieceNames
  cut_into_bodies(const std::vector<Cut<dim>> &cuts,
                  const PieceNames            &before,
                  dealii::Triangulation<dim>  &mesh)
  {
    const CutFaces<dim>   faces = find_faces(cuts, before.regions, mesh);
    CellsAndVertices<dim> result;
    result.vertices = mesh.get_vertices();
    std::map<unsigned int, std::vector<unsigned int>> cells_at; // the cuts
    for (const auto &[key, unused] : faces)
      for (const unsigned int v : key)
        cells_at[v];
    for (const auto &cell : mesh.active_cell_iterators())
      {
        result.cells.emplace_back(dim + 1);
        result.cells.back().material_id = cell->material_id();
        for (unsigned int v = 0; v <= dim; ++v)
          {
            result.cells.back().vertices[v] = cell->vertex_index(v);
            if (const auto at = cells_at.find(cell->vertex_index(v));
                at != cells_at.end())
              at->second.push_back(cell->active_cell_index());
          }
      }
    const std::vector<dealii::CellData<dim>> whole = result.cells;
    const auto face_keys = [&](const unsigned int cell) {
      std::array<CutKey<dim>, dim + 1> keys;
      for (unsigned int f = 0; f <= dim; ++f)
        {
          for (unsigned int v = 0, k = 0; v <= dim; ++v)
            if (v != f)
              keys[f][k++] = whole[cell].vertices[v];
          std::sort(keys[f].begin(), keys[f].end());
        }
      return keys;
    };

    // Around a vertex cells that are joined by faces that are not cut have it
    // in common.
    for (const auto &[v, cells] : cells_at)
      {
        std::map<unsigned int, unsigned int>             body; // of a cell
        std::map<CutKey<dim>, std::vector<unsigned int>> sharers;
        for (const unsigned int cell : cells)
          {
            body[cell] = cell;
            for (const CutKey<dim> &key : face_keys(cell))
              if (std::count(key.begin(), key.end(), v) > 0 &&
                  faces.count(key) == 0)
                sharers[key].push_back(cell);
          }
        const auto unite = [&body](const unsigned int a, const unsigned int b) {
          for (auto &[unused, of_cell] : body)
            if (of_cell == a)
              of_cell = b;
        };
        for (const auto &[unused, of_face] : sharers)
          if (of_face.size() == 2)
            unite(body[of_face[0]], body[of_face[1]]);
        std::set<unsigned int> bodies, low, high;
        for (const auto &[unused, of_cell] : body)
          bodies.insert(of_cell);
        if (bodies.size() == 1)
          continue;
        for (const unsigned int cell : cells)
          for (const CutKey<dim> &key : face_keys(cell))
            if (const auto face = faces.find(key);
                face != faces.end() &&
                std::count(key.begin(), key.end(), v) > 0)
              {
                low.insert(body[face->second.cells[0]]);
                high.insert(body[face->second.cells[1]]);
              }
        if (bodies.size() > 2 || low.size() > 1 || high.size() > 1 ||
            low == high)
          throw std::invalid_argument(
            "more than two bodies meet in the point " +
            point_text(mesh.get_vertices()[v]) +
            ": let cuts end before others, or join two of the bodies there");
        for (const unsigned int cell : cells)
          if (body[cell] == *high.begin())
            std::replace(result.cells[cell].vertices.begin(),
                         result.cells[cell].vertices.end(),
                         v,
                         static_cast<unsigned int>(result.vertices.size()));
        result.vertices.push_back(mesh.get_vertices()[v]);
      }

    PieceNames                 names = before;
    dealii::types::boundary_id next  = 0;
    for (const auto id : mesh.get_boundary_ids())
      next = std::max<dealii::types::boundary_id>(next, id + 1);
    const auto first_id = next;
    for (const Cut<dim> &cut : cuts)
      {
        names.boundaries[cut.name]           = {next, next + 1u};
        names.boundaries[cut.name + "_low"]  = {next++};
        names.boundaries[cut.name + "_high"] = {next++};
        names.interfaces.insert(cut.name);
      }
    const auto add_face = [&](const unsigned int               cell,
                              const CutKey<dim>               &key,
                              const dealii::types::boundary_id id) {
      auto &all = [&]() -> auto &
      {
        if constexpr (dim == 2)
          return result.faces.boundary_lines;
        else
          return result.faces.boundary_quads;
      }
      ();
      all.emplace_back(dim);
      all.back().boundary_id = id;
      for (unsigned int v = 0, k = 0; v <= dim; ++v)
        if (std::count(key.begin(), key.end(), whole[cell].vertices[v]) > 0)
          all.back().vertices[k++] = result.cells[cell].vertices[v];
      std::vector<unsigned int> vertices = all.back().vertices;
      std::sort(vertices.begin(), vertices.end());
      return vertices;
    };
    for (const auto &cell : mesh.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          add_face(cell->active_cell_index(),
                   cut_key<dim>(face),
                   face->boundary_id());
    for (const auto &[key, face] : faces)
      {
        const auto id = first_id + 2 * face.cut;
        if (add_face(face.cells[0], key, id) ==
            add_face(face.cells[1], key, id + 1))
          throw std::invalid_argument(
            words(cuts[face.cut].text,
                  " has a single face at ",
                  point_text(mesh.get_vertices()[key[0]]),
                  " between two points inside, which does not open"));
      }
    mesh.clear();
    mesh.create_triangulation(result.vertices, result.cells, result.faces);
    return names;
  }



  template decltype(cut_into_bodies<2>) cut_into_bodies<2>;
  template decltype(cut_into_bodies<3>) cut_into_bodies<3>;
} // namespace Debond
