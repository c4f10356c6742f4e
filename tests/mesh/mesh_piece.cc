// SPDX-License-Identifier: LGPL-2.1-or-later
// The pieces of halved meshes for several ranks: cells, vertices, their order,
// numbers and slabs are those of the whole mesh, and so are the coarser levels.
// The same output is expected of 1, 2, 3 and 4 ranks.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/mesh/make_body.h>
#include <debond/mesh/mesh_piece.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <numeric>

#include "../check.h"

using namespace Debond;

namespace
{
  const MPI_Comm communicator = MPI_COMM_WORLD;



  /// On all ranks.
  void
  check_all(const std::string &what, const bool holds)
  {
    check(what,
          dealii::Utilities::MPI::min(static_cast<int>(holds), communicator) ==
            1);
  }



  /// The corners of a cell, bit by bit.
  template <typename CellIterator>
  auto
  corners(const CellIterator &cell)
  {
    std::vector<double> result;
    for (const unsigned int v : cell->vertex_indices())
      for (unsigned int d = 0; d < CellIterator::AccessorType::dimension; ++d)
        result.push_back(cell->vertex(v)[d]);
    return result;
  }



  /// What a vertex depends on, by numbers in the whole.
  std::map<unsigned int, float>
  row(const Interpolation             &rows,
      const unsigned int               i,
      const std::vector<unsigned int> &numbers = {})
  {
    std::map<unsigned int, float> result;
    for (std::size_t k = rows.starts[i]; k < rows.starts[i + 1]; ++k)
      result[numbers.empty() ? rows.nodes[k] : numbers[rows.nodes[k]]] =
        rows.weights[k];
    return result;
  }



  template <int dim>
  void
  test_coarse_levels(const MeshBody<dim>              &body,
                     const dealii::Triangulation<dim> &whole,
                     const std::vector<unsigned int>  &whole_nodes,
                     const MeshPiece<dim>             &piece,
                     const dealii::Triangulation<dim> &mesh,
                     std::vector<unsigned int>         finer_numbers)
  {
    const auto levels = body.coarse_levels(whole, whole_nodes);
    std::cout << "  " << levels.size() << " coarser levels" << std::endl;
    const unsigned int n = piece.n_shared_levels();
    check("  as many as the body says",
          levels.size() == body.n_coarse_levels());
    check("  some are shared", n > 1 && n <= levels.size());

    // Nodes are in the order of the numbers.
    std::vector<unsigned int> nodes(finer_numbers.size());
    std::iota(nodes.begin(), nodes.end(), 0u);
    std::sort(nodes.begin(), nodes.end(), [&](unsigned int a, unsigned int b) {
      return finer_numbers[a] < finer_numbers[b];
    });
    std::sort(finer_numbers.begin(), finer_numbers.end());
    bool       same = true, are_sorted = true;
    const auto pieces = piece.coarse_pieces(mesh, nodes, n);
    for (unsigned int l = 0; l < n; ++l)
      {
        const CoarseLevel<dim> &level = levels[l];
        const auto             &part  = pieces[l];
        are_sorted                    = are_sorted &&
                     std::is_sorted(part.numbers.begin(), part.numbers.end());
        same               = same && part.n_whole == level.vertices.size();
        unsigned int n_own = 0;
        for (unsigned int i = 0; i < part.numbers.size(); ++i)
          {
            const unsigned int number = part.numbers[i];
            same = same && part.level.vertices[i] == level.vertices[number] &&
                   part.level.slabs[i] == level.slabs[number] &&
                   part.is_own[i] == piece.owns_slab(level.slabs[number]);
            n_own += part.is_own[i];
          }
        same = same &&
               dealii::Utilities::MPI::sum(n_own, communicator) == part.n_whole;
        for (unsigned int i = 0; i < finer_numbers.size(); ++i)
          same = same && row(part.level.to_finer, i, part.numbers) ==
                           row(level.to_finer, finer_numbers[i]);
        finer_numbers = part.numbers;
      }
    check_all("  the shared ones are parts of them", same && are_sorted);
    same = true;
    for (unsigned int k = 1; k <= n; ++k)
      {
        const auto rest = piece.coarse_whole(k);
        same            = same && rest.vertices == levels[k - 1].vertices &&
               rest.slabs == levels[k - 1].slabs &&
               rest.coarser.size() == levels.size() - k;
        for (unsigned int l = 0; l < rest.coarser.size(); ++l)
          same =
            same &&
            rest.coarser[l].to_finer.nodes == levels[l + k].to_finer.nodes &&
            rest.coarser[l].to_finer.weights ==
              levels[l + k].to_finer.weights &&
            rest.coarser[l].vertices == levels[l + k].vertices;
      }
    check_all("  and the others the same", same);
  }



  /// P1 interpolation by levels carries linear fields where cells are
  /// parallelograms.
  template <int dim>
  void
  test_linear_fields(const MeshBody<dim>              &body,
                     const dealii::Triangulation<dim> &mesh,
                     const std::vector<unsigned int>  &nodes)
  {
    std::vector<dealii::Point<dim>> points;
    for (const unsigned int v : nodes)
      points.push_back(mesh.get_vertices()[v]);
    double error = 0.;
    for (const CoarseLevel<dim> &level : body.coarse_levels(mesh, nodes))
      {
        for (unsigned int i = 0; i < points.size(); ++i)
          {
            dealii::Tensor<1, dim> mean;
            for (const auto &[j, weight] : row(level.to_finer, i))
              mean += static_cast<double>(weight) * level.vertices[j];
            error = std::max(error, (mean - points[i]).norm());
          }
        points = level.vertices;
      }
    check("  linear fields are carried over", error, 1e-12);
  }



