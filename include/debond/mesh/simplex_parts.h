// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_simplex_parts_h
#define debond_mesh_simplex_parts_h

#include <deal.II/base/point.h>

#include <array>

namespace Debond
{
  /// Calls the function with the corners of each of the n^dim equal parts of
  /// the reference interval or triangle, @p n in each direction.
  template <int dim, typename Function>
  void
  for_each_part(const unsigned int n, const Function &function)
  {
    static_assert(dim == 1 || dim == 2);
    // A part with its corner here, its legs along the axes or against them.
    const auto part =
      [&](const unsigned int x, const unsigned int y, const double leg) {
        std::array<dealii::Point<dim>, dim + 1> corners;
        for (unsigned int k = 0; k <= dim; ++k)
          {
            corners[k][dim - 1] = (y + (k == 2 ? leg : 0.)) / n;
            corners[k][0]       = (x + (k == 1 ? leg : 0.)) / n;
          }
        function(corners);
      };
    for (unsigned int x = 0; x < n; ++x)
      for (unsigned int y = 0; y < (dim == 1 ? 1 : n - x); ++y)
        {
          part(x, y, 1.);
          if (dim == 2 && x + y + 1 < n)
            part(x + 1, y + 1, -1.);
        }
  }
} // namespace Debond

#endif
