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
write(const std::string &text, const std::string &name = "test.msh")
{
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
read(const std::string &text,
     const std::string &name   = "test.msh",
     const double       size   = 0.,
     const double       memory = 1e12)
{
  BodyParameters parameters;
  parameters.source         = BodyParameters::Source::file;
  parameters.file           = write(text, name);
  parameters.meshing.size   = size;
  parameters.meshing.memory = memory;
  return make_body<dim>(parameters);
}



/// What the user is told of a body that there is.
template <int dim>
std::string
notes(const Body<dim> &body)
{
  Triangulation<dim> mesh;
  std::string        text;
  for (const std::string &note : body.make_mesh(mesh).notes)
    text += note + "\n";
  return text;
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



/// What is said where it is refused.
std::string
refusal(const std::function<void()> &action)
{
  try
    {
      action();
    }
  catch (const std::invalid_argument &refused)
    {
      return refused.what();
    }
  return "";
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
  check("no such node", refusal([] {
                          read<2>(with("1 3 4", "1 3 6"));
                        }).find("test.msh: Gmsh ") == 0);
  error(with("1 3 4", "1 3 3"));
  error(with("3 2 2 1 1 1 3 4", "3 4 2 1 1 1 2 3 4"));
  error(with("1 3 4", "1 2 4"));     // overlaps
  error(with("4 0 1 0", "4 2 2 0")); // flat
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
  // A triangle of a kind that Gmsh has for itself.
  error("$MeshFormat\n3 0 8\n$EndMeshFormat\n"
        "$Entities\n0 0 1 0\n1 0 0\n$EndEntities\n"
        "$Nodes\n3\n1 0 0 0 0\n2 1 0 0 0\n3 1 1 0 0\n$EndNodes\n"
        "$Elements\n1\n1 135 1 4 1 2 3 1\n$EndElements\n");
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
  check("one that is partly inside is noted",
        notes(*read<2>(with("9 1 2 4", "9 1 2 1", crossed)))
            .find("1 of 2 faces of the group 1 lie inside the body") == 0);
  const auto apart = read<2>(with("9 1 2 4 1 3 1", "9 1 2 4 4 4 2", crossed));
  check("an edge of nothing is noted",
        apart->boundaries() == std::set<std::string>{"1"} &&
          apart->inner_groups == std::set<std::string>{"4"} &&
          notes(*apart).find("1 of 1 faces of the group 4 lie away from the "
                             "body, and are left out") == 0);
  check("names have no control characters",
        read<2>(with("$Nodes",
                     "$PhysicalNames\n1\n1 1 \"a\x1b[31mb\"\n"
                     "$EndPhysicalNames\n$Nodes"))
            ->boundaries() == std::set<std::string>{"a\\x1b[31mb"});
  check("names with underscores and blanks",
        read<2>(with("$Nodes",
                     "$PhysicalNames\n2\n1 1 \" glued_side \"\n2 1 \"b_1\"\n"
                     "$EndPhysicalNames\n$Nodes"))
            ->boundaries() == std::set<std::string>{"glued_side"});
  // All in partition 2 of a file that has no other.
  const std::string piece =
    with("3\n1 1 2 1 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4",
         "3\n1 1 4 1 1 1 2 1 2\n2 2 4 1 1 1 2 1 2 3\n3 2 4 1 1 1 2 1 3 4");
  check("a piece of a partition", read<2>(piece)->n_cells() == 2);
  // A square cut from its corner to its centre, where two nodes lie.
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
        notes(*read<2>(fan)).find("there are 2 nodes at the same place") == 0);
  check("nothing else is",
        notes(*read<2>(with("4 6 5", "4 1 5", fan))).empty());
}



/// A square of two triangles and one of two quadrilaterals beside it in a
/// partition of two, whose pieces have groups of their own beside those of the
/// file; whole and one piece with the cells of the other as ghosts.
void
test_partition()
{
  std::cout << "Partitions" << std::endl;
  const std::string header =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n"
    "1 1 \"the_left\"\n1 9 \"_part{1}_physical{the_left}\"\n"
    "2 2 \"a_body\"\n$EndPhysicalNames\n"
    "$Entities\n0 1 1 0\n1 0 0 0 0 1 0 1 1 0\n1 0 0 0 2 1 0 1 2 0\n"
    "$EndEntities\n";
  const std::string nodes =
    "$Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n"
    "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n$EndNodes\n";
  const auto whole =
    read<2>(header +
            "$PartitionedEntities\n2\n0\n0 2 2 0\n"
            "2 1 1 1 1 0 0 0 0 1 0 2 1 9 0\n"
            "3 2 1 2 1 2 1 0 0 1 1 0 0 0\n"
            "2 2 1 1 1 0 0 0 1 1 0 1 2 0\n3 2 1 1 2 1 0 0 2 1 0 1 2 0\n"
            "$EndPartitionedEntities\n" +
            nodes +
            "$Elements\n4 6 1 6\n1 2 1 1\n1 1 4\n1 3 1 1\n2 2 5\n"
            "2 2 2 2\n3 1 2 5\n4 1 5 4\n2 3 2 2\n5 2 3 6\n6 2 6 5\n"
            "$EndElements\n");
  check("it is joined",
        whole->n_cells() == 4 && notes(*whole).empty() &&
          whole->boundaries() == std::set<std::string>{"the_left"} &&
          whole->inner_groups.empty() &&
          whole->regions() == std::set<std::string>{"a_body"});
  const auto piece =
    read<2>(header +
            "$PartitionedEntities\n2\n1\n3 1\n0 1 1 0\n"
            "2 1 1 1 1 0 0 0 0 1 0 2 1 9 0\n2 2 1 1 1 0 0 0 1 1 0 1 2 0\n"
            "$EndPartitionedEntities\n" +
            nodes +
            "$Elements\n3 5 1 6\n1 2 1 1\n1 1 4\n2 2 2 2\n3 1 2 5\n"
            "4 1 5 4\n2 3 2 2\n5 2 3 6\n6 2 6 5\n$EndElements\n"
            "$GhostElements\n2\n5 2 1 1\n6 2 1 1\n$EndGhostElements\n");
  check("the ghosts of a piece are noted",
        piece->n_cells() == 2 &&
          notes(*piece) ==
            "ghost cells of pieces of a partition are left out: 2\n");
}



/// Files that Gmsh reads otherwise than they are meant.
void
test_other_formats()
{
  std::cout << "Other formats" << std::endl;
  const auto error =
    [](const std::string &text, const std::string &name, const double size) {
      print_error([&] { read<2>(text, name, size); });
    };
  const std::string entities =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n2 0 1 0\n"
    "1 0 0 0 0\n2 1 0 0 0\n1 0 0 0 1 1 0 0 1 7\n$EndEntities\n"
    "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
    "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n";
  check("a curve that is not in the file may bound a surface",
        read<2>(entities)->n_cells() == 1);
  const std::string broken =
    with("1 0 0 0 0\n",
         "1 0 0 0\n0\n",
         with("1 1 0 0 1 7\n", "1 1 0 1 5 0\n", entities));
  const std::string refused = refusal([&] { read<2>(broken); });
  check(
    "an entity in two lines is read with its group, as by Gmsh 4.13, or refused",
    refused.empty() ? read<2>(broken)->regions() == std::set<std::string>{"5"} :
                      refused.find("has to be a line") != std::string::npos);
  error("    -1\n  2467\n    -1\n", "test.unv", 0.);
  error("*HEADING\n", "test.inp", 0.);
  check("another format than Medit's in .mesh is named",
        refusal([] {
          read<2>("MFEM mesh v1.0\n\ndimension\n2\n", "test.mesh", 0.);
        }).find("Medit") != std::string::npos);
  error("solid\nendsolid\n", "empty.stl", 0.);
  error("Save \"other.msh\";\nExit;\n", "test.geo", 0.);
  const std::string plane = "SetFactory(\"OpenCASCADE\");\n"
                            "Rectangle(1) = {0, 0, 0, 2, 1};\n";
  error(plane + "Rotate {{1, 0, 0}, {0, 0, 0}, Pi/2} { Surface{1}; }\n",
        "test.geo",
        0.);
  error(plane + "Rotate {{0, 1, 0}, {0, 0, 0}, Pi/2} { Surface{1}; }\n",
        "test.geo",
        0.);
  std::string words;
  try
    {
      read<2>(plane + "Mesh.MeshSizeMax = 0.001;\n", "test.geo", 0., 3e7);
    }
  catch (const std::invalid_argument &said)
    {
      words = said.what();
    }
  check("Gmsh's memory is limited",
        words.find("a memory of 0.0 GiB is not enough") != std::string::npos);
  try
    {
      read<2>("Point(1) = {0, 0, 0, 1};\nPoint(2) = {1, 0, 0, 1};\n"
              "Point(3) = {0, 1, 0, 1};\nLine(1) = {1, 2};\n"
              "Line(2) = {2, 3};\nCurve Loop(1) = {1, 2};\n"
              "Plane Surface(1) = {1};\n",
              "test.geo");
    }
  catch (const std::invalid_argument &said)
    {
      words = said.what();
    }
  check("an outline that is not closed",
        words.find("closed loop") != std::string::npos);
  check("options that Gmsh does not know and pictures change no geometry",
        read<2>("Mesh.NoSuchOption = 2;\n" + plane + "Print \"plane.png\";\n",
                "test.geo")
            ->n_cells() > 0);
  const std::string tetrahedron =
    "solid\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\n"
    "vertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    "vertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\n"
    "vertex 0 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\n"
    "vertex 0 0 1\nendloop\nendfacet\nendsolid\n";
  print_error([&] { read<3>(tetrahedron, "test.stl"); });
  Triangulation<3> mesh;
  read<3>("Merge \"test.stl\";\nSurface Loop(1) = Surface{:};\n"
          "Volume(1) = {1};\n",
          "test.geo")
    ->make_mesh(mesh);
  check("an STL file that is filled",
        std::abs(measure_of(mesh) - 1. / 6.) < 1e-12);
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
    parameters.meshing.size = size;
    Triangulation<2> mesh;
    const auto       body  = make_body<2>(parameters);
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
  const auto left_out =
    read<2>("SetFactory(\"OpenCASCADE\");\n"
            "Rectangle(1) = {0, 0, 0, 1, 1};\nRectangle(2) = {1, 0, 0, 1, 1};\n"
            "BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }\n"
            "Transfinite Curve {:} = 4;\nTransfinite Surface {:};\n"
            "Physical Surface(\"plate\") = {1};\n"
            "bottom() = Curve In BoundingBox {-1, -0.1, -1, 3, 0.1, 1};\n"
            "Physical Curve(\"bottom\") = bottom();\n",
            "test.geo");
  check("what is left out is noted",
        left_out->n_cells() == 18 &&
          notes(*left_out) ==
            "cells left out: 18; surfaces in no group of the file: 1\n"
            "3 of 6 faces of the group bottom lie away from the body, and are "
            "left out\n");
  parameters.meshing.size = 0.;
  print_error([&] { make_body<3>(parameters); });
  std::ofstream("test.geo") << "SetFactory(\"OpenCASCADE\");\n"
                               "Box(1) = {0, 0, 0, 1, 1, 1};\n";
  print_error([&] { make_body<2>(parameters); });
  std::ofstream("test.geo") << "Point(1) = {0, 0,\n";
  print_error([&] { make_body<2>(parameters); });
  parameters.file         = write(square);
  parameters.meshing.size = 1.;
  print_error([&] { make_body<2>(parameters); });
  check("locale and environment are as they were",
        std::setlocale(LC_ALL, nullptr) == std::string("C.UTF-8") &&
          std::getenv("PATH") == path);
}



/// The sum of the normals out of the body of the sides of a cut along the group
/// "cut", their area, and the volume that the low side encloses.
template <int dim>
struct Sides
{
  Tensor<1, dim>           low;
  std::array<double, 2>    area{};
  double                   volume = 0.;
  std::vector<std::string> notes;

  explicit Sides(const std::string &geometry, const double degrees = 0.)
  {
    BodyParameters parameters;
    parameters.source       = BodyParameters::Source::file;
    parameters.file         = write(geometry, "test.geo");
    parameters.box.rotation = degrees;
    const auto body         = make_body<dim>(parameters);
    Cut<dim>   cut;
    cut.name = "cut_1";
    cut.text = cut.group = "cut";
    cut.rotation         = rotation_matrix<dim>(degrees);
    body->cuts           = {cut};
    Triangulation<dim> mesh;
    const PieceNames   names = body->make_mesh(mesh);
    check("  names of a cut along a group",
          names.boundaries.at("cut") == names.boundaries.at("cut_1") &&
            names.boundaries.at("cut_low") ==
              names.boundaries.at("cut_1_low") &&
            names.boundaries.size() == body->boundaries().size());
    for (const auto &cell : mesh.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        for (const unsigned int k : {0u, 1u})
          if (face->at_boundary() &&
              names.boundaries.at(k == 0 ? "cut_low" : "cut_high")
                  .count(face->boundary_id()) > 0)
            {
              area[k] += face->measure();
              if (k == 1)
                continue;
              // Away from the cell.
              Tensor<1, dim> normal;
              if constexpr (dim == 2)
                normal = cross_product_2d(face->vertex(1) - face->vertex(0));
              else
                normal = cross_product_3d(face->vertex(1) - face->vertex(0),
                                          face->vertex(2) - face->vertex(0)) /
                         2.;
              if (normal * (face->center() - cell->center()) < 0.)
                normal *= -1.;
              low += normal;
              volume += normal * face->center() / dim;
            }
    notes = names.notes;
  }
};



/// Where the sides of cuts along groups are; that J is that of other cuts is in
/// oracle/bodies.
void
test_groups()
{
  std::cout << "Cuts along a group" << std::endl;
  const auto square = [](const std::string &points, const std::string &lines) {
    return "Point(1) = {0, 0, 0, 0.3};\nPoint(2) = {2, 0, 0, 0.3};\n"
           "Point(3) = {2, 2, 0, 0.3};\nPoint(4) = {0, 2, 0, 0.3};\n"
           "Line(1) = {1, 2};\nLine(2) = {2, 3};\nLine(3) = {3, 4};\n"
           "Line(4) = {4, 1};\nCurve Loop(1) = {1, 2, 3, 4};\n"
           "Plane Surface(1) = {1};\n" +
           points + lines +
           "Physical Surface(\"all\") = {1};\n"
           "Physical Curve(\"side\") = {4};\n";
  };
  // A bent line, one on a diagonal, both drawn either way, with other lines.
  const std::string bent =
    "Point(5) = {0.5, 1, 0, 0.1};\nPoint(6) = {1, 1.3, 0, 0.1};\n"
    "Point(7) = {1.5, 0.9, 0, 0.1};\n";
  for (const std::string line :
       {"Spline(5) = {5, 6, 7};", "Spline(5) = {7, 6, 5};"})
    {
      const std::string cut =
        line + "Line {5} In Surface {1};\nPhysical Curve(\"cut\") = {5};\n";
      const Sides<2> sides(square(bent, cut)), turned(square(bent, cut), 120.);
      check("a bent line, low below it",
            (sides.low - Point<2>(0.1, 1.)).norm(),
            1e-12);
      check("it turned",
            (turned.low - rotation_matrix<2>(120.) * sides.low).norm(),
            1e-12);
      check("both sides", std::abs(sides.area[0] - sides.area[1]), 1e-12);
    }
  for (const std::string line : {"Line(5) = {5, 6};", "Line(5) = {6, 5};"})
    check("on the diagonal x decides",
          (Sides<2>(square("Point(5) = {0.5, 0.5, 0, 0.1};\n"
                           "Point(6) = {1.5, 1.5, 0, 0.1};\n",
                           line + "Line {5} In Surface {1};\n"
                                  "Physical Curve(\"cut\") = {5};\n"))
             .low -
           Point<2>(1., -1.))
            .norm(),
          1e-12);
  // Two pieces, and a circle.
  const Sides<2> two(
    square("Point(5) = {0.5, 0.3, 0, 0.1};\nPoint(6) = {1.5, 0.3, 0, 0.1};\n"
           "Point(7) = {0.5, 1, 0, 0.1};\nPoint(8) = {0.5, 1.5, 0, 0.1};\n",
           "Line(5) = {6, 5};\nLine(6) = {8, 7};\n"
           "Line {5, 6} In Surface {1};\nPhysical Curve(\"cut\") = {5, 6};\n"));
  check("two pieces", (two.low - Point<2>(0.5, 1.)).norm(), 1e-12);
  const Sides<2> circle("SetFactory(\"OpenCASCADE\");\n"
                        "Rectangle(1) = {0, 0, 0, 4, 4};\n"
                        "Disk(2) = {2, 2, 0, 1};\n"
                        "BooleanFragments{ Surface{1}; Delete; }"
                        "{ Surface{2}; Delete; }\n"
                        "Physical Surface(\"all\") = {2, 3};\n"
                        "Physical Curve(\"cut\") = Boundary{ Surface{2}; };\n");
  check("a circle, high outside",
        circle.low.norm() < 1e-12 && circle.volume > 2.5 &&
          circle.volume < 3.1416);
}



/// A tube through the body, and a rectangle inside, two corners of which have
/// triangles that do not open.
void
test_surfaces()
{
  const Sides<3> tube(
    "SetFactory(\"OpenCASCADE\");\n"
    "Box(1) = {0, 0, 0, 2, 2, 1};\n"
    "Cylinder(2) = {1, 1, 0, 0, 0, 1, 0.5};\n"
    "BooleanFragments{ Volume{1}; Delete; }"
    "{ Volume{2}; Delete; }\n"
    "Mesh.MeshSizeMax = 0.4;\n"
    "Physical Volume(\"all\") = {2, 3};\n"
    "eps = 0.01;\n"
    "cut() = Surface In BoundingBox"
    "{0.5 - eps, 0.5 - eps, -eps, 1.5 + eps, 1.5 + eps, "
    "1 + eps};\n"
    "caps() = Surface In BoundingBox"
    "{0.5 - eps, 0.5 - eps, -eps, 1.5 + eps, 1.5 + eps, eps};\n"
    "caps() += Surface In BoundingBox"
    "{0.5 - eps, 0.5 - eps, 1 - eps, 1.5 + eps, 1.5 + eps, "
    "1 + eps};\n"
    "cut() -= caps();\n"
    "Physical Surface(\"cut\") = cut();\n");
  check("a tube, high outside", tube.low.norm() < 1e-12 && tube.volume > 0.);
  const std::string plate =
    "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 2, 2, 2};\n"
    "Rectangle(100) = {0.5, 0.5, 1, 1, 1};\n"
    "BooleanFragments{ Volume{1}; Delete; }{ Surface{100}; Delete; }\n"
    "Mesh.MeshSizeMax = 0.3;\nedges() = Boundary{ Surface{100}; };\n"
    "Transfinite Curve {edges()} = 5;\nTransfinite Surface {100};\n"
    "Physical Volume(\"all\") = {1};\n"
    "Physical Surface(\"cut\") = {100};\n";
  const Sides<3> rectangle(plate);
  check("a rectangle inside",
        std::abs(rectangle.area[0] - rectangle.area[1]) < 1e-12 &&
          std::abs(rectangle.area[0] - 15. / 16.) < 1e-12 &&
          std::abs(rectangle.low[2] - 15. / 16.) < 1e-12);
  check("what of it does not open is noted",
        rectangle.notes.size() == 1 &&
          rectangle.notes[0].find("2 of the faces of cut, such as at (") == 0);
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test_errors();
  test_odd_files();
  test_partition();
  test_other_formats();
  test_mixed_cells();
  test_geometry();
  test_groups();
  test_surfaces();
}
