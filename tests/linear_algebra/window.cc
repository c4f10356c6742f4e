// SPDX-License-Identifier: LGPL-2.1-or-later
// What a window says of the energy of some unknowns is how the energy of all
// changes with them, and it holds the unknowns that it should.

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <debond/linear_algebra/window.h>

#include <cmath>
#include <iostream>
#include <set>

#include "../check.h"

using namespace Debond;

namespace
{
  using Vector = DofVector;

  constexpr unsigned int n = 12; ///< nodes in each direction



  double
  energy(const dealii::SparseMatrix<double> &A,
         const Vector                       &f,
         const Vector                       &u)
  {
    const double work = f * u;
    return 0.5 * A.matrix_norm_square(u) - work;
  }



  void
  test(const unsigned int            center,
       const unsigned int            n_rings,
       const std::set<unsigned int> &excluded)
  {
    dealii::DynamicSparsityPattern dynamic(n * n);
    for (unsigned int i = 0; i < n * n; ++i)
      {
        dynamic.add(i, i);
        for (const unsigned int j : {i + 1, i + n})
          if (j < n * n && (j != i + 1 || j % n != 0))
            {
              dynamic.add(i, j);
              dynamic.add(j, i);
            }
      }
    dealii::SparsityPattern sparsity;
    sparsity.copy_from(dynamic);
    dealii::SparseMatrix<double> A(sparsity);
    for (unsigned int i = 0; i < n * n; ++i)
      for (auto entry = A.begin(i); entry != A.end(i); ++entry)
        {
          const unsigned int j = entry->column();
          entry->value() =
            i == j ? 9. + std::sin(i) : std::cos(double(i + j) + 1.);
        }
    Vector f(n * n), u(n * n);
    for (unsigned int i = 0; i < n * n; ++i)
      {
        f(i) = std::sin(7. * i + 1.);
        u(i) = std::cos(3. * i);
      }

    const Window window(A, f, u, center, n_rings, [&](const unsigned int i) {
      return excluded.count(i) > 0;
    });
    std::cout << window.unknowns().size()
              << (window.is_everything() ? ", everything" : "") << std::endl;

    // Nodes in between may be excluded, so that the way is longer.
    std::set<unsigned int> expected = {center};
    for (unsigned int k = 0; k < n_rings; ++k)
      {
        const std::set<unsigned int> before = expected;
        for (unsigned int i = 0; i < n * n; ++i)
          for (const unsigned int j : before)
            if (std::abs(int(i / n) - int(j / n)) +
                    std::abs(int(i % n) - int(j % n)) ==
                  1 &&
                excluded.count(i) == 0)
              expected.insert(i);
      }
    check("  unknowns that should be others",
          std::vector<unsigned int>(expected.begin(), expected.end()) ==
              window.unknowns() ?
            0. :
            1.,
          0.);

    Vector moved = u, v(window.unknowns().size()), w(v.size());
    for (unsigned int k = 0; k < v.size(); ++k)
      {
        v(k)                        = u(window.unknowns()[k]);
        w(k)                        = std::sin(5. * k);
        moved(window.unknowns()[k]) = w(k);
      }
    const double change = energy(A, f, moved) - energy(A, f, u);
    check("  error of the change of the energy, relative",
          std::abs((energy(window.matrix(), window.load(), w) -
                    energy(window.matrix(), window.load(), v)) /
                     change -
                   1.),
          1e-13);
  }
} // namespace



int
main()
{
  test(5 * n + 5, 3, {});
  test(0, 4, {1, 2 * n});
  test(n + 1, 2 * n, {});
}
