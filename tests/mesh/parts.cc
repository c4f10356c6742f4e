// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Parts of sides and of a body, which may overlap: which faces and cells have
// their names, and what the names of the sides stand for then.

#include <debond/mesh/box.h>

#include <cmath>

#include "../check.h"

using namespace dealii;
using namespace Debond;

template <int dim>
void
test()
{
  const BoxParameters box    = {{{2., 1., 1.}}, {{8, 4, 2}}};
  const auto          beyond = [](const double x) {
    return [x](const Point<dim> &p) { return p[0] > x; };
  };
  // Their edges follow the mesh but for that of "cut".
  const std::vector<Part<dim>> parts = {
    {"glued", "bottom", beyond(0.5)},
    {"end", "bottom", beyond(1.5)},
    {"cut", "top", beyond(0.6)},
    {"far", "", beyond(1.)},
    {"upper", "", [](const Point<dim> &p) { return p[1] > 0.5; }},
    {"ends", "boundary", [](const Point<dim> &p) {
       return std::abs(p[0] - 1.) > 1. - 1e-6;
     }}};
  Box<dim> body(box);
  body.parts = parts;
  Triangulation<dim> mesh;
  const PieceNames   names = body.make_mesh(mesh);
  std::cout << dim << "D" << std::endl;
  for (const std::string &note : names.notes)
    std::cout << note << std::endl;

  // By geometry.
  bool good_faces = true, good_cells = true;
  for (const auto &cell : mesh.active_cell_iterators())
    {
      const auto in_region = [&](const std::string &name) {
        return names.regions.at(name).count(cell->material_id()) > 0;
      };
      good_cells = good_cells && in_region("far") == (cell->center()[0] > 1.) &&
                   in_region("upper") == (cell->center()[1] > 0.5);
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          {
            const Point<dim> p  = face->center();
            const auto       on = [&](const std::string &name) {
              return names.boundaries.at(name).count(face->boundary_id()) > 0;
            };
            const bool bottom = p[1]<1e-12, top = p[1]> 1. - 1e-12;
            good_faces        = good_faces && on("bottom") == bottom &&
                         on("top") == top &&
                         on("glued") == (bottom && p[0] > 0.5) &&
                         on("end") == (bottom && p[0] > 1.5) &&
                         on("cut") == (top && p[0] > 0.6) &&
                         on("left") == (p[0] < 1e-12) &&
                         on("ends") == (on("left") || on("right"));
          }
    }
  check("faces have the names of their parts and sides", good_faces);
  check("cells have the names of their regions", good_cells);

  std::set<types::boundary_id> occurring, named;
  for (const types::boundary_id id : mesh.get_boundary_ids())
    occurring.insert(id);
  for (const auto &[unused, ids] : names.boundaries)
    named.insert(ids.begin(), ids.end());
  check("all ids occur in the mesh", occurring == named);
  check("the narrowest name is told",
        boundary_name(names.boundaries, *names.boundaries.at("end").begin()) ==
          "end");
  check("names are known before the mesh",
        body.boundaries().count("glued") > 0 &&
          body.boundaries().count("left") > 0 &&
          body.regions() == std::set<std::string>{"far", "upper"});

  // The coarser box has faces of half its length. In 3D they are cut in four,
  // and one of these has its centre closer to the end.
  const auto coarser = body.coarser();
  check("a coarser body has the parts",
        coarser && coarser->boundaries() == body.boundaries());
  body.parts = {{"end", "bottom", beyond(1.8)}};
  check("and none if a part has no face in it", !body.coarser() == (dim == 2));
  for (const std::string of : {"bottom", "boundary", ""})
    print_error([&] {
      body.parts = {{"none", of, beyond(2.)}};
      Triangulation<dim> other;
      body.make_mesh(other);
    });
}



int
main()
{
  test<2>();
  test<3>();
}
