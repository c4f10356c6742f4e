// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_nodes_h
#define debond_elasticity_contact_nodes_h

#include <debond/base/dof_vector.h>
#include <debond/elasticity/boundary_conditions.h>
#include <debond/elasticity/boundary_face.h>
#include <debond/elasticity/contact_space.h>
#include <debond/elasticity/node_supports.h>

#include <vector>

namespace Debond
{
  /// The contact space of the faces of the contact boundary. Its nodes, where a
  /// normal displacement is unknown, get frames in @p node_supports, and what
  /// is tangential is constrained there where it has to be; other nodes of the
  /// faces are vertices that are held. Their order is the lexicographic one of
  /// their positions. @p gap gets the gaps at normal displacements; it has no
  /// entries if @p supports have no gaps. Throws SupportError if a gap is
  /// negative or not finite or if too much is prescribed at a node, and what
  /// contact_frame() does.
  template <int dim>
  ContactSpace<dim>
  make_contact_space(const std::vector<BoundaryFace<dim>> &faces,
                     const unsigned int                    degree,
                     const BoundaryConditions             &conditions,
                     const Supports<dim>                  &supports,
                     NodeSupports<dim>                    &node_supports,
                     DofVector                            &gap);
} // namespace Debond

#endif
