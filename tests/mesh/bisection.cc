// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Random refinements by bisection: no hanging nodes, names where they belong,
// the body's measure, shapes that do not degenerate, cells divided into their
// parts. A run has some hundred of them, "bisection 10000" so many.

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <debond/mesh/bisected_body.h>
#include <debond/mesh/body.h>
#include <debond/mesh/box.h>
#include <debond/mesh/mesh_body.h>

#include <random>

#include "../check.h"

using namespace dealii;
using namespace Debond;

namespace
{
  /// A body of any mesh, the boundaries of which have numbers for names.
  template <int dim>
  std::shared_ptr<const Body<dim>>
  body_of(const std::function<void(Triangulation<dim> &)> &make)
  {
    return std::make_shared<const MeshBody<dim>>(
      [make](const unsigned int) {
        auto source = std::make_unique<SourceMesh<dim>>();
        make(source->mesh);
        for (const types::boundary_id id : source->mesh.get_boundary_ids())
          source->names.boundaries[std::to_string(id)] = {id};
        return source;
      },
      0);
  }



  /// The least volume of a cell by the power of its longest edge.
  template <int dim>
  double
  least_shape(const Triangulation<dim> &mesh)
  {
    double least = 1.;
    for (const auto &cell : mesh.active_cell_iterators())
      least =
        std::min(least, cell->measure() / std::pow(cell->diameter(), 1. * dim));
    return least;
  }



  /// The cells of a conforming mesh have one or two at each face, and no
  /// vertex in the middle of an edge (which bisection could leave).
  template <int dim>
  bool
  is_conforming(const Triangulation<dim> &mesh)
  {
    const auto less = [](const Point<dim> &a, const Point<dim> &b) {
      return std::lexicographical_compare(a.begin_raw(),
                                          a.end_raw(),
                                          b.begin_raw(),
                                          b.end_raw());
    };
    std::set<Point<dim>, decltype(less)> vertices(less);
    for (const Point<dim> &vertex : mesh.get_vertices())
      vertices.insert(vertex);
    if (vertices.size() != mesh.n_vertices())
      return false;
    for (const auto &cell : mesh.active_cell_iterators())
      for (unsigned int v = 0; v <= dim; ++v)
        for (unsigned int w = 0; w < v; ++w)
          {
            const Point<dim> a = cell->vertex(v), b = cell->vertex(w);
            if (vertices.count(a + 0.5 * (b - a)) > 0 ||
                vertices.count(b + 0.5 * (a - b)) > 0)
              return false;
          }
    return true;
  }



