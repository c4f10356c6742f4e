// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/contact_space.h>

#include <algorithm>

namespace Debond
{
  template <int dim>
  ContactSpace<dim>::ContactSpace(
    const ContactBoundary<dim>                         &boundary,
    const std::vector<dealii::types::global_dof_index> &normals)
    : nodes_and_faces(boundary)
    , dofs(normals)
  {
    AssertDimension(boundary.nodes.size(), normals.size());
  }



  template <int dim>
  unsigned int
  ContactSpace<dim>::size() const
  {
    return static_cast<unsigned int>(dofs.size());
  }



  template <int dim>
  Eigen::VectorXd
  ContactSpace<dim>::trace(const DofVector &u) const
  {
    Eigen::VectorXd s(size());
    for (unsigned int i = 0; i < size(); ++i)
      s(i) = u(dofs[i]);
    return s;
  }



  template <int dim>
  void
  ContactSpace<dim>::add_normal(const VectorView &s, DofVector &u) const
  {
    for (unsigned int i = 0; i < size(); ++i)
      u(dofs[i]) += s(i);
  }



  template <int dim>
  bool
  ContactSpace<dim>::is_admissible(const DofVector &u) const
  {
    return std::all_of(dofs.begin(),
                       dofs.end(),
                       [&u](const dealii::types::global_dof_index normal) {
                         return u(normal) <= 0.;
                       });
  }



  template <int dim>
  Eigen::VectorXd
  ContactSpace<dim>::at_rest() const
  {
    Eigen::VectorXd s(size());
    for (unsigned int i = 0; i < size(); ++i)
      s(i) = std::min(0., -nodes_and_faces.nodes[i].gap);
    return s;
  }



  template class ContactSpace<2>;
  template class ContactSpace<3>;
} // namespace Debond
