// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What a body says of its mesh before that exists, against the mesh; its
// coarser bodies, and the cells that points lie in.

#include <debond/mesh/cell_search.h>
#include <debond/mesh/make_body.h>

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

  std::cout << mesh.n_active_cells() << " cells" << std::endl;
  check("number of cells", body.n_cells() == mesh.n_active_cells());
  const double part = body.n_vertices() / mesh.n_used_vertices();
  check("number of vertices, about", part > 0.3 && part < 1.);
  bool same = names.boundaries.size() == body.boundaries().size();
  for (const auto &[name, unused] : names.boundaries)
    same = same && body.boundaries().count(name) > 0;
  check("names of sides", same);
}



/// The P1 field with these values at vertices, at points.
template <int dim>
std::vector<Tensor<1, dim>>
interpolate(const Triangulation<dim>          &mesh,
            const std::vector<Tensor<1, dim>> &values,
            const std::vector<Point<dim>>     &points)
{
  const CellSearch<dim>       search(mesh);
  std::vector<Tensor<1, dim>> result;
  for (const Point<dim> &point : points)
    {
      const auto found = search(point);
      result.emplace_back();
      for (unsigned int v = 0; v <= dim; ++v)
        result.back() +=
          found.coordinates[v] * values[found.cell->vertex_index(v)];
    }
  return result;
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
    interpolate(coarse_mesh, values, fine_mesh.get_vertices());
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



/// A body and its coarser ones.
template <int dim>
void
test(std::shared_ptr<const Body<dim>> body)
{
  test_sizes(*body);
  for (std::shared_ptr<const Body<dim>> coarser = body->coarser(); coarser;
       coarser                                  = body->coarser())
    {
                                       test_sizes(*coarser);
                                       test_interpolation(*coarser, *body);
                                       body = std::move(coarser);
    }
}



template <int dim>
void
test_box(const BoxParameters &box)
{
  test<dim>(std::make_shared<Box<dim>>(box));
}



/// A generated mesh with straight sides, refined twice.
template <int dim>
void
test_generated(const std::string &name, const std::string &arguments)
{
  BodyParameters parameters;
  parameters.source        = BodyParameters::Source::generator;
  parameters.generator     = name;
  parameters.arguments     = arguments;
  parameters.n_refinements = dim == 2 ? 2 : 1;
  std::cout << name << std::endl;
  test<dim>(make_body<dim>(parameters));
}



/// Points on a circle that the coarser mesh cuts off, and a field that is
/// linear: it is carried on.
void
test_curved_side()
{
  const auto disc = [](const unsigned int n_refinements) {
    BodyParameters parameters;
    parameters.source        = BodyParameters::Source::generator;
    parameters.generator     = "hyper_ball";
    parameters.arguments     = "0, 0 : 1 : false";
    parameters.n_refinements = n_refinements;
    return make_body<2>(parameters);
  };
  const auto       coarse = disc(2)->coarser();
  Triangulation<2> coarse_mesh, mesh;
  coarse->make_mesh(coarse_mesh);
  disc(2)->make_mesh(mesh);
  const auto field = [](const Point<2> &p) {
    return Tensor<1, 2>({1. + p[0] - 2. * p[1], 3. * p[0] + p[1]});
  };
  std::vector<Tensor<1, 2>> values;
  for (const auto &vertex : coarse_mesh.get_vertices())
    values.push_back(field(vertex));
  const auto carried = interpolate(coarse_mesh, values, mesh.get_vertices());
  double     largest_error = 0.;
  for (std::size_t i = 0; i < carried.size(); ++i)
    largest_error =
      std::max(largest_error,
               (carried[i] - field(mesh.get_vertices()[i])).norm());
  check("a linear field is carried beyond a curved side", largest_error, 1e-12);
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test_box<2>({{{0.4, 0.04, 1.}}, {{7, 2, 1}}, 0.});
  test_box<2>({{{3., 1., 1.}}, {{4, 3, 1}}, 30.});
  test_box<3>({{{1., 2., 0.5}}, {{3, 1, 2}}, -20.});
  test_generated<2>("hyper_L", "-1 : 1 : true");
  // Without numbers of boundaries, which deal.II has in 2D alone.
  test_generated<3>("hyper_L", "-1 : 1 : false");
  test_curved_side();
}
