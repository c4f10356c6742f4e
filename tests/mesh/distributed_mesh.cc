// SPDX-License-Identifier: LGPL-2.1-or-later
// Meshes on several ranks: own cells are those of the whole mesh, with ghosts
// all around them. The same output is expected of 1, 2, 3 and 4 ranks.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/grid/grid_generator.h>

#include <debond/base/ranks.h>
#include <debond/mesh/distributed_mesh.h>
#include <debond/mesh/make_body.h>
#include <debond/mesh/mesh_body.h>

#include <algorithm>
#include <set>

#include "../check.h"

using namespace Debond;

namespace
{
  namespace MPI = dealii::Utilities::MPI;

  const MPI_Comm ranks = MPI_COMM_WORLD;



  /// On all ranks.
  void
  check_all(const std::string &what, const bool holds)
  {
    check(what, MPI::min(static_cast<int>(holds), ranks) == 1);
  }



  /// A cell of the whole mesh looks the same to its owner.
  template <typename Iterator, typename WholeIterator>
  bool
  are_equal(const Iterator &cell, const WholeIterator &whole)
  {
    bool result = cell->material_id() == whole->material_id();
    for (const unsigned int v : whole->vertex_indices())
      result = result && cell->vertex(v) == whole->vertex(v);
    if (cell->is_locally_owned())
      for (const unsigned int f : whole->face_indices())
        result = result && cell->at_boundary(f) == whole->at_boundary(f) &&
                 cell->face(f)->boundary_id() == whole->face(f)->boundary_id();
    return result;
  }



  template <int dim>
  void
  test_cells(const dealii::Triangulation<dim> &whole,
             const dealii::Triangulation<dim> &mesh)
  {
    std::vector<typename dealii::Triangulation<dim>::active_cell_iterator>
      cells_of_whole;
    for (const auto &cell : whole.active_cell_iterators())
      cells_of_whole.push_back(cell);

    // By vertices of the whole mesh.
    std::vector<std::set<unsigned int>> cells_at(whole.n_vertices());
    for (const auto &cell : cells_of_whole)
      for (const unsigned int v : cell->vertex_indices())
        cells_at[cell->vertex_index(v)].insert(cell->active_cell_index());

    std::vector<unsigned int> n_owners(whole.n_active_cells(), 0);
    std::set<unsigned int>    known, needed;
    bool                      same = true, is_sorted = true;
    for (const auto &cell : mesh.active_cell_iterators())
      {
        const auto id =
          static_cast<unsigned int>(cell->id().get_coarse_cell_id());
        const auto &of_whole = cells_of_whole.at(id);
        is_sorted = is_sorted && (known.empty() || *known.rbegin() < id);
        known.insert(id);
        same = same && are_equal(cell, of_whole);
        if (!cell->is_locally_owned())
          continue;
        ++n_owners[id];
        for (const unsigned int v : of_whole->vertex_indices())
          needed.insert(cells_at[of_whole->vertex_index(v)].begin(),
                        cells_at[of_whole->vertex_index(v)].end());
      }
    check_all("  cells are those of the whole mesh", same);
    check_all("  in its order", is_sorted);
    check_all("  and the ghosts those around the own ones", known == needed);
    check_all("  each rank has own cells",
              std::count(n_owners.begin(), n_owners.end(), 1u) > 0);
    MPI::sum(n_owners, ranks, n_owners);
    check_all("  each cell has one owner",
              std::count(n_owners.begin(), n_owners.end(), 1u) ==
                whole.n_active_cells());
    check_all("  the communicator has all ranks",
              MPI::n_mpi_processes(mesh.get_communicator()) ==
                MPI::n_mpi_processes(ranks));
  }



  template <int dim>
  void
  test_unknowns(const unsigned int                n_vertices,
                const dealii::Triangulation<dim> &mesh)
  {
    const dealii::FESystem<dim> fe(dealii::FE_SimplexP<dim>(1), dim);
    dealii::DoFHandler<dim>     dofs(mesh);
    dofs.distribute_dofs(fe);
    bool are_in_a_row = true;
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        for (unsigned int d = 0; d < dim; ++d)
          are_in_a_row =
            are_in_a_row && cell->vertex_dof_index(v, 0) % dim == 0 &&
            cell->vertex_dof_index(v, d) == cell->vertex_dof_index(v, 0) + d;
    check_all("  unknowns are those of the whole mesh",
              dofs.n_dofs() == dim * n_vertices);
    check_all("  those of a vertex are in a row", are_in_a_row);
  }



  template <int dim>
  void
  test(const Body<dim> &body)
  {
    dealii::Triangulation<dim> whole;
    const PieceNames           names  = body.make_mesh(whole);
    const DistributedMesh<dim> result = make_distributed_mesh(body, ranks);
    check_all("  names",
              result.names.boundaries == names.boundaries &&
                result.names.regions == names.regions &&
                result.names.notes == names.notes);
    test_cells(whole, *result.triangulation);
    test_unknowns(whole.n_used_vertices(), *result.triangulation);
  }



