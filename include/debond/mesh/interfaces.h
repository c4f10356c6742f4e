// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_interfaces_h
#define debond_mesh_interfaces_h

#include <debond/mesh/body.h>

namespace Debond
{
  /// Names the sides of interfaces between bodies that have no cells in common:
  /// NAME_high and NAME_low, both together NAME. Throws EntryError if sides
  /// share faces, or if regions do not lie on each other.
  template <int dim>
  PieceNames
  name_interfaces(const std::vector<Interface> &interfaces,
                  PieceNames                    names,
                  dealii::Triangulation<dim>   &mesh);
} // namespace Debond

#endif
