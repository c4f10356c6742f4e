// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What a body says of its mesh before that exists, against the mesh; its
// coarser bodies, and fields that are carried over.

#include <debond/mesh/box.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "../check.h"

using namespace dealii;
using namespace Debond;

/// Sizes against counts in the mesh.
template <int dim>
void
test_sizes(const Body<dim> &body)
{
  Triangulation<dim> mesh;
  const PieceNames   names = body.make_mesh(mesh);
  std::map<types::boundary_id, std::set<unsigned int>> vertices;
  for (const auto &cell : mesh.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary())
        for (const unsigned int v : face->vertex_indices())
          vertices[face->boundary_id()].insert(face->vertex_index(v));

  std::cout << mesh.n_active_cells() << " cells" << std::endl;
  check("number of cells", body.n_cells() == mesh.n_active_cells());
  check("number of vertices", body.n_vertices() == mesh.n_used_vertices());
  bool same_on_sides = names.boundaries.size() == body.boundaries().size();
  for (const auto &[name, ids] : names.boundaries)
    {
      std::set<unsigned int> on_side;
      for (const types::boundary_id id : ids)
        on_side.insert(vertices[id].begin(), vertices[id].end());
      same_on_sides = same_on_sides && body.boundaries().count(name) > 0 &&
                      body.n_vertices_on(name) == on_side.size();
    }
  check("number of vertices on each side", same_on_sides);
}



/// A field that is linear on the cells of the coarser mesh, carried to the
/// vertices of the finer one.
template <int dim>
void
test_interpolation(const Body<dim> &coarse, const Body<dim> &fine)
{
  Triangulation<dim> coarse_mesh, fine_mesh;
  coarse.make_mesh(coarse_mesh);
  fine.make_mesh(fine_mesh);

  std::vector<Tensor<1, dim>> values(coarse_mesh.n_vertices());
  for (std::size_t v = 0; v < values.size(); ++v)
    for (unsigned int d = 0; d < dim; ++d)
      values[v][d] = std::sin(1.7 * static_cast<double>(v) + d);

  const std::vector<Tensor<1, dim>> carried =
    coarse.interpolate(coarse_mesh, values, fine_mesh.get_vertices());
  double       largest_error = 0.;
  unsigned int n_found       = 0;
  for (std::size_t i = 0; i < carried.size(); ++i)
    for (const auto &cell : coarse_mesh.active_cell_iterators())
      {
        Tensor<2, dim> edges;
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int c = 0; c < dim; ++c)
            edges[c][d] = cell->vertex(d + 1)[c] - cell->vertex(0)[c];
        const Tensor<1, dim> coordinates =
          invert(edges) * (fine_mesh.get_vertices()[i] - cell->vertex(0));
        double         rest   = 1.;
        bool           inside = true;
        Tensor<1, dim> value;
        for (unsigned int d = 0; d < dim; ++d)
          {
            rest -= coordinates[d];
            inside = inside && coordinates[d] > -1e-10;
            value += coordinates[d] * values[cell->vertex_index(d + 1)];
          }
        if (!inside || rest < -1e-10)
          continue;
        value += rest * values[cell->vertex_index(0)];
        largest_error = std::max(largest_error, (value - carried[i]).norm());
        ++n_found;
        break;
      }
  check("every vertex is in a cell", n_found == carried.size());
  check("carried over as the cells say", largest_error, 1e-9);
}



template <int dim>
void
test(const BoxParameters &box)
{
  std::shared_ptr<const Body<dim>> body = std::make_shared<Box<dim>>(box);
  test_sizes(*body);
  for (std::shared_ptr<const Body<dim>> coarser = body->coarser(); coarser;
       coarser                                  = body->coarser())
    {
                                       test_sizes(*coarser);
                                       test_interpolation(*coarser, *body);
                                       body = std::move(coarser);
    }
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test<2>({{{0.4, 0.04, 1.}}, {{7, 2, 1}}, 0.});
  test<2>({{{3., 1., 1.}}, {{4, 3, 1}}, 30.});
  test<3>({{{1., 2., 0.5}}, {{3, 1, 2}}, -20.});
}
