// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_distributed_mesh_h
#define debond_mesh_distributed_mesh_h

#include <deal.II/base/mpi.h>

#include <debond/mesh/body.h>

namespace Debond
{
  /// The mesh of a body on several ranks, each of which has its own cells and
  /// those that share a vertex with them, the ghosts.
  template <int dim>
  struct DistributedMesh
  {
    /// On one rank the whole mesh, on several a
    /// dealii::parallel::fullydistributed::Triangulation. Each rank has own
    /// cells. Their order, and that of the vertices in them, is the one of the
    /// whole mesh, and cell->id().get_coarse_cell_id() the active_cell_index()
    /// that a cell has there. Ghosts have material ids, but boundary ids are
    /// known of own cells only: where the ghosts end, faces have the id 0.
    std::unique_ptr<dealii::Triangulation<dim>> triangulation;

    PieceNames names; ///< on all ranks those of the whole mesh
  };



  /**
   * The mesh that body.make_mesh() makes, shared out. Collective.
   *
   * Each rank makes its part of a box, layers of cells across the direction
   * with the most of them, if there are as many layers as ranks. The mesh of
   * other bodies, and of boxes that have Body::parts, is made by the first rank
   * alone and partitioned by METIS.
   *
   * Exceptions of make_mesh() are thrown as on_all_ranks() does. Throws
   * std::invalid_argument on all ranks if there are more of them than cells.
   */
  template <int dim>
  DistributedMesh<dim>
  make_distributed_mesh(const Body<dim> &body, const MPI_Comm ranks);
} // namespace Debond

#endif
