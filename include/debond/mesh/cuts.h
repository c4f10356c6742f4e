// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_cuts_h
#define debond_mesh_cuts_h

#include <debond/mesh/body.h>

namespace Debond
{
  /// Cuts @p mesh into bodies that have vertices of their own along the cuts;
  /// its cells keep their order. The sides of a cut NAME are the boundaries
  /// NAME_low and NAME_high, both together NAME; those of a cut along a group
  /// have its name too, unless there are such boundaries. Where a cut ends
  /// inside the mesh its last vertices are those of both sides. Throws
  /// std::invalid_argument as faces_of_group() does, if a cut has no faces or
  /// opens nowhere, and if more than two bodies meet in a point.
  template <int dim>
  PieceNames
  cut_into_bodies(const std::vector<Cut<dim>> &cuts,
                  const PieceNames            &before,
                  dealii::Triangulation<dim>  &mesh);
} // namespace Debond

#endif