  template <int dim>
  void
  test_box(const std::array<unsigned int, 3> &cells,
           const double                       rotation = 0.,
           const std::vector<Part<dim>>      &parts    = {})
  {
    section(dim, "D, ", cells[0], "x", cells[1], "x", cells[2], ", ", rotation);
    Box<dim> box({{{0.4, 0.07, 0.03}}, cells, rotation});
    box.parts = parts;
    test(box);
  }



  template <int dim>
  void
  test_generator(const std::string &generator,
                 const std::string &arguments,
                 const unsigned int n_refinements)
  {
    section(dim, "D, ", generator);
    BodyParameters parameters;
    parameters.source        = BodyParameters::Source::generator;
    parameters.generator     = generator;
    parameters.arguments     = arguments;
    parameters.n_refinements = n_refinements;
    test(
      *std::dynamic_pointer_cast<const Body<dim>>(make_body(dim, parameters)));
  }



  /// Triangles or tetrahedra of two materials.
  template <int dim>
  MeshBody<dim>
  simplices(const unsigned int n)
  {
    return {[n](const unsigned int) {
              auto source = std::make_unique<SourceMesh<dim>>();
              dealii::GridGenerator::subdivided_hyper_cube_with_simplices(
                source->mesh, n);
              for (const auto &cell : source->mesh.active_cell_iterators())
                cell->set_material_id(cell->center()[dim - 1] < 0.5 ? 3 : 7);
              for (const auto &face : source->mesh.active_face_iterators())
                if (face->at_boundary() && face->center()[0] < 1e-6)
                  face->set_boundary_id(5);
              source->names.boundaries["left"] = {5};
              source->names.regions            = {{"low", {3}}, {"high", {7}}};
              return source;
            },
            0};
  }



  /// What make_distributed_mesh() throws, from the first rank.
  template <typename Error, int dim>
  void
  test_error(const Body<dim> &body)
  {
    bool is_first = false, is_elsewhere = false;
    try
      {
        make_distributed_mesh(body, ranks);
      }
    catch (const ErrorElsewhere &)
      {
        is_elsewhere = true;
      }
    catch (const Error &)
      {
        is_first = true;
      }
    check_all("  is thrown by the first rank",
              MPI::this_mpi_process(ranks) == 0 ? is_first : is_elsewhere);
  }



  void
  test_errors()
  {
    section("Box without cells");
    Box<2> box({{{1., 1., 1.}}, {{8, 0, 1}}, 0.});
    test_error<std::invalid_argument>(box);
    section("Part without faces");
    Box<3> empty_part({{{1., 1., 1.}}, {{8, 1, 1}}, 0.});
    empty_part.parts = {
      {"none", "bottom", [](const dealii::Point<3> &) { return false; }}};
    test_error<PartError>(empty_part);

    section("More ranks than cells");
    bool has_failed = false;
    try
      {
        make_distributed_mesh(simplices<2>(1), ranks);
      }
    catch (const std::invalid_argument &)
      {
        has_failed = true;
      }
    check_all("  all ranks fail",
              has_failed == (MPI::n_mpi_processes(ranks) > 2));
  }



  void
  test_first_rank()
  {
    section("on_first_rank");
    const unsigned int rank = MPI::this_mpi_process(ranks);
    check_all("  a number of the first rank",
              on_first_rank(ranks, [&]() { return 7 + rank; }) == 7);
    check_all("  a text", on_first_rank(ranks, [&]() {
                            return std::string("rank ") + std::to_string(rank);
                          }) == "rank 0");
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  print_figures = argc > 1;
  if (dealii::Utilities::MPI::this_mpi_process(ranks) != 0)
    std::cout.setstate(std::ios::failbit);

  test_box<2>({{9, 3, 1}});
  test_box<2>({{3, 7, 1}}, 30.);
  test_box<2>({{1, 5, 1}});
  test_box<2>({{1, 1, 1}});
  test_box<2>({{2, 1, 1}}, 10.);
  test_box<3>({{7, 3, 2}});
  test_box<3>({{4, 1, 1}}, -20.);
  test_box<3>({{2, 3, 5}}, 75.);
  test_box<3>({{1, 1, 1}});
  test_box<2>(
    {{8, 4, 1}},
    0.,
    {{"glued", "bottom", [](const dealii::Point<2> &p) { return p[0] > 0.12; }},
     {"far", "", [](const dealii::Point<2> &p) { return p[0] > 0.2; }}});
  test_box<3>(
    {{6, 2, 2}},
    0.,
    {{"glued", "bottom", [](const dealii::Point<3> &p) { return p[0] > 0.12; }},
     {"far", "", [](const dealii::Point<3> &p) { return p[0] > 0.2; }}});
  test_generator<2>("hyper_L", "-1 : 1 : true", 3);
  test_generator<3>("quarter_hyper_shell", "0, 0, 0 : 0.1 : 0.2 : 3 : true", 1);
  section("2D, triangles");
  test(simplices<2>(5));
  section("3D, tetrahedra");
  test(simplices<3>(3));
  test_errors();
  test_first_rank();
}