  template <int dim>
  void
  test(const std::string &generator,
       const std::string &arguments,
       const unsigned int n_refinements,
       const bool         has_parallelograms)
  {
    std::cout << generator << ", " << dim << "D" << std::endl;
    BodyParameters parameters;
    parameters.source        = BodyParameters::Source::generator;
    parameters.generator     = generator;
    parameters.arguments     = arguments;
    parameters.n_refinements = n_refinements;
    const auto body          = std::dynamic_pointer_cast<const MeshBody<dim>>(
      make_body(dim, parameters));
    dealii::Triangulation<dim> whole, mesh;
    body->make_mesh(whole);
    const MeshPiece<dim> piece(body, communicator);
    const PieceNames     names = piece.make_mesh(mesh);

    const dealii::FE_SimplexP<dim> fe(1);
    dealii::DoFHandler<dim>        dofs(whole);
    dofs.distribute_dofs(fe);
    std::vector<unsigned int> number_at(whole.n_vertices()),
      node_at(whole.n_vertices());
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        {
          const auto dof =
            static_cast<unsigned int>(cell->vertex_dof_index(v, 0));
          number_at[cell->vertex_index(v)] = dof;
          node_at[dof]                     = cell->vertex_index(v);
        }
    const std::vector<unsigned int> slabs       = body->slabs(whole),
                                    numbers     = piece.numbers(mesh),
                                    piece_slabs = piece.slabs(mesh);
    unsigned int n_own                          = 0;
    bool         are_equal = true, are_sorted = true, are_numbers = true;
    std::size_t  last = 0;
    auto         cell = whole.begin_active();
    std::map<dealii::types::boundary_id, double>       measures;
    std::map<dealii::types::boundary_id, unsigned int> n_faces;
    for (const auto &own : mesh.active_cell_iterators())
      {
        while (cell != whole.end() && corners(cell) != corners(own))
          ++cell;
        are_equal = are_equal && cell != whole.end();
        if (!are_equal)
          break;
        const unsigned int index = own->active_cell_index();
        are_sorted = are_sorted && piece.cell_number(index) >= last &&
                     piece.cell_number(index) ==
                       cell->active_cell_index() / (dim == 2 ? 4 : 24);
        last = piece.cell_number(index);
        for (const unsigned int v : cell->vertex_indices())
          are_numbers =
            are_numbers &&
            numbers[own->vertex_index(v)] == number_at[cell->vertex_index(v)] &&
            piece_slabs[own->vertex_index(v)] == slabs[cell->vertex_index(v)];
        if (piece.owns_cell(index))
          {
            ++n_own;
            for (const unsigned int f : own->face_indices())
              if (own->face(f)->at_boundary())
                {
                  are_equal = are_equal && cell->face(f)->boundary_id() ==
                                             own->face(f)->boundary_id();
                  ++n_faces[own->face(f)->boundary_id()];
                }
          }
        ++cell;
      }
    check_all("  cells are those of the whole mesh in its order",
              are_equal && are_sorted);
    check_all("  numbers and slabs are those of the whole", are_numbers);
    check("  each cell is one rank's",
          dealii::Utilities::MPI::sum(n_own, communicator) ==
            whole.n_active_cells());
    const double share = static_cast<double>(whole.n_active_cells()) /
                         dealii::Utilities::MPI::n_mpi_processes(communicator);
    check_all("  at most 1.1 n/N are own ones", n_own <= 1.1 * share);
    bool are_faces = true;
    for (const auto &[id, n] : piece.n_faces())
      are_faces = are_faces &&
                  dealii::Utilities::MPI::sum(n_faces[id], communicator) == n;
    check("  faces of the boundaries", are_faces);
    test_coarse_levels(*body, whole, node_at, piece, mesh, numbers);
    if (has_parallelograms)
      test_linear_fields(*body, whole, node_at);
  }
} // namespace



int
main(int argc, char *argv[])
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    std::cout.setstate(std::ios::failbit);
  test<2>("hyper_L", "-1 : 1 : true", 6, true);
  test<2>("quarter_hyper_shell", "0, 0 : 0.1 : 0.2 : 3 : true", 5, false);
  test<2>("hyper_ball", "0, 0 : 1 : false", 6, false);
  test<3>("subdivided_hyper_rectangle",
          "5, 4, 4 : 0, 0, 0 : 1, 1, 1 : false",
          2,
          true);
  test<3>("quarter_hyper_shell", "0, 0, 0 : 0.1 : 0.2 : 3 : true", 4, false);

  std::cout << "More ranks than units" << std::endl;
  BodyParameters parameters;
  parameters.source        = BodyParameters::Source::generator;
  parameters.generator     = "hyper_L";
  parameters.arguments     = "-1 : 1 : true";
  parameters.n_refinements = 5;
  print_error([&]() {
    std::dynamic_pointer_cast<const MeshBody<2>>(make_body(2, parameters))
      ->halved(5, 0, 769);
  });
}
