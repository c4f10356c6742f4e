// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Boxes written as Gmsh files of two versions, of both kinds of cells, some
// turned inside out, and read again: the same cells, sides and regions as the
// box has. Files that are no body; cells of several kinds; geometries. Any
// argument: the number of mutated files that are read beside them.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/mesh/box.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/make_body.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "../check.h"
#include "msh_text.h"

using namespace dealii;
using namespace Debond;

std::string
write(const std::string &text)
{
  const std::string name = "test.msh";
  std::ofstream(name) << text;
  return name;
}



template <int dim>
double
measure_of(const Triangulation<dim> &mesh)
{
  double sum = 0.;
  for (const auto &cell : mesh.active_cell_iterators())
    sum += cell->measure();
  return sum;
}



template <int dim>
std::shared_ptr<const Body<dim>>
read(const std::string &text, const double scale = 1.)
{
  BodyParameters parameters;
  parameters.source = BodyParameters::Source::file;
  parameters.file   = write(text);
  parameters.scale  = scale;
  return std::dynamic_pointer_cast<const Body<dim>>(make_body(dim, parameters));
}



/// Where the cells of each region and the faces of each boundary are, as
/// sorted lists of the centres.
template <int dim>
std::map<std::string, std::vector<std::array<double, dim + 1>>>
pieces(const Triangulation<dim> &mesh, const PieceNames &names)
{
  std::map<std::string, std::vector<std::array<double, dim + 1>>> result;
  const auto add = [&](const std::string &name, const auto &object) {
    std::array<double, dim + 1> entry;
    for (unsigned int d = 0; d < dim; ++d)
      entry[d] = std::round(1e9 * object->center()[d]);
    entry[dim] = std::round(1e9 * object->measure());
    result[name].push_back(entry);
  };
  for (const auto &cell : mesh.active_cell_iterators())
    {
      for (const auto &[name, ids] : names.regions)
        if (ids.count(cell->material_id()) > 0)
          add(name, cell);
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          for (const auto &[name, ids] : names.boundaries)
            if (ids.count(face->boundary_id()) > 0)
              add(name, face);
    }
  for (auto &[unused, list] : result)
    std::sort(list.begin(), list.end());
  return result;
}



template <int dim>
void
test_box(const BoxParameters &parameters)
{
  const Box<dim>     box(parameters);
  Triangulation<dim> mesh;
  PieceNames         names = box.make_mesh(mesh);
  // The regions, from the cells before they are crossed.
  Triangulation<dim>        coarse;
  std::vector<unsigned int> cells;
  Point<dim>                corner;
  for (unsigned int d = 0; d < dim; ++d)
    {
      cells.push_back(parameters.cells[d]);
      corner[d] = parameters.lengths[d];
    }
  GridGenerator::subdivided_hyper_rectangle(
    coarse, cells, Point<dim>(), corner, true);
  for (const auto &cell : mesh.active_cell_iterators())
    cell->set_material_id(1);
  names.regions["all"] = {1, 2};

  for (const bool crossed : {false, true})
    for (const bool version_4 : {false, true})
      {
        for (const auto &cell : mesh.active_cell_iterators())
          {
            // Of a quadrilateral as a whole, where that is what is written.
            const double edge = parameters.lengths[0] / parameters.cells[0];
            const double x =
              crossed ? cell->center()[0] :
                        (std::floor(cell->center()[0] / edge) + 0.5) * edge;
            cell->set_material_id(x > 1. ? 2 : 1);
          }
        names.regions["upper"] = {2};

        const std::string text =
          crossed ? msh_text(mesh, version_4) : msh_text(coarse, version_4);
        const auto         body = read<dim>(text);
        Triangulation<dim> read_mesh;
        const PieceNames   read_names = body->make_mesh(read_mesh);
        std::cout << dim << "D, " << (crossed ? "simplices" : "to be crossed")
                  << ", version " << (version_4 ? "4.1" : "2.2") << ": "
                  << read_mesh.n_active_cells() << " cells" << std::endl;
        check("the box's cells and names",
              pieces<dim>(read_mesh, read_names) == pieces<dim>(mesh, names));
        check("number of vertices",
              body->n_vertices() == mesh.n_used_vertices());
        bool same = body->n_cells() == mesh.n_active_cells();
        check("sizes", same && body->boundaries() == box.boundaries());
        for (unsigned int d = 0; d < dim; ++d)
          same = same && std::abs(body->shape().lengths[d] -
                                  parameters.lengths[d]) < 1e-12;
        check("lengths", same);
      }
}



