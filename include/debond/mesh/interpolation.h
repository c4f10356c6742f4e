// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_interpolation_h
#define debond_mesh_interpolation_h

#include <cstddef>
#include <vector>

namespace Debond
{
  /// Values at points as means of values at nodes: of those with the numbers
  /// nodes[k], starts[i] <= k < starts[i + 1], for the point i. Weights are >=
  /// 0 with the sum 1.
  struct Interpolation
  {
    unsigned int              n_nodes = 0;
    std::vector<std::size_t>  starts  = {0};
    std::vector<unsigned int> nodes;
    std::vector<float>        weights;

    unsigned int
    n_points() const
    {
      return static_cast<unsigned int>(starts.size()) - 1;
    }
  };
} // namespace Debond

#endif
