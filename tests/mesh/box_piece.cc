// SPDX-License-Identifier: LGPL-2.1-or-later
// The pieces of a box for several ranks: cells, vertices and their order are
// those of the whole mesh to the last bit, numbers those that unknowns have
// there, and no piece has more cells than its own and two slabs on each side.

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <debond/mesh/box_piece.h>

#include <iostream>

#include "../check.h"

using namespace Debond;

namespace
{
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



  /// For each side, the measure of the faces of own cells with its id.
  template <int dim>
  void
  add_measures(const dealii::Triangulation<dim>                   &mesh,
               const BoxPiece<dim>                                &piece,
               std::map<dealii::types::boundary_id, double>       &measures,
               std::map<dealii::types::boundary_id, unsigned int> &n_faces,
               double                                             &volume)
  {
    for (const auto &cell : mesh.active_cell_iterators())
      if (piece.owns_cell(cell->active_cell_index()))
        {
          volume += cell->measure();
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
              {
                measures[face->boundary_id()] += face->measure();
                ++n_faces[face->boundary_id()];
              }
        }
  }



  /// The cell (of the box) in which a point lies, in the order of cells.
  template <int dim>
  std::size_t
  cell_at(const BoxParameters &box, const dealii::Point<dim> &point)
  {
    std::size_t result = 0;
    for (unsigned int d = dim; d-- > 0;)
      result =
        result * box.cells[d] +
        static_cast<std::size_t>(point[d] * box.cells[d] / box.lengths[d]);
    return result;
  }



  template <int dim>
  void
  test(const std::array<unsigned int, 3> &cells)
  {
    BoxParameters box;
    box.lengths = {{0.4, 0.07, 0.03}};
    box.cells   = cells;
    dealii::Triangulation<dim> whole;
    make_box(box, whole);
    const dealii::FE_SimplexP<dim> fe(1);
    dealii::DoFHandler<dim>        dofs(whole);
    dofs.distribute_dofs(fe);
    const auto          body = std::make_shared<const Box<dim>>(box);
    const BoxPiece<dim> all(body, 0, 1);
    const std::vector<unsigned int> found                 = all.numbers(whole);
    bool                            are_those_of_unknowns = true;
    for (const auto &cell : dofs.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        are_those_of_unknowns =
          are_those_of_unknowns &&
          found[cell->vertex_index(v)] == cell->vertex_dof_index(v, 0);
    check("  numbers of vertices are those of unknowns", are_those_of_unknowns);

    const unsigned int per_slab = whole.n_active_cells() / cells[0];
    for (const unsigned int n_ranks : {1u, 2u, 3u, cells[0]})
      {
        std::map<dealii::types::boundary_id, double>       measures;
        std::map<dealii::types::boundary_id, unsigned int> n_faces;
        double                                             volume = 0.;
        unsigned int                                       n_own  = 0;
        bool are_equal = true, are_few = true, are_sorted = true;
        for (unsigned int rank = 0; rank < n_ranks; ++rank)
          {
            const BoxPiece<dim>        piece(body, rank, n_ranks);
            dealii::Triangulation<dim> mesh;
            piece.make_mesh(mesh);
            are_few = are_few && mesh.n_active_cells() <=
                                   (cells[0] / n_ranks + 1 + 4) * per_slab;
            auto cell = whole.begin_active();
            for (const auto &own : mesh.active_cell_iterators())
              {
                while (cell != whole.end() && corners(cell) != corners(own))
                  ++cell;
                are_equal = are_equal && cell != whole.end();
                n_own += piece.owns_cell(own->active_cell_index());
                if (cell != whole.end())
                  ++cell;
              }
            std::size_t last = 0;
            for (const auto &own : mesh.active_cell_iterators())
              {
                const std::size_t number =
                  piece.cell_number(own->active_cell_index());
                are_sorted = are_sorted && number >= last &&
                             number == cell_at(box, own->center());
                last = number;
              }
            add_measures(mesh, piece, measures, n_faces, volume);
          }
        std::cout << "  " << n_ranks << " ranks" << std::endl;
        check("    cells are those of the whole mesh in its order",
              are_equal && are_sorted);
        check("    each is the own one of one rank",
              n_own == whole.n_active_cells());
        check("    at most two slabs of ghosts on each side", are_few);
        const double whole_volume =
          box.lengths[0] * box.lengths[1] * (dim == 3 ? box.lengths[2] : 1.);
        check("    volume", std::abs(volume / whole_volume - 1.), 1e-12);
        bool are_sides = true;
        for (const auto &[name, id] : box_sides<dim>())
          {
            double measure = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              if (d != id / 2)
                measure *= box.lengths[d];
            are_sides = are_sides &&
                        std::abs(measures[id] / measure - 1.) < 1e-12 &&
                        n_faces[id] == all.n_faces().at(id);
          }
        check("    sides have their measures and numbers of faces",
              are_sides && measures.size() == 2 * dim);
      }
  }
} // namespace



int
main()
{
  std::cout << "2D" << std::endl;
  test<2>({{9, 3, 1}});
  std::cout << "3D" << std::endl;
  test<3>({{7, 3, 2}});
  BoxParameters box;
  box.cells       = {{3, 2, 1}};
  const auto make = [&](const unsigned int n_ranks) {
    BoxPiece<2>(std::make_shared<const Box<2>>(box), 0, n_ranks);
  };
  print_error([&]() { make(4); });
  box.rotation = 10.;
  print_error([&]() { make(2); });
}