/// A square of two triangles with a boundary element, to be spoilt.
const std::string square = "$MeshFormat\n"
                           "2.2 0 8\n"
                           "$EndMeshFormat\n"
                           "$Nodes\n"
                           "5\n"
                           "1 0 0 0\n"
                           "2 1 0 0\n"
                           "3 1 1 0\n"
                           "4 0 1 0\n"
                           "5 0.5 0 0\n"
                           "$EndNodes\n"
                           "$Elements\n"
                           "3\n"
                           "1 1 2 1 1 1 2\n"
                           "2 2 2 1 1 1 2 3\n"
                           "3 2 2 1 1 1 3 4\n"
                           "$EndElements\n";

std::string
with(const std::string &from, const std::string &to, std::string text = square)
{
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "not in it: " + from :
                                   text.replace(at, from.size(), to);
}



void
test_errors()
{
  std::cout << "Files that are no body" << std::endl;
  const auto error = [](const std::string &text) {
    print_error([&] { read<2>(text); });
  };
  check("a square without groups' names is one",
        read<2>(square)->boundaries() == std::set<std::string>{"1"});
  error("");
  error(with("2.2 0 8", "5.7 0 8"));
  error(with("4 0 1 0", "4 0 nan 0"));
  error(with("4 0 1 0", "4 0 1 1"));
  error(with("1 3 4", "1 3 6"));
  error(with("1 3 4", "1 3 3"));
  error(with("3 2 2 1 1 1 3 4", "3 4 2 1 1 1 2 3 4"));
  error(with("1 3 4", "1 2 4"));                 // overlaps
  error(with("1 1 2 1 1 1 2", "1 1 2 1 1 2 4")); // an edge of nothing
  error(with("4 0 1 0", "4 2 2 0"));             // flat
  // A triangle below two whose common node is on its edge.
  error(with("3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4",
             "4\n2 2 2 1 1 1 5 4\n3 2 2 1 1 5 2 3\n4 2 2 1 1 5 3 4\n"
             "5 2 2 1 1 1 6 2",
             with("$Nodes\n5", "$Nodes\n6\n6 0.5 -1 0")));
  // A triangle that touches a corner only.
  error(with("1 3 4", "3 4 5", with("5 0.5 0 0", "5 2 2 0")));
  // A quadrilateral that is not convex.
  error(with("3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4",
             "1\n2 3 2 1 1 1 2 3 4",
             with("3 1 1 0", "3 0.2 0.2 0")));
  // Counts that do not fit.
  error(with("$Elements\n3", "$Elements\n2"));
  error(with("3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4",
             "1\n1 1 2 1 1 1 2"));
  // Two triangles that each have nodes of their own.
  const std::string apart = with("$Nodes\n5", "$Nodes\n7\n6 0 0 0\n7 1 1 0");
  error(with("1 3 4", "6 7 4", apart));
  print_error([&] { read<3>(square); });
}



void
test_odd_files()
{
  std::cout << "Files that are odd" << std::endl;
  check("the mark of UTF-8 is skipped",
        read<2>("\xef\xbb\xbf" + square)->n_cells() == 2.);
  const std::string crossed =
    with("3\n1 1 2 1 1 1 2", "4\n1 1 2 1 1 1 2\n9 1 2 4 1 3 1");
  const auto body = read<2>(crossed);
  check("a group inside is none of the boundary",
        body->boundaries() == std::set<std::string>{"1"} &&
          body->inner_groups == std::set<std::string>{"4"});
  check("names have no control characters",
        read<2>(with("$Nodes",
                     "$PhysicalNames\n1\n1 1 \"a\x1b[31mb\"\n"
                     "$EndPhysicalNames\n$Nodes"))
            ->boundaries() == std::set<std::string>{"a\\x1b[31mb"});
  // A square cut from its corner to its centre, where two nodes lie.
  const auto notes = [](const std::string &text) {
    Triangulation<2> mesh;
    return read<2>(text)->make_mesh(mesh).notes;
  };
  const std::string four =
    "5\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 5\n3 2 2 1 1 2 3 5\n"
    "4 2 2 1 1 3 4 5\n5 2 2 1 1 4 6 5";
  const std::string fan =
    with("3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4",
         four,
         with("$Nodes\n5",
              "$Nodes\n6\n6 1e-12 0 0",
              with("5 0.5 0 0", "5 0.5 0.5 0")));
  check("a crack is noted",
        notes(fan).size() == 1 &&
          notes(fan)[0].find("2 nodes at the same place") != std::string::npos);
  check("nothing else is", notes(with("4 6 5", "4 1 5", fan)).empty());
}



