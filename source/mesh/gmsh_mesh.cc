// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/atomic_file.h>
#include <debond/base/text.h>
#include <debond/mesh/msh_file.h>
#include <debond/mesh/source_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// The faces of a cell in Gmsh's numbering, each with its corners in the
    /// order in which they are passed with the cell on the left (in 3D: that
    /// is counterclockwise from outside).
    const std::vector<std::vector<unsigned int>> &
    faces_of(const MshFile::ElementType type)
    {
      using Faces                      = std::vector<std::vector<unsigned int>>;
      static const Faces triangle      = {{0, 1}, {1, 2}, {2, 0}};
      static const Faces quadrilateral = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
      static const Faces tetrahedron   = {{0, 2, 1},
                                          {0, 1, 3},
                                          {1, 2, 3},
                                          {0, 3, 2}};
      static const Faces hexahedron    = {{0, 3, 2, 1},
                                          {4, 5, 6, 7},
                                          {0, 1, 5, 4},
                                          {1, 2, 6, 5},
                                          {2, 3, 7, 6},
                                          {3, 0, 4, 7}};
      switch (type)
        {
          case MshFile::triangle:
            return triangle;
          case MshFile::quadrilateral:
            return quadrilateral;
          case MshFile::tetrahedron:
            return tetrahedron;
          default:
            return hexahedron;
        }
    }



    int
    dimension_of(const MshFile::ElementType type)
    {
      switch (type)
        {
          case MshFile::point:
            return 0;
          case MshFile::line:
            return 1;
          case MshFile::triangle:
          case MshFile::quadrilateral:
            return 2;
          default:
            return 3;
        }
    }



    /// Makes a triangulation of the elements of a file, and checks that it is
    /// a body.
    template <int dim>
    class GmshMesh
    {
    public:
      GmshMesh(const std::string &file_name, const double scale)
        : file_name(file_name)
      {
        std::ifstream input = open_plain_file(file_name);
        if (!input)
          throw std::invalid_argument(file_name + " cannot be read");
        // Some editors begin a file with the mark of UTF-8.
        std::string begin(7, ' ');
        input.read(begin.data(), 7);
        const std::size_t mark =
          begin.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0;
        if (begin.compare(mark, 4, "$NOD") == 0)
          throw std::invalid_argument(
            file_name + " is of Gmsh's version 1; this makes one that is read: "
                        "gmsh old.msh -0 -o new.msh -format msh41");
        input.clear();
        input.seekg(static_cast<std::streamoff>(mark));
        file = read_msh(input, file_name);
        take_vertices(scale);
        take_cells();
        orient_cells();
        take_faces();
        check_hanging_nodes();
        check_connection();
      }

      std::unique_ptr<SourceMesh<dim>>
      make()
      {
        auto source = std::make_unique<SourceMesh<dim>>();

        GroupIds                           boundary_ids, region_ids;
        std::vector<dealii::CellData<dim>> cell_data;
        for (const Cell &cell : cells)
          {
            cell_data.emplace_back(
              static_cast<unsigned int>(cell.vertices.size()));
            cell_data.back().vertices    = in_lines(cell.vertices);
            cell_data.back().material_id = region_ids.id(cell.groups);
          }
        dealii::SubCellData subcells;
        for (const Face &face : boundary)
          {
            const auto groups = face_groups.find(face.sorted);
            if (groups == face_groups.end())
              continue;
            const auto add = [&](auto &faces) {
              faces.emplace_back(
                static_cast<unsigned int>(face.corners.size()));
              faces.back().vertices    = in_lines(face.corners);
              faces.back().boundary_id = boundary_ids.id(groups->second);
            };
            if constexpr (dim == 2)
              add(subcells.boundary_lines);
            else
              add(subcells.boundary_quads);
          }
        take_names(boundary_ids, dim - 1, source->names.boundaries);
        take_names(region_ids, dim, source->names.regions);
        for (const int group : inner_groups)
          source->inner_groups.insert(name_of(dim - 1, group));
        if (!twins.empty())
          source->names.notes.push_back(
            words("there are ", twins.size(), " nodes", on_one_place));

        if (is_hypercube)
          dealii::GridTools::consistently_order_cells(cell_data);
        source->mesh.create_triangulation(vertices, cell_data, subcells);
        return source;
      }

    private:
      using Vertices = std::vector<unsigned int>;
      using Groups   = std::set<int>;

      struct Cell
      {
        const MshFile::Element *element;
        Vertices                vertices; ///< in Gmsh's order
        Groups                  groups;
      };

      struct Face
      {
        Vertices    sorted;
        Vertices    corners; ///< passed with the cell on the left
        std::size_t cell;
      };

      /// One id for each combination of groups, 0 for none.
      struct GroupIds
      {
        unsigned int
        id(const Groups &groups)
        {
          return groups.empty() ?
                   0 :
                   ids
                     .emplace(groups, static_cast<unsigned int>(ids.size() + 1))
                     .first->second;
        }

        std::map<Groups, unsigned int> ids;
      };

      [[noreturn]] void
      fail(const unsigned int line, const std::string &message) const
      {
        throw std::invalid_argument(file_name + ":" + std::to_string(line) +
                                    ": " + message);
      }

      /// From Gmsh's order, around a quadrilateral or a hexahedron's bottom and
      /// top, to deal.II's, line by line.
      Vertices
      in_lines(Vertices corners) const
      {
        for (std::size_t v = 0; is_hypercube && v + 3 < corners.size(); v += 4)
          std::swap(corners[v + 2], corners[v + 3]);
        return corners;
      }

      /// Takes the vertices that cells use, in the file's order.
      void
      take_vertices(const double scale)
      {
        Vertices index(file.vertices.size(),
                       dealii::numbers::invalid_unsigned_int);
        for (const MshFile::Element &element : file.elements)
          if (dimension_of(element.type) > dim)
            fail(element.line, "a cell in 3D, but the scene has Dimension = 2");
          else if (dimension_of(element.type) == dim)
            for (const unsigned int v : element.vertices)
              index[v] = 0;
        double least_z = std::numeric_limits<double>::max();
        double most_z = -least_z, size = 0.;
        for (std::size_t v = 0; v < index.size(); ++v)
          if (index[v] == 0)
            {
              index[v] = static_cast<unsigned int>(vertices.size());
              dealii::Point<dim> vertex;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  vertex[d] = scale * file.vertices[v][d];
                  size      = std::max(size, std::abs(file.vertices[v][d]));
                }
              vertices.push_back(vertex);
              least_z = std::min(least_z, file.vertices[v][2]);
              most_z  = std::max(most_z, file.vertices[v][2]);
            }
        if (dim == 2 && most_z - least_z > tolerance * size)
          throw std::invalid_argument(
            file_name +
            ": z must be the same at all nodes of a plane mesh, "
            "but it goes from " +
            std::to_string(least_z) + " to " + std::to_string(most_z) +
            "; a body in 3D has cells in 3D, and needs Dimension = 3");
        for (MshFile::Element &element : file.elements)
          for (unsigned int &v : element.vertices)
            v = index[v];
      }

      void
      take_cells()
      {
        std::map<Vertices, std::size_t> known;
        for (MshFile::Element &element : file.elements)
          {
            if (dimension_of(element.type) != dim)
              continue;
            if (element.type == MshFile::prism ||
                element.type == MshFile::pyramid)
              fail(element.line,
                   "prisms and pyramids are not read, but tetrahedra or "
                   "hexahedra");
            if (!cells.empty() && element.type != cells.front().element->type)
              fail(
                element.line,
                "the mesh has cells of two kinds, this one and that of line " +
                  std::to_string(cells.front().element->line));

            Vertices sorted = element.vertices;
            std::sort(sorted.begin(), sorted.end());
            if (std::adjacent_find(sorted.begin(), sorted.end()) !=
                sorted.end())
              fail(element.line, "a cell that has one node twice");
            const auto [first, is_new] = known.emplace(sorted, cells.size());
            if (is_new)
              cells.push_back({&element, element.vertices, element.groups});
            else // Version 2.2 repeats a cell for each of its groups.
              cells[first->second].groups.insert(element.groups.begin(),
                                                 element.groups.end());
          }
        if (cells.empty())
          throw std::invalid_argument(
            file_name + ": the mesh has no " +
            (dim == 2 ?
               "triangles or quadrilaterals" :
               "tetrahedra or hexahedra; is it one for Dimension = 2?") +
            (file.elements.empty() ?
               "" :
               std::string(
                 "; where there are physical groups, Gmsh saves nothing else: add a Physical ") +
                 (dim == 2 ? "Surface" : "Volume")));
        cell_faces   = &faces_of(cells.front().element->type);
        is_hypercube = cells.front().element->type == MshFile::quadrilateral ||
                       cells.front().element->type == MshFile::hexahedron;
      }

      dealii::Point<dim>
      centre(const Vertices &corners) const
      {
        dealii::Point<dim> sum;
        for (const unsigned int v : corners)
          sum += vertices[v];
        return sum / static_cast<double>(corners.size());
      }

      /// The parts of a face, a line in 2D and triangles in 3D.
      std::vector<std::array<dealii::Point<dim>, dim>>
      parts(const Vertices &corners) const
      {
        if constexpr (dim == 2)
          return {{{vertices[corners[0]], vertices[corners[1]]}}};
        else
          {
            if (corners.size() == 3)
              return {{{vertices[corners[0]],
                        vertices[corners[1]],
                        vertices[corners[2]]}}};
            std::vector<std::array<dealii::Point<dim>, dim>> triangles;
            for (std::size_t v = 0; v < corners.size(); ++v)
              triangles.push_back({{vertices[corners[v]],
                                    vertices[corners[(v + 1) % 4]],
                                    centre(corners)}});
            return triangles;
          }
      }

      /// The volumes between the cell's centre and the parts of its faces,
      /// relative to the cell's size: the least one, and their sum.
      std::pair<double, double>
      relative_volumes(const Vertices &cell) const
      {
        const dealii::Point<dim> middle = centre(cell);
        double                   size   = 0.;
        for (const unsigned int v : cell)
          size = std::max(size, middle.distance(vertices[v]));

        double least = std::numeric_limits<double>::max(), sum = 0.;
        for (const auto &face : *cell_faces)
          for (const auto &part : parts(corners_of(cell, face)))
            {
              dealii::Tensor<2, dim> edges;
              for (unsigned int d = 0; d < dim; ++d)
                edges[d] = (part[d] - middle) / size;
              const double volume = dealii::determinant(edges);
              least               = std::min(least, volume);
              sum += volume;
            }
        return {least, sum};
      }

      static Vertices
      corners_of(const Vertices &cell, const Vertices &face)
      {
        Vertices corners;
        for (const unsigned int v : face)
          corners.push_back(cell[v]);
        return corners;
      }

      /// Turns cells that are inside out.
      void
      orient_cells()
      {
        // Aspects up to 1e4 in 3D have more, rounding makes less.
        constexpr double flat = 1e-13;
        for (Cell &cell : cells)
          {
            Vertices &corners = cell.vertices;
            if (relative_volumes(corners).second < 0.)
              {
                if (dim == 3 && is_hypercube)
                  std::swap_ranges(corners.begin(),
                                   corners.begin() + 4,
                                   corners.begin() + 4);
                else // around the other way
                  std::swap(corners[1], corners[is_hypercube ? 3 : 2]);
              }
            const auto [least, sum] = relative_volumes(corners);
            if (!(sum > flat))
              fail(cell.element->line, "a flat cell");
            if (!(least > flat))
              fail(cell.element->line,
                   "a cell so distorted that its centre does not see all of "
                   "its faces");
          }
      }

      /// Finds the faces of the boundary, and the groups of faces.
      void
      take_faces()
      {
        std::vector<Face> faces;
        for (std::size_t c = 0; c < cells.size(); ++c)
          for (const auto &face : *cell_faces)
            {
              const Vertices corners = corners_of(cells[c].vertices, face);
              Vertices       sorted  = corners;
              std::sort(sorted.begin(), sorted.end());
              faces.push_back({sorted, corners, c});
            }
        std::sort(faces.begin(), faces.end(), [](const Face &a, const Face &b) {
          return a.sorted < b.sorted;
        });

        std::map<Vertices, bool> is_outside;
        for (std::size_t f = 0; f < faces.size();)
          {
            const Face &face = faces[f];
            std::size_t n    = 1;
            while (f + n < faces.size() && faces[f + n].sorted == face.sorted)
              ++n;
            if (n > 2 ||
                (n == 2 && same_side(face.corners, faces[f + 1].corners)))
              fail(cells[faces[f + 1].cell].element->line,
                   "a cell that overlaps that of line " +
                     std::to_string(cells[face.cell].element->line));
            is_outside[face.sorted] = n == 1;
            if (n == 1)
              boundary.push_back(face);
            else
              neighbours.push_back({face.cell, faces[f + 1].cell});
            f += n;
          }

        for (const MshFile::Element &element : file.elements)
          if (dimension_of(element.type) == dim - 1 && !element.groups.empty())
            {
              Vertices sorted = element.vertices;
              std::sort(sorted.begin(), sorted.end());
              const auto face = is_outside.find(sorted);
              if (face == is_outside.end())
                fail(element.line,
                     "an element of the boundary that is the face of no cell");
              (face->second ? face_groups[sorted] : inner_groups)
                .insert(element.groups.begin(), element.groups.end());
            }
      }

      /// Whether a face's corners are passed in the same sense by its two
      /// cells, which then lie on one side of it.
      static bool
      same_side(const Vertices &one, const Vertices &other)
      {
        const auto next = [](const Vertices &corners, const unsigned int v) {
          const auto at = std::find(corners.begin(), corners.end(), v) + 1;
          return at == corners.end() ? corners.front() : *at;
        };
        if (dim == 2)
          return one.front() == other.front();
        return next(one, one.front()) == next(other, one.front());
      }

      /// Checks that one comes from every cell to every other through faces.
      void
      check_connection() const
      {
        std::vector<std::size_t> root(cells.size());
        std::iota(root.begin(), root.end(), std::size_t(0));
        const auto find = [&](std::size_t c) {
          while (root[c] != c)
            c = root[c] = root[root[c]];
          return c;
        };
        for (const auto &[a, b] : neighbours)
          root[find(a)] = find(b);
        for (std::size_t c = 0; c < cells.size(); ++c)
          if (find(c) != find(0))
            fail(cells[c].element->line,
                 "a cell that is not connected through faces with that of "
                 "line " +
                   std::to_string(cells[0].element->line) +
                   (twins.empty() ?
                      "" :
                      words(
                        "; there are ", twins.size(), " nodes", on_one_place)));
      }

      /// Whether a point lies on a face's part.
      static bool
      touches(const dealii::Point<dim>                  &point,
              const std::array<dealii::Point<dim>, dim> &part)
      {
        double size = 0.;
        for (const auto &corner : part)
          size = std::max(size, corner.distance(part[0]));
        // Least squares for the barycentric coordinates.
        dealii::FullMatrix<double> gram(dim - 1, dim - 1);
        dealii::Vector<double>     projection(dim - 1), xi(dim - 1);
        for (unsigned int i = 0; i + 1 < dim; ++i)
          {
            projection(i) = (part[i + 1] - part[0]) * (point - part[0]);
            for (unsigned int j = 0; j + 1 < dim; ++j)
              gram(i, j) = (part[i + 1] - part[0]) * (part[j + 1] - part[0]);
          }
        gram.gauss_jordan();
        gram.vmult(xi, projection);
        dealii::Tensor<1, dim> distance = point - part[0];
        double                 rest     = 1.;
        bool                   inside   = true;
        for (unsigned int i = 0; i + 1 < dim; ++i)
          {
            distance -= xi(i) * (part[i + 1] - part[0]);
            rest -= xi(i);
            inside = inside && xi(i) > -tolerance;
          }
        return inside && rest > -tolerance &&
               distance.norm() < tolerance * size;
      }

      /// Two vertices at one place are no hanging node, but a crack.
      void
      check_hanging_nodes()
      {
        std::set<unsigned int> on_boundary;
        for (const Face &face : boundary)
          on_boundary.insert(face.corners.begin(), face.corners.end());
        const Vertices candidates(on_boundary.begin(), on_boundary.end());
        std::vector<dealii::Point<dim>> points;
        for (const unsigned int v : candidates)
          points.push_back(vertices[v]);
        const auto tree = dealii::pack_rtree_of_indices(points);

        for (const Face &face : boundary)
          for (const auto &part : parts(face.corners))
            {
              dealii::BoundingBox<dim> box(
                std::vector<dealii::Point<dim>>(part.begin(), part.end()));
              const auto  &ends = box.get_boundary_points();
              const double near_by =
                tolerance * ends.first.distance(ends.second);
              box.extend(near_by);
              std::vector<std::size_t> near;
              tree.query(boost::geometry::index::intersects(box),
                         std::back_inserter(near));
              for (const std::size_t i : near)
                if (const unsigned int v = candidates[i]; std::binary_search(
                      face.sorted.begin(), face.sorted.end(), v))
                  continue;
                else if (std::any_of(face.corners.begin(),
                                     face.corners.end(),
                                     [&](const unsigned int corner) {
                                       return vertices[v].distance(
                                                vertices[corner]) <= near_by;
                                     }))
                  twins.insert(v);
                else if (touches(vertices[v], part))
                  {
                    std::ostringstream place;
                    place << vertices[v];
                    fail(cells[face.cell].element->line,
                         "a cell with a hanging node on its face, at (" +
                           place.str() + ")");
                  }
            }
      }

      std::string
      name_of(const int dimension, const int group) const
      {
        const auto name = file.names.find({dimension, group});
        return name != file.names.end() ? printable(name->second) :
                                          std::to_string(group);
      }

      /// The names of the groups of a dimension that ids were given for.
      template <typename Names>
      void
      take_names(const GroupIds &ids, const int dimension, Names &names) const
      {
        for (const auto &[groups, id] : ids.ids)
          for (const int group : groups)
            names[name_of(dimension, group)].insert(id);
      }

      /// Nodes at the place of another one: cracks, or forgotten.
      static constexpr const char *on_one_place =
        " at the same place as others, which "
        "are not connected with them; Coherence Mesh in Gmsh joins them";

      /// Relative to a face's size.
      static constexpr double tolerance = 1e-8;

      const std::string                                file_name;
      MshFile                                          file;
      std::vector<dealii::Point<dim>>                  vertices;
      std::vector<Cell>                                cells;
      const std::vector<Vertices>                     *cell_faces   = nullptr;
      bool                                             is_hypercube = false;
      std::vector<Face>                                boundary;
      std::vector<std::pair<std::size_t, std::size_t>> neighbours;
      std::map<Vertices, Groups> face_groups;  ///< by sorted corners
      Groups                     inner_groups; ///< those of faces inside
      std::set<unsigned int>     twins;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<SourceMesh<dim>>
  read_gmsh_mesh(const std::string &file_name, const double scale)
  {
    return GmshMesh<dim>(file_name, scale).make();
  }



  template decltype(read_gmsh_mesh<2>) read_gmsh_mesh<2>;
  template decltype(read_gmsh_mesh<3>) read_gmsh_mesh<3>;
} // namespace Debond
