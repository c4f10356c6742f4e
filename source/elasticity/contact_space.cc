// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/contact_space.h>

namespace Debond
{
  template <int dim>
  ContactSpace<dim>::ContactSpace(
    const ContactBoundary<dim>                         &boundary,
    const std::vector<dealii::types::global_dof_index> &dofs)
    : nodes_and_faces(boundary)
    , all_dofs(dofs)
    // The normal displacements of all nodes come first in s, tangents follow.
    , normals(dofs.begin(), dofs.begin() + boundary.nodes.size())
  {
    AssertDimension(boundary.n_unknowns(), dofs.size());
  }



  template <int dim>
  Eigen::VectorXd
  ContactSpace<dim>::trace(const DofVector &u) const
  {
    // N' picks entries of u, as each component of s is an unknown of its own.
    // So the trace has no rounding and needs no matrix.
    Eigen::VectorXd s(size());
    for (unsigned int i = 0; i < size(); ++i)
      s(i) = u(all_dofs[i]);
    return s;
  }



  template <int dim>
  void
  ContactSpace<dim>::add(const VectorView &s, DofVector &u) const
  {
    for (unsigned int i = 0; i < size(); ++i)
      u(all_dofs[i]) += s(i);
  }



  template <int dim>
  bool
  ContactSpace<dim>::is_admissible(const DofVector &u) const
  {
    // The gap is part of the lifting, so that the bound is zero for all nodes.
    // The comparison is exact, without a tolerance.
    return std::all_of(normals.begin(),
                       normals.end(),
                       [&u](const dealii::types::global_dof_index normal) {
                         return u(normal) <= 0.;
                       });
  }



  template <int dim>
  Eigen::VectorXd
  ContactSpace<dim>::at_rest() const
  {
    // At rest u = 0 and s = -g. A press fit, g < 0, has no body at rest that is
    // admissible; it begins in contact.
    Eigen::VectorXd s = Eigen::VectorXd::Zero(size());
    for (unsigned int i = 0; i < nodes_and_faces.nodes.size(); ++i)
      s(i) = std::min(0., -nodes_and_faces.nodes[i].gap);
    return s;
  }



  DEBOND_INSTANTIATE_CLASS(ContactSpace);
} // namespace Debond