  /// By ids: the area of boundary and the volume of cells.
  template <int dim>
  std::map<std::pair<int, unsigned int>, double>
  measures(const Triangulation<dim> &mesh)
  {
    std::map<std::pair<int, unsigned int>, double> result;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        result[{dim, cell->material_id()}] += cell->measure();
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            result[{dim - 1, face->boundary_id()}] += face->measure();
      }
    return result;
  }



  /// @p on_side: whether a point is on the boundary of this id.
  template <int dim>
  void
  refine_at_random(
    const std::string                                                 &name,
    const std::shared_ptr<const Body<dim>>                            &whole,
    const std::function<bool(const Point<dim> &, types::boundary_id)> &on_side,
    const double       least_part,
    const unsigned int n_marks)
  {
    std::cout << name << std::endl;
    std::mt19937                           random(1);
    std::uniform_real_distribution<double> uniform(0., 1.);

    auto               body = std::make_shared<const BisectedBody<dim>>(whole);
    Triangulation<dim> first;
    body->make_mesh(first);
    const auto   first_measures = measures(first);
    const double first_shape    = least_shape(first);

    bool   conforming = true, named = true, counted = true;
    double lost = 0., shape = first_shape, divided = 0.;
    for (unsigned int marked = 0; marked < n_marks;)
      {
        Triangulation<dim> mesh;
        body->make_mesh(mesh);
        // A tenth of the cells, or those at a corner, or one.
        std::vector<unsigned int> times(mesh.n_active_cells(), 0);
        const double              kind = uniform(random);
        for (const auto &cell : mesh.active_cell_iterators())
          if (kind < 0.3 ?
                uniform(random) < 0.1 :
                kind < 0.8 && cell->center().norm() < 1.5 * cell->diameter())
            times[cell->active_cell_index()] = 1 + random() % dim;
        times[random() % times.size()] = 1;
        for (const unsigned int t : times)
          marked += t > 0;
        if (mesh.n_active_cells() > 30000)
          body = std::make_shared<const BisectedBody<dim>>(whole);
        else
          body = body->refined(times);

        Triangulation<dim> finer;
        body->make_mesh(finer);
        if (finer.n_active_cells() > mesh.n_active_cells())
          {
            std::vector<double> parts(mesh.n_active_cells(), 0.);
            for (const auto &cell : finer.active_cell_iterators())
              parts[body->ancestors()[cell->active_cell_index()]] +=
                cell->measure();
            for (const auto &cell : mesh.active_cell_iterators())
              raise(divided,
                    std::abs(
                      parts[cell->active_cell_index()] / cell->measure() - 1.));
          }
        conforming = conforming && is_conforming(finer);
        for (const auto &cell : finer.active_cell_iterators())
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
              named = named && on_side(face->center(), face->boundary_id());
        for (const auto &[piece, value] : measures(finer))
          lost =
            std::max(lost, std::abs(value / first_measures.at(piece) - 1.));
        counted = counted && finer.n_active_cells() == body->n_cells() &&
                  finer.n_vertices() == body->n_vertices();
        shape = std::min(shape, least_shape(finer));
      }
    check("  no hanging nodes", conforming);
    check("  boundaries have their names", named);
    check("  cells and vertices are counted", counted);
    check("  measures of pieces, relative change", lost, 1e-11);
    check("  cells are divided into their parts", divided, 1e-11);
    check("  shapes that are worse than of the first mesh by",
          first_shape / shape,
          least_part);
  }



  template <int dim>
  bool
  on_box_side(const Point<dim> &p, const types::boundary_id id)
  {
    const double end = id % 2 == 0 ? 0. : 1.;
    return id < 2 * dim && std::abs(p[id / 2] - end) < 1e-12;
  }



  /// 2 x 2 x 2 cubes, each cut into the six tetrahedra along the ways from one
  /// corner to the opposite one; that corner is the middle of the box for all.
  void
  mirrored_kuhn_cubes(Triangulation<3> &mesh)
  {
    std::vector<Point<3>> vertices;
    for (unsigned int v = 0; v < 27; ++v)
      vertices.emplace_back(0.5 * (v % 3), 0.5 * (v / 3 % 3), 0.5 * (v / 9));
    std::vector<CellData<3>> cells;
    const std::array<int, 3> strides = {{1, 3, 9}};
    for (unsigned int cube = 0; cube < 8; ++cube)
      {
        std::array<unsigned int, 3> axes = {{0, 1, 2}};
        do
          {
            CellData<3> cell(4);
            cell.vertices[0] = 13;
            for (unsigned int k = 0; k < 3; ++k)
              cell.vertices[k + 1] =
                cell.vertices[k] +
                (cube >> axes[k] & 1 ? 1 : -1) * strides[axes[k]];
            // In an order that does not tell.
            const Point<3> a = vertices[cell.vertices[0]];
            Tensor<2, 3>   edges;
            for (unsigned int d = 0; d < 3; ++d)
              edges[d] = vertices[cell.vertices[d + 1]] - a;
            std::swap(cell.vertices[0], cell.vertices[1]);
            if (determinant(edges) > 0.)
              std::swap(cell.vertices[2], cell.vertices[3]);
            cells.push_back(cell);
          }
        while (std::next_permutation(axes.begin(), axes.end()));
      }
    mesh.create_triangulation(vertices, cells, SubCellData());
    for (const auto &face : mesh.active_face_iterators())
      for (types::boundary_id id = 0; id < 6; ++id)
        if (face->at_boundary() &&
            std::abs(face->center()[id / 2] - (id % 2 == 0 ? 0. : 1.)) < 1e-12)
          face->set_boundary_id(id);
  }



  template <int dim>
  void
  test(const unsigned int n_marks)
  {
    BoxParameters unit;
    unit.lengths   = {{1., 1., 1.}};
    unit.cells     = {{3, 2, 2}};
    const auto box = std::make_shared<const Box<dim>>(unit);
    refine_at_random<dim>(
      std::to_string(dim) + "D, box", box, on_box_side<dim>, 2., n_marks);

    const auto with_part = std::make_shared<Box<dim>>(unit);
    with_part->parts     = {
          {"glued", "bottom", [](const Point<dim> &p) { return p[0] > 0.4; }},
          {"far", "", [](const Point<dim> &p) { return p[0] > 0.5; }}};
    refine_at_random<dim>(
      std::to_string(dim) + "D, box with parts",
      with_part,
      [](const Point<dim> &p, const types::boundary_id id) {
        return id < 2 * dim ? on_box_side(p, id) :
                              on_box_side(p, 2) && p[0] > 1. / 3.;
      },
      2.,
      n_marks / 4);

    // Distorted, with sides where they were.
    refine_at_random<dim>(std::to_string(dim) + "D, distorted",
                          body_of<dim>([](Triangulation<dim> &mesh) {
                            GridGenerator::subdivided_hyper_cube(
                              mesh, 3, 0., 1., true);
                            GridTools::distort_random(0.2, mesh, true, 5);
                          }),
                          on_box_side<dim>,
                          2.5,
                          n_marks / 4);
  }
} // namespace



int
main(int argc, char **argv)
{
  print_figures              = argc > 1;
  const unsigned int n_marks = argc > 1 ? std::stoi(argv[1]) : 800;
  test<2>(n_marks);
  test<3>(n_marks);

  // Triangles of no order: longest edges first.
  refine_at_random<2>(
    "2D, triangles",
    body_of<2>([](Triangulation<2> &mesh) {
      Triangulation<2> squares;
      GridGenerator::subdivided_hyper_cube(squares, 3, 0., 1., true);
      GridTools::distort_random(0.25, squares, true, 5);
      GridGenerator::convert_hypercube_to_simplex_mesh(squares, mesh);
    }),
    on_box_side<2>,
    2.5,
    n_marks / 4);

  // Cubes of six tetrahedra around a diagonal have vertices of four colours if
  // neighbours are mirrored; those of 24 without a centre have not.
  refine_at_random<3>("3D, tetrahedra with four colours",
                      body_of<3>(mirrored_kuhn_cubes),
                      on_box_side<3>,
                      5.,
                      n_marks / 4);
  print_error([] {
    BisectedBody<3> body(body_of<3>([](Triangulation<3> &mesh) {
      Triangulation<3> cubes;
      GridGenerator::subdivided_hyper_cube(cubes, 2);
      GridGenerator::convert_hypercube_to_simplex_mesh(cubes, mesh);
    }));
  });
}
