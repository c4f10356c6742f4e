// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_parts_h
#define debond_mesh_parts_h

#include <debond/mesh/body.h>

namespace Debond
{
  /// Gives the faces and cells of @p mesh that are in parts ids of their own.
  /// Returns the @p names with those of the parts, and notes on parts whose
  /// edge cuts faces or cells. Throws EntryError if a part has no face (no
  /// cell).
  template <int dim>
  PieceNames
  name_parts(const std::vector<Part<dim>> &parts,
             const PieceNames             &names,
             dealii::Triangulation<dim>   &mesh);
} // namespace Debond

#endif
