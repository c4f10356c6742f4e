// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Gmsh files that are no body; cells of several kinds; geometries. Boxes in
// files of all kinds are in program/bodies, mutated ones in program/fuzz.

#include <deal.II/grid/tria.h>

#include <debond/mesh/make_body.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "../check.h"

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
read(const std::string &text)
{
  BodyParameters parameters;
  parameters.source = BodyParameters::Source::file;
  parameters.file   = write(text);
  return std::dynamic_pointer_cast<const Body<dim>>(make_body(dim, parameters));
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
  // A node that is not there, at which Gmsh crashes or not.
  std::string words;
  try
    {
      read<2>(with("1 3 4", "1 3 6"));
    }
  catch (const std::invalid_argument &said)
    {
      words = said.what();
    }
  check("no such node", words.find("test.msh: Gmsh ") == 0);
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
    unsigned int n = 0;
    for (const auto &face : mesh.active_face_iterators())
      n += face->at_boundary() &&
           names.boundaries.at(name).count(face->boundary_id()) > 0;
    return n;
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



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test_errors();
  test_odd_files();
  test_mixed_cells();
  test_geometry();
}
