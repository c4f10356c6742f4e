// SPDX-License-Identifier: LGPL-2.1-or-later
// Meshes with groups written as Gmsh files.
#ifndef debond_tests_mesh_msh_text_h
#define debond_tests_mesh_msh_text_h

#include <deal.II/grid/tria.h>

#include <debond/mesh/box.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

/// The mesh as a Gmsh file. Every second cell is written inside out, the nodes
/// have numbers with gaps, and one node belongs to no cell. The groups of faces
/// are the boundary ids + 1, that of the cells is "all", and those whose centre
/// has x > 1 are in "upper" as well.
template <int dim>
std::string
msh_text(const dealii::Triangulation<dim> &mesh, const bool version_4)
{
  const bool simplices = mesh.all_reference_cells_are_simplex();
  const auto in_circle = [&](std::vector<unsigned int> v) {
    for (std::size_t i = 0; !simplices && i + 3 < v.size(); i += 4)
      std::swap(v[i + 2], v[i + 3]);
    return v;
  };
  struct Element
  {
    std::vector<unsigned int> vertices;
    unsigned int              group;
  };
  std::vector<Element> faces, cells;
  for (const auto &cell : mesh.active_cell_iterators())
    {
      std::vector<unsigned int> v;
      for (const unsigned int i : cell->vertex_indices())
        v.push_back(cell->vertex_index(i));
      v = in_circle(v);
      if (cells.size() % 2 == 1)
        {
          if (v.size() == 8)
            std::swap_ranges(v.begin(), v.begin() + 4, v.begin() + 4);
          else
            std::reverse(v.begin(), v.end());
          // Even permutations of four corners of a tetrahedron do not turn it.
          if (dim == 3 && v.size() == 4)
            std::swap(v[0], v[1]);
        }
      cells.push_back({v, cell->center()[0] > 1. ? 8u : 7u});
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            std::vector<unsigned int> w;
            for (const unsigned int i : face->vertex_indices())
              w.push_back(face->vertex_index(i));
            faces.push_back({in_circle(w), face->boundary_id() + 1});
          }
    }

  const int  cell_type = dim == 2 ? (simplices ? 2 : 3) : (simplices ? 4 : 5);
  const int  face_type = dim == 2 ? 1 : (simplices ? 2 : 3);
  const auto tag       = [](const std::size_t v) { return 3 * v + 5; };
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n"
       << (version_4 ? "4.1" : "2.2") << " 0 8\n"
       << "$EndMeshFormat\n$PhysicalNames\n"
       << 2 * dim + 2 << '\n';
  for (const auto &[name, id] : Debond::box_sides<dim>())
    text << dim - 1 << ' ' << id + 1 << " \"" << name << "\"\n";
  text << dim << " 7 \"all\"\n" << dim << " 8 \"upper\"\n$EndPhysicalNames\n";

  const auto &points = mesh.get_vertices();
  const auto  print  = [&](const dealii::Point<dim> &p) {
    text << p << (dim == 2 ? " 0\n" : "\n");
  };
  const auto n_nodes    = points.size() + 1;
  const auto n_elements = cells.size() + faces.size();
  if (version_4)
    {
      // Entities of the cells and of each side; the last is in two groups.
      text << "$Entities\n0 " << (dim == 2 ? "4 2 0\n" : "0 6 2\n");
      for (unsigned int id = 1; id <= 2 * dim; ++id)
        text << id << " 0 0 0 1 1 1 1 " << id << " 0\n";
      text << "1 0 0 0 1 1 1 1 7 0\n2 0 0 0 1 1 1 2 7 -8 0\n$EndEntities\n"
           << "$Nodes\n1 " << n_nodes << " 1 " << tag(points.size()) << '\n'
           << dim << " 1 0 " << n_nodes << '\n';
      for (std::size_t v = 0; v < n_nodes; ++v)
        text << tag(v) << '\n';
      for (const auto &p : points)
        print(p);
      text << "9 9 9\n$EndNodes\n$Elements\n"
           << 2 * dim + 2 << ' ' << n_elements << " 1 " << n_elements << '\n';
      unsigned int number = 0;
      const auto   block  = [&](const int                   dimension,
                             const int                   entity,
                             const int                   type,
                             const std::vector<Element> &all,
                             const unsigned int          group) {
        const auto in_group = [&](const Element &e) {
          return e.group == group;
        };
        text << dimension << ' ' << entity << ' ' << type << ' '
             << std::count_if(all.begin(), all.end(), in_group) << '\n';
        for (const Element &e : all)
          if (in_group(e))
            {
              text << ++number;
              for (const unsigned int v : e.vertices)
                text << ' ' << tag(v);
              text << '\n';
            }
      };
      for (unsigned int id = 1; id <= 2 * dim; ++id)
        block(dim - 1, static_cast<int>(id), face_type, faces, id);
      block(dim, 1, cell_type, cells, 7);
      block(dim, 2, cell_type, cells, 8);
    }
  else
    {
      text << "$Nodes\n" << n_nodes << '\n';
      for (std::size_t v = 0; v < points.size(); ++v)
        {
          text << tag(v) << ' ';
          print(points[v]);
        }
      text << tag(points.size()) << " 9 9 9\n$EndNodes\n";
      std::ostringstream elements;
      unsigned int       number = 0;
      const auto         write =
        [&](const int type, const Element &e, const unsigned int group) {
          elements << ++number << ' ' << type << " 2 " << group << " 1";
          for (const unsigned int v : e.vertices)
            elements << ' ' << tag(v);
          elements << '\n';
        };
      for (const Element &face : faces)
        write(face_type, face, face.group);
      // This version repeats what is in two groups.
      for (const Element &cell : cells)
        {
          write(cell_type, cell, 7);
          if (cell.group == 8)
            write(cell_type, cell, 8);
        }
      text << "$Elements\n" << number << '\n' << elements.str();
    }
  text << "$EndElements\n";
  return text.str();
}

#endif