/// Cells of two kinds, and prisms: cut into simplices of the same body.
void
test_mixed_cells()
{
  std::cout << "Cells that are cut" << std::endl;
  Triangulation<2> mesh;
  auto             body =
    read<2>(with("3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4",
                 "3\n1 1 2 1 1 2 5\n2 3 2 1 1 1 2 3 4\n3 2 2 2 1 2 5 3",
                 with("5 0.5 0 0", "5 2 0 0")));
  body->make_mesh(mesh);
  check("a square beside a triangle",
        mesh.n_active_cells() == 5 &&
          std::abs(measure_of(mesh) - 1.5) < 1e-12 &&
          body->regions() == std::set<std::string>{"1", "2"});

  // A prism with a pyramid on its oblique side, with groups on a triangle, on
  // a quadrilateral outside and on the one between them.
  Triangulation<3> solid;
  const auto       prism =
    read<3>("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n7\n"
            "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 0 1\n6 0 1 1\n7 1 1 0.5\n"
            "$EndNodes\n$Elements\n5\n1 2 2 5 1 1 2 3\n2 3 2 6 2 1 2 5 4\n"
            "3 3 2 7 3 2 3 6 5\n4 6 2 1 1 1 2 3 4 5 6\n5 7 2 1 1 2 3 6 5 7\n"
            "$EndElements\n");
  prism->make_mesh(solid);
  check("a prism beside a pyramid",
        solid.n_active_cells() == 22 &&
          std::abs(measure_of(solid) - 0.5 - 1. / 3.) < 1e-12);
  check("faces of theirs",
        prism->boundaries() == std::set<std::string>{"5", "6"} &&
          prism->inner_groups == std::set<std::string>{"7"});
}



/// A geometry, meshed; the process is what it was before.
void
test_geometry()
{
  std::cout << "Geometries" << std::endl;
  const std::string path = std::getenv("PATH");
  std::setlocale(LC_ALL, "C.UTF-8");
  std::ofstream("test.geo")
    << "SetFactory(\"OpenCASCADE\");\n"
       "Rectangle(1) = {0, 0, 0, 2, 1};\nRectangle(2) = {5, 0, 0, 1, 1};\n"
       "Physical Surface(\"plate\") = {1};\nPhysical Curve(\"foot\") = {1};\n"
       "Physical Curve(\"around\") = {1, 2, 3, 4};\n";
  BodyParameters parameters;
  parameters.source = BodyParameters::Source::file;
  parameters.file   = "test.geo";
  parameters.scale  = 10.;
  const auto n_on   = [&](const double size, const std::string &name) {
    parameters.size = size;
    Triangulation<2> mesh;
    const auto       body =
      std::dynamic_pointer_cast<const Body<2>>(make_body(2, parameters));
    const PieceNames names = body->make_mesh(mesh);
    check("  the area", std::abs(measure_of(mesh) - 200.) < 1e-9);
    return pieces<2>(mesh, names)[name].size();
  };
  check("edges of the foot", n_on(1., "foot") == 20);
  check("edges around", n_on(2., "around") == 30);
  parameters.size = 0.;
  print_error([&] { make_body(3, parameters); });
  std::ofstream("test.geo") << "SetFactory(\"OpenCASCADE\");\n"
                               "Box(1) = {0, 0, 0, 1, 1, 1};\n";
  print_error([&] { make_body(2, parameters); });
  std::ofstream("test.geo") << "Point(1) = {0, 0,\n";
  print_error([&] { make_body(2, parameters); });
  parameters.file = write(square);
  parameters.size = 1.;
  print_error([&] { make_body(2, parameters); });
  check("locale and environment are as they were",
        std::setlocale(LC_ALL, nullptr) == std::string("C.UTF-8") &&
          std::getenv("PATH") == path);
}



