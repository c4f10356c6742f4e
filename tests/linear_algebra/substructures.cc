// SPDX-License-Identifier: LGPL-2.1-or-later
// Condensation by substructures against dense elimination: elements of one and
// of several kinds, weights, unknowns that are kept inside or fixed, bodies in
// two pieces; that equal parts are made once, and what is refused.

#include <debond/linear_algebra/substructures.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "../check.h"

using namespace Debond;

namespace
{
  /// Squares with two unknowns on each side. Those on the lower side of the
  /// body are kept and one inside; on the left side the second one is fixed.
  struct Grid
  {
    unsigned int                     nx, ny, n_unknowns;
    std::vector<SubstructureElement> elements;
    std::vector<unsigned int>        kept;
    std::vector<Eigen::MatrixXd>     matrices; ///< by kind
    mutable unsigned int             calls = 0;

    /// Without @p gap_after columns an element is missing in the next column.
    Grid(const unsigned int nx,
         const unsigned int ny,
         const unsigned int n_kinds,
         const unsigned int gap_after,
         const double       stretch)
      : nx(nx)
      , ny(ny)
    {
      std::mt19937       engine(5);
      const unsigned int first_vertical = nx * (ny + 1);
      n_unknowns                        = 2 * (first_vertical + (nx + 1) * ny);
      for (unsigned int j = 0; j < ny; ++j)
        for (unsigned int i = 0; i < nx; ++i)
          {
            if (i == gap_after)
              continue;
            SubstructureElement own      = {};
            const unsigned int  vertical = first_vertical + (nx + 1) * j + i;
            // The matrix of a kind has as many rows as there are unknowns.
            own.kind = 2 * (engine() % n_kinds) + (i == 0 ? 1 : 0);
            for (const unsigned int side :
                 {vertical, nx * j + i, vertical + 1, nx * (j + 1) + i})
              for (const unsigned int k : {0, 1})
                if (i > 0 || side != vertical || k == 0)
                  own.unknowns.push_back(2 * side + k);
            own.centre     = {{stretch * (i + 0.5), j + 0.5, 0.}};
            own.extent     = {{stretch, 1., 0.}};
            own.has_weight = j == 0;
            elements.push_back(own);
          }
      for (unsigned int i = 0; i < nx; ++i)
        if (i != gap_after)
          for (const unsigned int k : {1, 0})
            kept.push_back(2 * i + k);
      if (ny > 2)
        kept.push_back(2 * nx + 1);

      std::uniform_real_distribution<double> value(-1., 1.);
      for (unsigned int kind = 0; kind < 2 * n_kinds; ++kind)
        {
          const unsigned int    size = kind % 2 == 0 ? 8 : 7;
          const Eigen::MatrixXd root =
            Eigen::MatrixXd::NullaryExpr(size, size, [&]() {
              return value(engine);
            });
          matrices.push_back(root * root.transpose() +
                             0.1 * Eigen::MatrixXd::Identity(size, size));
        }
    }

    Substructures
    substructures() const
    {
      return {elements, n_unknowns, kept, [this](const unsigned int kind) {
                ++calls;
                // The upper triangle is not read.
                Eigen::MatrixXd result = matrices[kind];
                result.triangularView<Eigen::StrictlyUpper>().setConstant(7.);
                return result;
              }};
    }
  };



