// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/source_mesh.h>

#include <boost/algorithm/string.hpp>

#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace Debond
{
  namespace
  {
    /**
     * Makes a triangulation of what Gmsh reads, and checks that it is a body.
     * All checks are those of simplices: other cells are looked at as they will
     * be crossed, cut into simplices from their centre and the centres of their
     * quadrilaterals. If there are cells of several kinds, or prisms or
     * pyramids, these simplices are the mesh.
     */
    template <int dim>
    class GmshMesh
    {
    public:
      GmshMesh(const std::string &file_name,
               const double       scale,
               const GmshFile    &file)
        : file_name(file_name)
      {
        // Each step needs what the ones before it have found: cells are joined
        // and cut into simplices before faces are counted, faces before groups
        // are attached to them, and the outer faces before anything is looked
        // for on them.
        read(scale, file);
        check_cells();
        cut_cells();
        take_faces();
        take_groups();
        find_bodies();
        check_hanging_nodes();
        if (!hinge.empty())
          fail(hinge);
      }

      std::unique_ptr<SourceMesh<dim>>
      make()
      {
        auto          source = std::make_unique<SourceMesh<dim>>();
        GroupIds      boundary_ids, region_ids, inner_ids;
        MeshData<dim> data;
        // Quadrilaterals and hexahedra go to deal.II as they are, so that they
        // can be halved before they are crossed. Any other mesh is one of
        // simplices, which are those of the file or the pieces of its cells.
        if (is_hypercube)
          for (const Element &cell : cells)
            data.add_cell(cell.corners, region_ids.id(cell.groups));
        else
          for (const Simplex &simplex : simplices)
            data.add_cell(simplex.corners,
                          region_ids.id(cells[simplex.cell].groups));
        for (const auto &[unused, face] : outer_faces)
          data.add_face(face.corners, boundary_ids.id(face.groups));

        // Faces inside have no boundary id. Their manifold ids survive copies
        // and refinements.
        for (const auto &[unused, face] : inner_faces)
          data.add_inner_face(face.corners, inner_ids.id(face.groups));

        std::map<std::string, std::set<dealii::types::manifold_id>> ids_of;
        take_names(boundary_ids, dim - 1, source->names.boundaries);
        take_names(region_ids, dim, source->names.regions);
        take_names(inner_ids, dim - 1, ids_of);
        for (const auto &[name, ids] : ids_of)
          inner_groups[name].ids = ids;
        source->names.inner_groups = inner_groups;
        source->names.n_twins      = n_twins;
        source->names.note_on_twins =
          words("there are ", n_twins, " nodes", on_one_place);
        if (is_of_higher_order)
          notes.push_back(
            "the file's elements are of higher order, of which the corners are "
            "taken: sides are straight between them");
        source->names.notes = notes;

        // The centres that the checks have appended to the vertices are used by
        // no quadrilateral or hexahedron, and go with other unused ones.
        data.vertices = std::move(vertices);
        dealii::GridTools::delete_unused_vertices(data.vertices,
                                                  data.cells,
                                                  data.faces);
        // deal.II needs positive volumes and, for quadrilaterals and hexahedra,
        // cells that agree on the direction of the edges they share, which
        // files do not promise. Simplices have been turned already and need no
        // such order.
        if (is_hypercube)
          {
            dealii::GridTools::invert_cells_with_negative_measure(data.vertices,
                                                                  data.cells);
            dealii::GridTools::consistently_order_cells(data.cells);
          }
        data.make_mesh(source->mesh);
        for (const auto &[unused, id] : inner_ids.ids)
          source->mesh.set_manifold(id, dealii::FlatManifold<dim>());
        return source;
      }

    private:
      using Corners = typename CellCrossing<dim>::Corners;
      using Groups  = std::set<int>;
      using FaceKey = std::array<unsigned int, dim>; ///< of a simplex, sorted

      struct Element
      {
        std::size_t tag;     ///< Gmsh's
        Corners     corners; ///< in deal.II's order
        Groups      groups;
      };

      struct Simplex
      {
        std::array<unsigned int, dim + 1> corners;
        std::size_t                       cell; ///< that it is a part of
      };

      /// One id for each combination of groups, 0 for none.
      struct GroupIds
      {
        unsigned int
        id(const Groups &groups)
        {
          const auto next = static_cast<unsigned int>(ids.size() + 1);
          return groups.empty() ? 0 : ids.emplace(groups, next).first->second;
        }

        std::map<Groups, unsigned int> ids;
      };

      [[noreturn]] void
      fail(const std::string &message) const
      {
        throw std::invalid_argument(file_name + ": " + message);
      }

      static FaceKey
      key(const Corners &corners)
      {
        FaceKey result;
        std::copy_n(corners.begin(), dim, result.begin());
        std::sort(result.begin(), result.end());
        return result;
      }

      std::string
      element(const std::size_t cell) const
      {
        return "element " + std::to_string(cells[cell].tag);
      }

      void
      read(const double scale, const GmshFile &file)
      {
        // Tags of nodes are any numbers and have gaps, so that vertices are
        // found in a table. The third coordinate is kept even for plane meshes,
        // to check that they are in a plane.
        std::unordered_map<std::size_t, unsigned int> vertex_of; // by tag
        std::set<int> ungrouped; // entities of cells
        for (std::size_t i = 0; i < file.nodes.size(); ++i)
          {
            dealii::Point<dim> vertex;
            for (unsigned int d = 0; d < dim; ++d)
              vertex[d] = scale * file.coordinates[3 * i + d];
            vertex_of[file.nodes[i]] =
              static_cast<unsigned int>(vertices.size());
            vertices.push_back(vertex);
            heights.push_back(scale * file.coordinates[3 * i + 2]);
          }
        for (const GmshFile::Elements &elements : file.elements)
          {
            // Groups without a name have their number as a name. Groups of
            // different dimension may have the same number, so that the
            // dimension is part of the key.
            const bool        is_cell = elements.dimension == dim;
            const std::size_t n       = elements.n_corners;
            Groups            groups;
            for (const auto &[group, name] : elements.groups)
              {
                groups.insert(group);
                names[{elements.dimension, group}] =
                  name.empty() ? std::to_string(group) :
                                 boost::trim_copy(printable(name));
              }
            if (is_cell && groups.empty())
              ungrouped.insert(elements.entity);
            is_of_higher_order =
              is_of_higher_order || (is_cell && elements.order > 1);
            for (std::size_t e = 0; e < elements.tags.size(); ++e)
              {
                Corners corners;
                for (std::size_t v = 0; v < n; ++v)
                  corners.push_back(vertex_of.at(elements.corners[e * n + v]));
                // Gmsh numbers the corners of a quadrilateral along its
                // circumference, deal.II line by line: the third and the fourth
                // one are exchanged, at a hexahedron on both sides and at a
                // pyramid on its base. A tetrahedron and a quadrilateral both
                // have four corners and differ in dimension.
                if (n == 8 || n == 5 || (n == 4 && elements.dimension == 2))
                  for (std::size_t v = 0; v + 3 < n; v += 4)
                    std::swap(corners[v + 2], corners[v + 3]);
                (is_cell ? cells : faces)
                  .push_back({elements.tags[e], corners, groups});
              }
          }
        // If a geometry has physical groups, its cells in none of them are left
        // out, as Gmsh does when it saves a mesh. So a .geo file gives the same
        // body whether it is meshed here or before.
        const std::size_t n          = cells.size();
        const auto        is_grouped = [](const Element &cell) {
          return !cell.groups.empty();
        };
        if (file.is_geometry &&
            std::any_of(cells.begin(), cells.end(), is_grouped))
          cells.erase(std::stable_partition(cells.begin(),
                                            cells.end(),
                                            is_grouped),
                      cells.end());
        if (cells.size() < n)
          notes.push_back(words("cells left out: ",
                                n - cells.size(),
                                dim == 2 ? "; surfaces" : "; volumes",
                                " in no group of the file: ",
                                ungrouped.size()));
        if (file.n_ghosts > 0)
          notes.push_back(
            words("ghost cells of pieces of a partition are left out: ",
                  file.n_ghosts));
        if (scale == 1. && (boost::iends_with(file_name, ".step") ||
                            boost::iends_with(file_name, ".stp")))
          notes.push_back(
            "lengths of STEP files come in mm, whatever they are in there; Mesh/Scale multiplies them");
      }

      /// Checks the cells one by one, and joins those that stand in the file
      /// once for each of their groups.
      void
      check_cells()
      {
        if (cells.empty() && boost::iends_with(file_name, ".stl"))
          fail("an STL file has a surface alone; fill it in a .geo file, by "
               "Merge \"name.stl\"; Surface Loop(1) = Surface{:}; "
               "Volume(1) = {1};");
        if (cells.empty() && faces.empty() &&
            boost::iends_with(file_name, ".mesh"))
          fail("it is not of Medit's format, for which Gmsh takes .mesh");
        if (cells.empty())
          fail(
            std::string("the mesh has no ") +
            (dim == 2 ?
               "triangles or quadrilaterals" :
               "tetrahedra or hexahedra; is it one for Dimension = 2?") +
            (faces.empty() ?
               "" :
               std::string(
                 "; where there are physical groups, Gmsh saves nothing else: add a Physical ") +
                 (dim == 2 ? "Surface" : "Volume")));
        // Cells are compared by their sorted corners. A file of an old version
        // lists a cell once for each of its groups; the copies become one cell
        // in all of these groups.
        std::map<Corners, std::size_t> known;
        std::vector<Element>           different;
        std::set<std::size_t>          kinds;
        double least_z = heights[cells[0].corners[0]], most_z = least_z,
               size = 0.;
        for (const Element &cell : cells)
          {
            Corners corners = cell.corners;
            std::sort(corners.begin(), corners.end());
            if (std::adjacent_find(corners.begin(), corners.end()) !=
                corners.end())
              fail(words("element ", cell.tag, " has one node twice"));
            const auto [first, is_new] =
              known.emplace(corners, different.size());
            if (is_new)
              different.push_back(cell);
            else
              different[first->second].groups.insert(cell.groups.begin(),
                                                     cell.groups.end());
            kinds.insert(corners.size());
            for (const unsigned int v : corners)
              {
                if (!std::isfinite(vertices[v].norm()))
                  fail("a coordinate is no finite number");
                size    = std::max(size, vertices[v].norm());
                least_z = std::min(least_z, heights[v]);
                most_z  = std::max(most_z, heights[v]);
              }
          }
        // A mesh of one kind of cell is used as it is if that kind is a
        // simplex, or a cell that deal.II can halve. A mixture, and prisms and
        // pyramids, are cut into simplices by their centres, whose faces fit as
        // all quadrilaterals are cut alike.
        cells        = std::move(different);
        is_hypercube = kinds == std::set<std::size_t>{1u << dim};
        is_cut       = !is_hypercube && kinds != std::set<std::size_t>{dim + 1};
        if (dim == 2 && !(most_z - least_z <= Tolerance::same_node * size))
          fail(
            "z must be the same at all nodes of a plane mesh, but it goes "
            "from " +
            std::to_string(least_z) + " to " + std::to_string(most_z) +
            "; turn a body in the plane x-z in Gmsh, by Rotate {{1, 0, 0}, {0, 0, 0}, -Pi/2} { Surface{:}; }; one in 3D has cells in 3D, and Dimension = 3");
      }

      /// Cuts all cells into simplices, with their corners in an order that
      /// makes their volumes positive.
      void
      cut_cells()
      {
        for (std::size_t c = 0; c < cells.size(); ++c)
          for (Corners &corners : crossing.simplices(cells[c].corners))
            {
              // The volume is that of the simplex divided by the power of its
              // longest edge from the first corner, so that the test does not
              // depend on units or on the size of cells. A comparison with !
              // also refuses coordinates that are no numbers.
              dealii::Tensor<2, dim> edges;
              double                 size = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  edges[d] = vertices[corners[d + 1]] - vertices[corners[0]];
                  size     = std::max(size, edges[d].norm());
                }
              const double volume = dealii::determinant(edges / size);
              if (!(std::abs(volume) > Tolerance::flat_simplex))
                fail(element(c) + " is flat" +
                     (cells[c].corners.size() == dim + 1 ?
                        "" :
                        ", or its centre does not see all of its faces") +
                     "; bodies with a layer of such cells between them are "
                     "one mesh without it, with Mesh/Cuts");
              if (volume < 0.)
                std::swap(corners[dim - 1], corners[dim]);
              simplices.push_back({{}, c});
              std::copy(corners.begin(),
                        corners.end(),
                        simplices.back().corners.begin());
            }
      }

      /// Finds the faces of simplices on the boundary, and neighbours.
      void
      take_faces()
      {
        // Each face of a simplex is a side. Sorted by face, two sides at one
        // face are neighbours in the list, a single one is on the boundary, and
        // three of them or two on the same side of the face mean that cells
        // overlap. This needs no map and takes a time of the order of n log n.
        struct Side
        {
          FaceKey     face;
          bool        is_left; ///< where the simplex is
          std::size_t cell;

          bool
          operator<(const Side &other) const
          {
            return std::tie(face, cell) < std::tie(other.face, other.cell);
          }
        };
        std::vector<Side> sides;
        for (const Simplex &simplex : simplices)
          for (unsigned int v = 0; v <= dim; ++v)
            {
              Corners corners(simplex.corners.begin(), simplex.corners.end());
              corners.erase(corners.begin() + v);
              // The side of the face on which the simplex lies, relative to the
              // order of its sorted corners: the sign of the permutation that
              // sorts them, times that of removing the vertex v. All simplices
              // have a positive volume, so that the two sides of an inner face
              // differ.
              bool is_left = v % 2 == 1;
              for (unsigned int i = 0; i < dim; ++i)
                for (unsigned int j = i + 1; j < dim; ++j)
                  is_left = is_left != (corners[i] > corners[j]);
              sides.push_back({key(corners), is_left, simplex.cell});
            }
        std::sort(sides.begin(), sides.end());
        const auto is_next = [&](const std::size_t s) {
          return s + 1 < sides.size() && sides[s + 1].face == sides[s].face;
        };
        for (std::size_t s = 0; s < sides.size(); ++s)
          // A cell cut into simplices has sides inside as well, at which both
          // simplices are pieces of the same cell. An overlap there means that
          // its centre does not see one of its faces.
          if (!is_next(s))
            outside.push_back({sides[s].face, sides[s].cell});
          else if (is_next(s + 1) || sides[s].is_left == sides[s + 1].is_left)
            fail(sides[s].cell == sides[s + 1].cell ?
                   element(sides[s].cell) +
                     " is so distorted that its centre does not see all of "
                     "its faces" :
                   element(sides[s + 1].cell) + " overlaps " +
                     element(sides[s].cell));
          else
            {
              neighbours.push_back({sides[s].cell, sides[s + 1].cell});
              inside.push_back(sides[s].face);
              ++s;
            }
      }

      /// Finds the groups of the boundary's faces, and what these have inside
      /// or away from the body, as along a region that is left out.
      void
      take_groups()
      {
        // On the boundary, inside, away from the body.
        std::map<int, std::array<std::size_t, 3>> counts;
        for (Element &face : faces)
          {
            if (face.groups.empty())
              continue;
            // A face is on the boundary (inside) if all pieces that it is cut
            // into are. `outside` is sorted by face, and a lower bound with the
            // cell 0 finds the entry of that face. The centre of a
            // quadrilateral has the same number as when the cells were cut.
            const std::vector<Corners> pieces = crossing.parts(face.corners);
            const bool                 is_outside = std::all_of(
              pieces.begin(), pieces.end(), [&](const Corners &piece) {
                const auto outer =
                  std::lower_bound(outside.begin(),
                                   outside.end(),
                                   std::make_pair(key(piece), std::size_t(0)));
                return outer != outside.end() && outer->first == key(piece);
              });
            const bool is_inside =
              std::all_of(pieces.begin(),
                          pieces.end(),
                          [&](const Corners &piece) {
                            return std::binary_search(inside.begin(),
                                                      inside.end(),
                                                      key(piece));
                          });
            for (const int group : face.groups)
              ++counts[group][is_outside ? 0 : is_inside ? 1 : 2];
            if (is_outside || is_inside)
              for (const Corners &piece :
                   is_cut ? pieces : std::vector<Corners>{face.corners})
                {
                  // A face may be in several groups, or stand in the file once
                  // for each of them. Its id is that of the combination.
                  Corners sorted = piece;
                  std::sort(sorted.begin(), sorted.end());
                  Element &known =
                    (is_outside ? outer_faces : inner_faces)[sorted];
                  known.corners = piece;
                  known.groups.insert(face.groups.begin(), face.groups.end());
                }
          }
        for (const auto &[group, n] : counts)
          for (const unsigned int k : {1u, 2u})
            if (n[k] > 0)
              {
                const std::string &name  = names.at({dim - 1, group});
                InnerGroup        &inner = inner_groups[name];
                // A cut uses what is inside.
                (k == 1 ? inner.notes : notes)
                  .push_back(words(n[k],
                                   " of ",
                                   n[0] + n[1] + n[2],
                                   " faces of the group ",
                                   name,
                                   k == 1 ? " lie inside the body" :
                                            " lie away from the body",
                                   ", and are left out"));
              }
      }

      /// Finds the bodies, and whether what is connected by vertices is so
      /// through faces: bodies with less in common would turn about it.
      void
      find_bodies()
      {
        // The connected sets are kept as trees of cells whose paths are halved
        // at each search, so that the time is nearly proportional to the number
        // of faces.
        std::vector<std::size_t> root(cells.size());
        std::iota(root.begin(), root.end(), std::size_t(0));
        const auto find = [&](std::size_t c) {
          while (root[c] != c)
            c = root[c] = root[root[c]];
          return c;
        };
        for (const auto &[a, b] : neighbours)
          root[find(a)] = find(b);
        // What hangs together is one body for the hanging nodes, which say more
        // about the file.
        std::vector<std::size_t> cell_at(vertices.size(), cells.size());
        for (const Simplex &simplex : simplices)
          for (const unsigned int v : simplex.corners)
            if (cell_at[v] == cells.size())
              cell_at[v] = simplex.cell;
            else if (find(cell_at[v]) != find(simplex.cell))
              {
                std::ostringstream place;
                place << vertices[v];
                hinge = element(simplex.cell) + " hangs together with " +
                        element(cell_at[v]) + " by less than a face, at (" +
                        place.str() + ")";
                root[find(simplex.cell)] = find(cell_at[v]);
              }
        for (const std::size_t c : cell_at)
          body_of.push_back(c < cells.size() ? find(c) : c);
      }

      /// Normal to what these points span, as long as it is large.
      static dealii::Tensor<1, dim>
      normal(const std::vector<dealii::Point<dim>> &points)
      {
        if constexpr (dim == 2)
          return dealii::cross_product_2d(points[1] - points[0]);
        else
          return dealii::cross_product_3d(points[1] - points[0],
                                          points[2] - points[0]);
      }

      /// Checks that no vertex lies on a face of its body's boundary. Two
      /// vertices at one place are no hanging node, but a crack.
      void
      check_hanging_nodes()
      {
        // In a mesh whose cells fit together, vertices inside are never on a
        // face of the boundary, and a hanging node makes the large face and its
        // halves all unmatched: it is enough to look at boundary vertices near
        // boundary faces. A tree of the vertices finds them.
        std::set<unsigned int> on_boundary;
        for (const auto &[face, unused] : outside)
          on_boundary.insert(face.begin(), face.end());
        const Corners candidates(on_boundary.begin(), on_boundary.end());
        std::vector<dealii::Point<dim>> places;
        for (const unsigned int v : candidates)
          places.push_back(vertices[v]);
        const auto tree = dealii::pack_rtree_of_indices(places);

        std::set<unsigned int> twins;
        for (const auto &[face, cell] : outside)
          {
            std::vector<dealii::Point<dim>> corners;
            for (unsigned int v = 0; v < dim; ++v)
              corners.push_back(vertices[face[v]]);
            // Lengths that count as zero are relative to the extent of the
            // face, so that fine cells beside coarse ones are judged by their
            // own size.
            dealii::BoundingBox<dim> box(corners);
            const auto              &ends = box.get_boundary_points();
            const double             near_by =
              Tolerance::same_node * ends.first.distance(ends.second);
            box.extend(near_by);
            std::vector<std::size_t> near;
            tree.query(boost::geometry::index::intersects(box),
                       std::back_inserter(near));
            for (const std::size_t i : near)
              {
                if (std::find(face.begin(), face.end(), candidates[i]) !=
                      face.end() ||
                    body_of[candidates[i]] != body_of[face[0]])
                  continue;
                // The length of the normal is the length or twice the area of
                // the face. A point is on the face if its distance from the
                // plane, n.(x - a) / |n|, is zero and if the pieces that it
                // cuts the face into, each with x in place of one corner, have
                // together the same area; a point beside the face makes the sum
                // larger.
                const auto n     = normal(corners);
                double     least = std::numeric_limits<double>::max(), sum = 0.;
                for (unsigned int v = 0; v < dim; ++v)
                  {
                    auto with_it = corners;
                    with_it[v]   = places[i];
                    least = std::min(least, places[i].distance(corners[v]));
                    sum += normal(with_it).norm();
                  }
                // A vertex at a corner's place is a crack, or was not joined.
                // It is no error by itself and is counted for a note.
                if (least <= near_by)
                  twins.insert(candidates[i]);
                else if (std::abs(n * (places[i] - corners[0])) <=
                           near_by * n.norm() &&
                         sum <= (1. + Tolerance::same_node) * n.norm())
                  {
                    std::ostringstream place;
                    place << places[i];
                    fail(
                      element(cell) + " has a hanging node on its face, at (" +
                      place.str() +
                      "); BooleanFragments in Gmsh makes one mesh of bodies");
                  }
              }
          }
        n_twins = twins.size();
      }

      /// The names of the groups of a dimension that ids were given for.
      template <typename Names>
      void
      take_names(const GroupIds &ids, const int dimension, Names &result) const
      {
        for (const auto &[groups, id] : ids.ids)
          for (const int group : groups)
            result[names.at({dimension, group})].insert(id);
      }

      /// Nodes at the place of another one: cracks, or forgotten.
      static constexpr const char *on_one_place =
        " at the same place as others, which "
        "are not connected with them; Coherence Mesh in Gmsh joins them, "
        "Mesh/Interfaces lets the sides of a crack touch each other";

      const std::string               file_name;
      bool                            is_of_higher_order = false;
      std::vector<dealii::Point<dim>> vertices; ///< and centres
      std::vector<double>             heights;  ///< z
      std::vector<Element>            cells, faces;

      /// The names of groups, by their dimension and number.
      std::map<std::pair<int, int>, std::string> names;

      bool                 is_hypercube = false, is_cut = false;
      CellCrossing<dim>    crossing{vertices};
      std::vector<Simplex> simplices;
      std::vector<std::pair<FaceKey, std::size_t>>     outside; ///< with cells
      std::vector<std::pair<std::size_t, std::size_t>> neighbours; ///< cells
      std::vector<std::size_t>                         body_of; ///< by vertex
      std::string hinge; ///< where bodies have less than a face in common
      std::vector<FaceKey>       inside;
      std::map<Corners, Element> outer_faces, ///< in groups, by sorted
        inner_faces;                          ///< corners
      std::map<std::string, InnerGroup> inner_groups;
      std::vector<std::string>          notes;
      std::size_t                       n_twins = 0;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<SourceMesh<dim>>
  read_gmsh_mesh(const std::string &file_name,
                 const double       scale,
                 MeshingOptions     options)
  {
    // Gmsh works with the lengths of the file, the size is one of the body.
    options.size /= scale;
    return GmshMesh<dim>(file_name,
                         scale,
                         read_gmsh_file(file_name, dim, options))
      .make();
  }



  DEBOND_INSTANTIATE(read_gmsh_mesh);
} // namespace Debond