/// Refused before there is anything of them.
void
test_huge_generators()
{
  std::cout << "Generators with too many cells" << std::endl;
  const auto words_of = [](const unsigned int dim,
                           const std::string &name,
                           const std::string &arguments) -> std::string {
    BodyParameters parameters;
    parameters.source    = BodyParameters::Source::generator;
    parameters.generator = name;
    parameters.arguments = arguments;
    try
      {
        make_body(dim, parameters);
        return "makes it";
      }
    catch (const std::invalid_argument &error)
      {
        return error.what();
      }
  };
  const auto refused = [&](const std::string &count,
                           const unsigned int dim,
                           const std::string &name,
                           const std::string &arguments) {
    check("  " + name,
          words_of(dim, name, arguments).find("about " + count + " cells") !=
            std::string::npos);
  };
  refused("8e+15", 3, "subdivided_hyper_cube", "200000 : 0 : 1 : true");
  refused("9e+10", 2, "cheese", "300000, 300000");
  refused("3e+08",
          2,
          "hyper_cross",
          "100000000, 100000000, 100000000, 1 : true");
  refused("6e+11",
          2,
          "concentric_hyper_shells",
          "0, 0 : 1 : 2 : 200000 : 0.1 : 3000000 : true");
  refused(
    "2e+09",
    3,
    "plate_with_a_hole",
    "0.2 : 0.4 : 1 : 1 : 1 : 1 : 0, 0, 0 : 0 : 1 : 1 : 2000000000 : true");
  // Lengths are no numbers of cells.
  check("  lengths",
        words_of(2, "hyper_rectangle", "0, 0 : 50000, 30000 : true") ==
          "makes it");
}



/// Reads mutated files: each is a body or is refused by its name.
void
test_mutations(const unsigned int n)
{
  std::mt19937             random(1);
  std::vector<std::string> texts;
  Triangulation<2>         coarse, crossed;
  Triangulation<3>         bricks;
  GridGenerator::subdivided_hyper_rectangle(
    coarse, {4, 2}, Point<2>(), Point<2>(2., 1.), true);
  crossed_subdivision(coarse, crossed);
  GridGenerator::subdivided_hyper_rectangle(
    bricks, {2, 1, 1}, Point<3>(), Point<3>(2., 1., 1.), true);
  for (const bool version_4 : {false, true})
    texts.insert(texts.end(),
                 {msh_text(coarse, version_4),
                  msh_text(crossed, version_4),
                  msh_text(bricks, version_4)});

  const auto pick = [&](const std::size_t size) {
    return std::uniform_int_distribution<std::size_t>(0, size - 1)(random);
  };
  const std::vector<std::string> odd = {
    "-1", "0", "1e300", "nan", "x", "99999999999999999999", "2", "7", "", "\""};
  unsigned int n_read = 0, n_refused = 0;
  for (unsigned int i = 0; i < n; ++i)
    {
      const std::size_t        which = pick(texts.size());
      std::vector<std::string> lines;
      std::istringstream       text(texts[which]);
      for (std::string line; std::getline(text, line);)
        lines.push_back(line);
      for (std::size_t k = 0; k <= pick(3); ++k)
        {
          std::string &line = lines[pick(lines.size())];
          switch (pick(5))
            {
              case 0:
                lines.erase(lines.begin() + (&line - lines.data()));
                break;
              case 1:
                std::swap(line, lines[pick(lines.size())]);
                break;
              case 2:
                line = line.substr(0, pick(line.size() + 1));
                break;
              case 3:
                lines.insert(lines.begin() + (&line - lines.data()),
                             std::string(lines[pick(lines.size())]));
                break;
              default:
                {
                  const std::size_t at = line.rfind(' ', pick(line.size() + 1));
                  const std::size_t from = at == std::string::npos ? 0 : at + 1;
                  line.replace(from,
                               line.find(' ', from) - from,
                               odd[pick(odd.size())]);
                }
            }
        }
      std::string mutated;
      for (const std::string &line : lines)
        mutated += line + '\n';

      try
        {
          if (which % 3 == 2)
            {
              Triangulation<3> mesh;
              read<3>(mutated)->make_mesh(mesh);
            }
          else
            {
              Triangulation<2> mesh;
              read<2>(mutated)->make_mesh(mesh);
            }
          ++n_read;
        }
      catch (const std::invalid_argument &error)
        {
          const std::string message = error.what();
          if (message.find("test.msh") != std::string::npos)
            ++n_refused;
          else
            std::cout << message << std::endl;
        }
    }
  check("mutated files are read or refused by name", n_read + n_refused == n);
  check("some of each", n_read > 0 && n_refused > 0);
}



int
main(int argc, char **argv)
{
  print_figures = argc > 1;
  test_box<2>({{{3., 1., 1.}}, {{5, 3, 1}}, 0.});
  test_box<3>({{{3., 1., 0.5}}, {{3, 2, 2}}, 0.});
  test_errors();
  test_odd_files();
  test_mixed_cells();
  test_geometry();
  test_huge_generators();
  test_mutations(argc > 1 ? static_cast<unsigned int>(std::stoul(argv[1])) :
                            300);
}