  /// How far a condensation is from the dense one, relative.
  double
  error(const Grid                   &grid,
        const CondensedSubstructures &condensed,
        const Eigen::VectorXd        &f,
        const std::vector<double>    &weights,
        const double                  constant)
  {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(grid.n_unknowns, grid.n_unknowns);
    std::vector<char> is_used(grid.n_unknowns, 0);
    for (unsigned int e = 0; e < grid.elements.size(); ++e)
      {
        const SubstructureElement &own = grid.elements[e];
        A(own.unknowns, own.unknowns) +=
          (weights.empty() ? 1. : weights[e]) * grid.matrices[own.kind];
        for (const unsigned int i : own.unknowns)
          is_used[i] = 1;
      }
    std::vector<char> is_kept(grid.n_unknowns, 0);
    for (const unsigned int i : grid.kept)
      is_kept[i] = 1;
    std::vector<unsigned int> others;
    for (unsigned int i = 0; i < grid.n_unknowns; ++i)
      if (is_used[i] != 0 && is_kept[i] == 0)
        others.push_back(i);

    const Eigen::LLT<Eigen::MatrixXd> factor(A(others, others));
    const Eigen::MatrixXd             mixed = A(others, grid.kept);
    const Eigen::MatrixXd             S =
      A(grid.kept, grid.kept) - mixed.transpose() * factor.solve(mixed);
    const Eigen::VectorXd f_others = f(others);
    const Eigen::VectorXd g =
      f(grid.kept) - mixed.transpose() * factor.solve(f_others);
    const double c_0 = constant - 0.5 * f_others.dot(factor.solve(f_others));
    const Eigen::VectorXd s =
      Eigen::VectorXd::LinSpaced(grid.kept.size(), -1., 2.);
    Eigen::VectorXd x              = Eigen::VectorXd::Zero(grid.n_unknowns);
    x(grid.kept)                   = s;
    const Eigen::VectorXd x_others = factor.solve(f_others - mixed * s);
    x(others)                      = x_others;
    return std::max({(condensed.schur_complement() - S).norm() / S.norm(),
                     (condensed.load() - g).norm() / g.norm(),
                     std::abs(condensed.energy_at_zero() / c_0 - 1.),
                     (condensed.expand(s) - x).norm() / x.norm()});
  }



  void
  test(const std::string &name, const Grid &grid)
  {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(grid.n_unknowns);
    for (const SubstructureElement &element : grid.elements)
      for (const unsigned int i : element.unknowns)
        f(i) = std::sin(1. + i);
    std::vector<double> weights(grid.elements.size(), 1.);
    for (unsigned int e = 0; e < weights.size(); ++e)
      if (grid.elements[e].has_weight)
        weights[e] = 1. - 0.8 * (e % 5) / 5.;

    std::cout << name << std::endl;
    Substructures substructures = grid.substructures();
    const auto    weighted      = substructures.condense(f, weights, 0.3);
    const auto    plain         = substructures.condense(f);
    const auto    again         = substructures.condense(f, weights, 0.3);
    check("  with weights", error(grid, *weighted, f, weights, 0.3), 1e-10);
    check("  without", error(grid, *plain, f, {}, 0.), 1e-10);
    check("  again", error(grid, *again, f, weights, 0.3), 1e-10);
  }



  void
  test_uniform()
  {
    const Grid            grid(64, 16, 1, 64, 0.5);
    const Eigen::VectorXd f = Eigen::VectorXd::Ones(grid.n_unknowns);
    Substructures         substructures = grid.substructures();
    substructures.condense(f);
    const unsigned int calls = grid.calls;
    std::cout << "64x16 equal squares: " << calls << " kinds, ";
    substructures.condense(f);
    std::cout << grid.calls - calls << " of them with weights" << std::endl;
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  test("one square", Grid(1, 1, 1, 1, 1.));
  test("two", Grid(2, 1, 1, 2, 1.));
  test("13x5 of one kind", Grid(13, 5, 1, 13, 1.));
  test("13x5 of three kinds", Grid(13, 5, 3, 13, 1.));
  // Equal squares are beside each other and one above the other.
  test("12x12 of one kind", Grid(12, 12, 1, 12, 1.));
  test("slender", Grid(30, 3, 2, 30, 100.));
  test("in two pieces", Grid(9, 4, 2, 4, 0.1));
  test_uniform();

  Grid bad(4, 3, 1, 4, 1.);
  bad.matrices[0](3, 3)       = -1.;
  Substructures substructures = bad.substructures();
  print_error(
    [&]() { substructures.condense(Eigen::VectorXd::Ones(bad.n_unknowns)); });
}
