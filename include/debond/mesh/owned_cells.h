// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_owned_cells_h
#define debond_mesh_owned_cells_h

#include <deal.II/grid/filtered_iterator.h>

namespace Debond
{
  /// The active cells of a triangulation or a DoFHandler that belong to this
  /// rank: each cell of the mesh is one of one rank.
  template <typename Mesh>
  auto
  owned_cells(const Mesh &mesh)
  {
    return dealii::filter_iterators(
      mesh.active_cell_iterators(),
      dealii::IteratorFilters::LocallyOwnedCell());
  }
} // namespace Debond

#endif
