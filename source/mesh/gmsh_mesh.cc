// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/numerics/rtree.h>

#include <debond/base/atomic_file.h>
#include <debond/base/text.h>
#include <debond/mesh/source_mesh.h>

#include <dlfcn.h>
#include <gmsh.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace Debond
{
  namespace
  {
    /// What Gmsh does not tell of a file.
    struct FileText
    {
      double version  = 0.; ///< of .msh
      bool   has_mark = false;

      /// Of version 2.0, where some files have the groups' dimensions and some
      /// have not, by dimension (or -1) and group.
      std::map<std::pair<int, int>, std::string> names;
    };

    /// Throws if there are more elements in ASCII than the file says, which
    /// Gmsh would leave out.
    FileText
    look_into(const std::string &file_name)
    {
      std::ifstream input = open_plain_file(file_name);
      if (!input)
        throw std::invalid_argument(file_name + " cannot be read");
      FileText    text;
      std::string line, section;
      std::size_t n_lines = 0, n_blocks = 0, n_elements = 0;
      std::getline(input, line);
      text.has_mark = line.rfind("\xef\xbb\xbf", 0) == 0;
      if (text.has_mark)
        line.erase(0, 3);
      bool is_text = !line.empty() && line[0] == '$';
      for (; is_text; is_text = is_text && std::getline(input, line))
        {
          line.erase(line.find_last_not_of(" \t\r") + 1);
          if (line.empty())
            continue;
          const std::size_t  quote = line.find('"');
          std::istringstream numbers(line.substr(0, quote));
          if (line[0] == '$')
            {
              if ((section == "$Elements" || section == "$ELM") &&
                  n_lines > 1 + n_blocks + n_elements)
                throw std::invalid_argument(
                  words(file_name,
                        ": ",
                        section,
                        " says that it has ",
                        n_elements,
                        ", but ",
                        n_lines - 1 - n_blocks - n_elements,
                        " more lines follow"));
              section = line;
              n_lines = 0;
              if (section == "$NOD" || section == "$NO")
                text.version = 1.;
            }
          else if (n_lines++ == 0 && section == "$MeshFormat")
            {
              int is_binary = 0;
              numbers >> text.version >> is_binary;
              is_text = is_binary == 0;
            }
          else if (n_lines == 1 && text.version >= 4.)
            numbers >> n_blocks >> n_elements;
          else if (n_lines == 1)
            numbers >> n_elements;
          else if (section == "$PhysicalNames" && text.version == 2. &&
                   quote != std::string::npos)
            {
              int dimension = -1, group = 0, second = 0;
              numbers >> group;
              if (numbers >> second)
                dimension = std::exchange(group, second);
              text.names[{dimension, group}] =
                line.substr(quote + 1, line.rfind('"') - quote - 1);
            }
        }
      return text;
    }



    /// Gmsh while a file is read. It reads no settings of the user, and what it
    /// changes of the process, which is the locale, variables of the
    /// environment and OpenMP's threads, is put back.
    class GmshSession
    {
    public:
      GmshSession()
      {
        for (const char *name : {"PATH", "PYTHONPATH"})
          if (const char *value = std::getenv(name))
            environment[name] = value;
        if (void *const get = dlsym(RTLD_DEFAULT, "omp_get_max_threads"))
          n_threads = reinterpret_cast<int (*)()>(get)();
        gmsh::initialize(0, nullptr, false);
        gmsh::option::setNumber("General.Terminal", 0);
        gmsh::logger::start();
      }

      GmshSession(const GmshSession &) = delete;

      ~GmshSession()
      {
        gmsh::logger::stop();
        gmsh::finalize();
        if (void *const set = dlsym(RTLD_DEFAULT, "omp_set_num_threads"))
          reinterpret_cast<void (*)(int)>(set)(n_threads);
        for (const char *name : {"PATH", "PYTHONPATH"})
          unsetenv(name);
        for (const auto &[name, value] : environment)
          setenv(name.c_str(), value.c_str(), 1);
        std::setlocale(LC_ALL, locale.c_str());
        std::error_code ignored;
        std::filesystem::remove(copy, ignored);
      }

      /// Opens a file, or a copy of it if Gmsh does not know how it begins.
      void
      open(const std::string &file_name, const bool has_mark)
      {
        if (has_mark)
          {
            copy = std::filesystem::temp_directory_path() /
                   ("debond-" + std::to_string(getpid()) +
                    std::filesystem::path(file_name).extension().string());
            std::ifstream input(file_name, std::ios::binary);
            input.seekg(3);
            std::ofstream(copy, std::ios::binary) << input.rdbuf();
          }
        const std::string name = has_mark ? copy.string() : file_name;
        // Gmsh crashes on some files that are broken, such as one with an
        // element of nodes that there are not: better in another process.
        const pid_t child = fork();
        if (child == 0)
          {
            for (const int crash : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE})
              std::signal(crash, SIG_DFL);
            try
              {
                gmsh::open(name);
              }
            catch (...)
              {}
            _exit(0);
          }
        int status = 0;
        if (child > 0 && waitpid(child, &status, 0) == child &&
            WIFSIGNALED(status))
          throw std::invalid_argument(file_name +
                                      ": Gmsh crashes on this file");
        gmsh::open(name);
      }

      /// What Gmsh has had to say, "Error" or "Warning".
      static std::string
      messages(const std::string &kind)
      {
        std::vector<std::string> log, found;
        gmsh::logger::get(log);
        for (const std::string &line : log)
          if (line.rfind(kind + ": ", 0) == 0)
            found.push_back(printable(line.substr(kind.size() + 2)));
        return join(found, "; ");
      }

    private:
      const std::string locale = std::setlocale(LC_ALL, nullptr);
      std::map<std::string, std::string> environment;
      int                                n_threads = 1;
      std::filesystem::path              copy;
    };



    /// Of a face, sorted; invalid ones fill up.
    using FaceKey = std::array<unsigned int, 4>;

    FaceKey
    key(std::vector<unsigned int> corners)
    {
      FaceKey result;
      result.fill(dealii::numbers::invalid_unsigned_int);
      std::sort(corners.begin(), corners.end());
      std::copy_n(corners.begin(),
                  std::min<std::size_t>(corners.size(), 4),
                  result.begin());
      return result;
    }



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
               const double       size)
        : file_name(file_name)
      {
        read(scale, size);
        check_cells();
        cut_cells();
        take_faces();
        take_groups();
        check_hanging_nodes();
        check_connection();
      }

      std::unique_ptr<SourceMesh<dim>>
      make()
      {
        auto     source = std::make_unique<SourceMesh<dim>>();
        GroupIds boundary_ids, region_ids;
        std::vector<dealii::CellData<dim>> cell_data;
        dealii::SubCellData                subcells;
        const auto add = [](auto &list, const auto &corners) -> auto &
        {
          list.emplace_back(static_cast<unsigned int>(corners.size()));
          std::copy(corners.begin(),
                    corners.end(),
                    list.back().vertices.begin());
          return list.back();
        };
        if (is_hypercube)
          for (const Element &cell : cells)
            add(cell_data, cell.corners).material_id =
              region_ids.id(cell.groups);
        else
          for (const Simplex &simplex : simplices)
            add(cell_data, simplex.corners).material_id =
              region_ids.id(cells[simplex.cell].groups);
        for (const auto &[unused, face] : outer_faces)
          if constexpr (dim == 2)
            add(subcells.boundary_lines, face.corners).boundary_id =
              boundary_ids.id(face.groups);
          else
            add(subcells.boundary_quads, face.corners).boundary_id =
              boundary_ids.id(face.groups);

        take_names(boundary_ids, dim - 1, source->names.boundaries);
        take_names(region_ids, dim, source->names.regions);
        for (const int group : inner_groups)
          source->inner_groups.insert(names.at({dim - 1, group}));
        if (n_twins > 0)
          source->names.notes.push_back(
            words("there are ", n_twins, " nodes", on_one_place));
        if (is_of_higher_order)
          source->names.notes.push_back(
            "the file's elements are of higher order, of which the corners are "
            "taken: sides are straight between them");

        dealii::GridTools::delete_unused_vertices(vertices,
                                                  cell_data,
                                                  subcells);
        if (is_hypercube)
          {
            dealii::GridTools::invert_cells_with_negative_measure(vertices,
                                                                  cell_data);
            dealii::GridTools::consistently_order_cells(cell_data);
          }
        source->mesh.create_triangulation(vertices, cell_data, subcells);
        return source;
      }

    private:
      using Corners = std::vector<unsigned int>;
      using Groups  = std::set<int>;

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

      std::string
      element(const std::size_t cell) const
      {
        return "element " + std::to_string(cells[cell].tag);
      }

      /// Has Gmsh read the file, or mesh its geometry.
      void
      read(const double scale, const double size)
      {
        text = look_into(file_name);
        GmshSession gmsh;
        // Gmsh knows groups of entities. In old files elements of one entity
        // may be in several groups: Gmsh is to take the groups for entities.
        is_old = text.version > 0. && text.version < 4.;
        gmsh::option::setNumber("Mesh.SwitchElementTags", is_old ? 1 : 0);
        bool is_geometry = false;
        try
          {
            gmsh.open(file_name, text.has_mark);
            // It loses groups then, and goes on.
            const std::string warnings = GmshSession::messages("Warning");
            if (warnings.find("not found in the Brep") != std::string::npos)
              fail(
                "Gmsh does not understand the file's entities, each of which "
                "has to be a line: " +
                warnings);
            if (gmsh::model::getDimension() > dim)
              fail("a body in 3D, but the scene has Dimension = 2");
            std::vector<std::size_t> tags;
            std::vector<double>      coordinates, unused;
            gmsh::model::mesh::getNodes(tags, coordinates, unused);
            is_geometry = tags.empty();
            if (!is_geometry && size > 0.)
              fail("the file has a mesh, where Size is for geometries");
            if (is_geometry && size > 0.)
              for (const char *option :
                   {"Mesh.MeshSizeMin", "Mesh.MeshSizeMax"})
                gmsh::option::setNumber(option, size / scale);
            if (is_geometry)
              gmsh::model::mesh::generate(dim);
            else
              gmsh::model::mesh::unpartition();
            take_nodes(scale);
            cells = elements(dim);
            faces = elements(dim - 1);
          }
        catch (const std::invalid_argument &)
          {
            throw;
          }
        catch (...)
          {
            const std::string errors = GmshSession::messages("Error");
            fail("Gmsh does not read this" +
                 (errors.empty() ? errors : ": " + errors));
          }
        // As Gmsh does when it saves a mesh.
        const auto is_grouped = [](const Element &cell) {
          return !cell.groups.empty();
        };
        if (is_geometry && std::any_of(cells.begin(), cells.end(), is_grouped))
          cells.erase(std::stable_partition(cells.begin(),
                                            cells.end(),
                                            is_grouped),
                      cells.end());
      }

      void
      take_nodes(const double scale)
      {
        std::vector<std::size_t> tags;
        std::vector<double>      coordinates, unused;
        gmsh::model::mesh::getNodes(tags, coordinates, unused);
        for (std::size_t i = 0; i < tags.size(); ++i)
          {
            dealii::Point<dim> vertex;
            for (unsigned int d = 0; d < dim; ++d)
              vertex[d] = scale * coordinates[3 * i + d];
            vertex_of[tags[i]] = static_cast<unsigned int>(vertices.size());
            vertices.push_back(vertex);
            heights.push_back(scale * coordinates[3 * i + 2]);
          }
      }

      std::vector<Element>
      elements(const int dimension)
      {
        std::vector<Element> result;
        gmsh::vectorpair     entities;
        gmsh::model::getEntities(entities, dimension);
        for (const auto &[unused, entity] : entities)
          {
            std::vector<int> tags_of_groups = {entity};
            if (!is_old)
              gmsh::model::getPhysicalGroupsForEntity(dimension,
                                                      entity,
                                                      tags_of_groups);
            Groups groups;
            for (const int tag : tags_of_groups)
              if (tag != 0)
                groups.insert(std::abs(tag));
            for (const int group : groups)
              {
                std::string name;
                gmsh::model::getPhysicalName(dimension, group, name);
                for (const int d : {-1, dimension})
                  if (const auto own = text.names.find({d, group});
                      own != text.names.end())
                    name = own->second;
                names[{dimension, group}] =
                  name.empty() ? std::to_string(group) : printable(name);
              }

            std::vector<int>                      types;
            std::vector<std::vector<std::size_t>> tags, nodes;
            gmsh::model::mesh::getElements(
              types, tags, nodes, dimension, entity);
            for (std::size_t k = 0; k < types.size(); ++k)
              {
                std::string         kind;
                int                 unused_dim, order, n_nodes, n_corners;
                std::vector<double> unused_points;
                gmsh::model::mesh::getElementProperties(types[k],
                                                        kind,
                                                        unused_dim,
                                                        order,
                                                        n_nodes,
                                                        unused_points,
                                                        n_corners);
                is_of_higher_order =
                  is_of_higher_order || (dimension == dim && order > 1);
                for (std::size_t e = 0; e < tags[k].size(); ++e)
                  {
                    Corners corners;
                    for (int v = 0; v < n_corners; ++v)
                      corners.push_back(
                        vertex_of.at(nodes[k][e * n_nodes + v]));
                    // Around a quadrilateral, or line by line.
                    const bool has_quadrilateral =
                      corners.size() == 8 || corners.size() == 5 ||
                      (corners.size() == 4 && dimension == 2);
                    for (std::size_t v = 0;
                         has_quadrilateral && v + 3 < corners.size();
                         v += 4)
                      std::swap(corners[v + 2], corners[v + 3]);
                    result.push_back({tags[k][e], corners, groups});
                  }
              }
          }
        return result;
      }

      /// Checks the cells one by one, and joins those that stand in the file
      /// once for each of their groups.
      void
      check_cells()
      {
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
        cells        = std::move(different);
        is_hypercube = kinds == std::set<std::size_t>{1u << dim};
        is_cut       = !is_hypercube && kinds != std::set<std::size_t>{dim + 1};
        if (dim == 2 && !(most_z - least_z <= tolerance * size))
          fail("z must be the same at all nodes of a plane mesh, but it goes "
               "from " +
               std::to_string(least_z) + " to " + std::to_string(most_z) +
               "; a body in 3D has cells in 3D, and needs Dimension = 3");
      }

      unsigned int
      add_centre(const Corners &corners)
      {
        dealii::Point<dim> sum;
        for (const unsigned int v : corners)
          sum += vertices[v] / static_cast<double>(corners.size());
        vertices.push_back(sum);
        return static_cast<unsigned int>(vertices.size() - 1);
      }

      /// A face itself, or the triangles that a quadrilateral is cut into.
      std::vector<Corners>
      parts(const Corners &face)
      {
        if (face.size() == dim)
          return {face};
        const auto [centre, is_new] = centres.emplace(key(face), 0);
        if (is_new)
          centre->second = add_centre(face);
        const unsigned int c = centre->second;
        return {{face[0], face[1], c},
                {face[1], face[3], c},
                {face[3], face[2], c},
                {face[2], face[0], c}};
      }

      void
      cut_cells()
      {
        for (std::size_t c = 0; c < cells.size(); ++c)
          {
            const Corners corners = cells[c].corners;
            if (corners.size() == dim + 1)
              {
                add_simplex(corners, c);
                continue;
              }
            if (corners.size() > 8 || corners.size() == 7)
              fail(element(c) + " is of a kind that is not read");
            const auto kind = dealii::ReferenceCell::n_vertices_to_type(
              dim, static_cast<unsigned int>(corners.size()));
            const unsigned int centre = add_centre(corners);
            for (const unsigned int f : kind.face_indices())
              {
                Corners face;
                for (const unsigned int v :
                     kind.face_reference_cell(f).vertex_indices())
                  face.push_back(corners[kind.face_to_cell_vertices(f, v, 1)]);
                for (Corners part : parts(face))
                  {
                    part.push_back(centre);
                    add_simplex(part, c);
                  }
              }
          }
      }

      /// With its corners in an order that makes its volume positive.
      void
      add_simplex(const Corners &corners, const std::size_t cell)
      {
        // Aspects up to 1e4 in 3D have more, rounding makes less.
        constexpr double       flat    = 1e-13;
        Simplex                simplex = {{}, cell};
        dealii::Tensor<2, dim> edges;
        double                 size = 0.;
        std::copy(corners.begin(), corners.end(), simplex.corners.begin());
        for (unsigned int d = 0; d < dim; ++d)
          {
            edges[d] = vertices[corners[d + 1]] - vertices[corners[0]];
            size     = std::max(size, edges[d].norm());
          }
        const double volume = dealii::determinant(edges / size);
        if (!(std::abs(volume) > flat))
          fail(element(cell) + " is flat" +
               (corners.size() == cells[cell].corners.size() ?
                  "" :
                  ", or its centre does not see all of its faces"));
        if (volume < 0.)
          std::swap(simplex.corners[dim - 1], simplex.corners[dim]);
        simplices.push_back(simplex);
      }

      /// Finds the faces of simplices outside and inside of the body.
      void
      take_faces()
      {
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
              inside.push_back(sides[s].face);
              neighbours.push_back({sides[s].cell, sides[s + 1].cell});
              ++s;
            }
      }

      /// Finds the groups of the boundary's faces, and those inside.
      void
      take_groups()
      {
        for (Element &face : faces)
          {
            if (face.groups.empty())
              continue;
            const bool           is_quadrilateral = face.corners.size() > dim;
            std::vector<Corners> pieces           = {face.corners};
            if (is_quadrilateral && centres.count(key(face.corners)) > 0)
              pieces = parts(face.corners);
            bool is_outside = true;
            for (const Corners &piece : pieces)
              {
                const auto outer =
                  std::lower_bound(outside.begin(),
                                   outside.end(),
                                   std::make_pair(key(piece), std::size_t(0)));
                if (outer != outside.end() && outer->first == key(piece))
                  continue;
                is_outside = false;
                if (!std::binary_search(inside.begin(),
                                        inside.end(),
                                        key(piece)))
                  fail(words("element ",
                             face.tag,
                             ", which is in a group, is the face of no cell"));
              }
            if (!is_outside)
              inner_groups.insert(face.groups.begin(), face.groups.end());
            else
              for (const Corners &piece :
                   is_cut ? pieces : std::vector<Corners>{face.corners})
                {
                  Element &outer = outer_faces[key(piece)];
                  outer.corners  = piece;
                  outer.groups.insert(face.groups.begin(), face.groups.end());
                }
          }
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
        for (std::size_t c = 0; c < root.size(); ++c)
          if (find(c) != find(0))
            fail("the mesh is of two bodies or more: " + element(c) +
                 " is not connected through faces with " + element(0) +
                 (n_twins == 0 ?
                    "" :
                    words("; there are ", n_twins, " nodes", on_one_place)));
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

      /// Checks that no vertex lies on a face of the boundary. Two vertices at
      /// one place are no hanging node, but a crack.
      void
      check_hanging_nodes()
      {
        std::set<unsigned int> on_boundary;
        for (const auto &[face, unused] : outside)
          on_boundary.insert(face.begin(), face.begin() + dim);
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
            dealii::BoundingBox<dim> box(corners);
            const auto              &ends = box.get_boundary_points();
            const double near_by = tolerance * ends.first.distance(ends.second);
            box.extend(near_by);
            std::vector<std::size_t> near;
            tree.query(boost::geometry::index::intersects(box),
                       std::back_inserter(near));
            for (const std::size_t i : near)
              {
                if (std::find(face.begin(), face.end(), candidates[i]) !=
                    face.end())
                  continue;
                const auto n     = normal(corners);
                double     least = std::numeric_limits<double>::max(), sum = 0.;
                for (unsigned int v = 0; v < dim; ++v)
                  {
                    auto with_it = corners;
                    with_it[v]   = places[i];
                    least = std::min(least, places[i].distance(corners[v]));
                    sum += normal(with_it).norm();
                  }
                if (least <= near_by)
                  twins.insert(candidates[i]);
                else if (std::abs(n * (places[i] - corners[0])) <=
                           near_by * n.norm() &&
                         sum <= (1. + tolerance) * n.norm())
                  {
                    std::ostringstream place;
                    place << places[i];
                    fail(element(cell) +
                         " has a hanging node on its face, at (" + place.str() +
                         ")");
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
        "are not connected with them; Coherence Mesh in Gmsh joins them";

      /// Relative to a face's size.
      static constexpr double tolerance = 1e-8;

      const std::string                             file_name;
      FileText                                      text;
      bool                                          is_old             = false;
      bool                                          is_of_higher_order = false;
      std::unordered_map<std::size_t, unsigned int> vertex_of; ///< by tag
      std::vector<dealii::Point<dim>>               vertices;  ///< and centres
      std::vector<double>                           heights;   ///< z
      std::vector<Element>                          cells, faces;

      /// By dimension and number of the group.
      std::map<std::pair<int, int>, std::string> names;

      bool                            is_hypercube = false, is_cut = false;
      std::vector<Simplex>            simplices;
      std::map<FaceKey, unsigned int> centres;
      std::vector<std::pair<FaceKey, std::size_t>>     outside; ///< with cells
      std::vector<FaceKey>                             inside;
      std::vector<std::pair<std::size_t, std::size_t>> neighbours; ///< cells
      std::map<FaceKey, Element> outer_faces; ///< in groups, of the mesh
      Groups                     inner_groups;
      std::size_t                n_twins = 0;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<SourceMesh<dim>>
  read_gmsh_mesh(const std::string &file_name,
                 const double       scale,
                 const double       size)
  {
    return GmshMesh<dim>(file_name, scale, size).make();
  }



  template decltype(read_gmsh_mesh<2>) read_gmsh_mesh<2>;
  template decltype(read_gmsh_mesh<3>) read_gmsh_mesh<3>;
} // namespace Debond
