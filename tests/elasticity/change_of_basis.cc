// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The change of basis with rows of all steps at nodes that have several of
// them: it is what its rows say, there and back are inverse, forces do the same
// work, and the matrix of a cell is that of its energy.

#include <debond/elasticity/change_of_basis.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../check.h"

using namespace dealii;
using namespace Debond;

constexpr double rounding = 1e-14;

std::mt19937 generator(1);



double
random_number()
{
  return std::uniform_real_distribution<double>(-1., 1.)(generator);
}



DofVector
random_vector(const unsigned int n)
{
  DofVector v(n);
  for (double &x : v)
    x = random_number();
  return v;
}



template <int dim>
Tensor<2, dim>
random_frame()
{
  Tensor<2, dim> frame = unit_symmetric_tensor<dim>();
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      frame[i][j] += 0.3 * random_number();
  return frame;
}



double
difference(DofVector a, const DofVector &b)
{
  a -= b;
  return a.linfty_norm();
}



/// Node 2 is in the middle between 0 and 1, node 3 is glued to 6, node 5, in
/// the middle between 3 and 4, to 7; the nodes 0, 3, 5 and 6 have frames. Of
/// the displacement of 6 node 3 has some components alone.
template <int dim>
void
test()
{
  section("dimension ", dim);
  constexpr unsigned int n_nodes = 8;
  ChangeOfBasis<dim>     basis;
  const auto             scaled = BasisRow<dim>::scaled;
  basis.set(BasisStep::coefficients,
            {scaled(2, 0.5, {{0, 0.25}, {1, 0.25}}),
             scaled(5, 0.5, {{3, 0.25}, {4, 0.25}})},
            n_nodes);
  BasisRow<dim>        glued = scaled(3, 1., {{6, 1.}});
  const Tensor<2, dim> part  = random_frame<dim>();
  glued.of_others            = part;
  basis.set(BasisStep::jumps, {glued, scaled(5, -1., {{7, 1.}})}, n_nodes);
  std::vector<BasisRow<dim>> frames;
  for (const unsigned int node : {0, 3, 5, 6})
    {
      const Tensor<2, dim> to_frame = random_frame<dim>();
      frames.push_back({node, invert(to_frame), to_frame});
    }
  basis.set(BasisStep::frames, frames, n_nodes);

  const DofVector x  = random_vector(dim * n_nodes);
  const DofVector u  = basis.to_nodal(x);
  const auto      at = [](const DofVector &v, const unsigned int node) {
    Tensor<1, dim> value;
    for (unsigned int d = 0; d < dim; ++d)
      value[d] = v(dim * node + d);
    return value;
  };
  // The jump of nodes 5 and 7, and the coefficient of node 5.
  const Tensor<1, dim> jump        = frames[2].to_nodal * at(x, 5),
                       coefficient = at(x, 7) - jump;
  check("a value of all steps",
        (at(u, 5) - (0.5 * coefficient + 0.25 * (at(u, 3) + at(u, 4)))).norm(),
        rounding);
  check("a jump along a frame",
        (at(u, 3) - part * at(u, 6) - frames[1].to_nodal * at(x, 3)).norm(),
        rounding);
  check("a node without rows", (at(u, 4) - at(x, 4)).norm(), 0.);
  const DofVector coefficients = basis.to_nodal(x, BasisStep::jumps);
  check("a coefficient", (at(coefficients, 5) - coefficient).norm(), rounding);
  check("there and back", difference(basis.to_unknowns(u), x), rounding);

  const DofVector f    = random_vector(dim * n_nodes);
  const DofVector on_x = basis.forces_to_unknowns(f);
  check("the work of forces", std::abs(f * u - on_x * x), rounding);
  check("forces there and back",
        difference(basis.forces_to_nodal(on_x), f),
        rounding);

  // A cell that has none of the nodes of the other body.
  typename ChangeOfBasis<dim>::Dofs cell_dofs, all;
  for (const unsigned int node : {4, 3, 5})
    for (unsigned int d = 0; d < dim; ++d)
      cell_dofs.push_back(dim * node + d);
  const unsigned int n = static_cast<unsigned int>(cell_dofs.size());
  FullMatrix<double> matrix(n, n);
  double             energy = 0.;
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j)
      {
        matrix(i, j) = random_number();
        energy += u(cell_dofs[i]) * matrix(i, j) * u(cell_dofs[j]);
      }
  all = cell_dofs;
  basis.add_others(all);
  basis.to_unknowns(cell_dofs, matrix);
  check("the nodes of the other body",
        all == cell_dofs && all.size() == n + 2 * dim);
  for (unsigned int i = 0; i < all.size(); ++i)
    for (unsigned int j = 0; j < all.size(); ++j)
      energy -= x(all[i]) * matrix(i, j) * x(all[j]);
  check("the energy of a cell", std::abs(energy), 10. * rounding);
}



int
main(int argc, char **)
{
  print_figures = argc > 1;
  test<2>();
  test<3>();
}
