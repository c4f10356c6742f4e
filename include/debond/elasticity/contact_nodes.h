// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_nodes_h
#define debond_elasticity_contact_nodes_h

#include <debond/elasticity/constrained_dofs.h>
#include <debond/elasticity/contact_space.h>

namespace Debond
{
  /// The contact space of the faces of the contact boundary. Its nodes, where a
  /// normal displacement is unknown, get frames and gaps in @p constrained, and
  /// what is tangential is constrained there where it has to be; other nodes of
  /// the faces are vertices that are held. Their order is the lexicographic one
  /// of their positions. Throws SupportError if a gap is negative or not finite
  /// or if too much is prescribed at a node, and what contact_frame() does.
  template <int dim>
  ContactSpace<dim>
  make_contact_space(const std::vector<BoundaryFace<dim>> &faces,
                     const unsigned int                    degree,
                     const BoundaryConditions             &conditions,
                     const Supports<dim>                  &supports,
                     const NodeSupports<dim>              &node_supports,
                     ConstrainedDofs<dim>                 &constrained);
} // namespace Debond

#endif
