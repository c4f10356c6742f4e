// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_space_h
#define debond_elasticity_contact_space_h

#include <deal.II/base/types.h>

#include <debond/base/dof_vector.h>
#include <debond/base/views.h>
#include <debond/contact/boundary.h>
#include <debond/optimization/bundle/direction_problem.h>

#include <vector>

namespace Debond
{
  /**
   * The normal displacements s of the contact nodes, counted from where they
   * touch the foundation, within the vector of all unknowns u: s = N'u, where
   * each node's normal displacement is an unknown of its own. Who reads or
   * writes u at contact nodes does it here.
   */
  template <int dim>
  class ContactSpace
  {
  public:
    ContactSpace() = default;

    /// @p normals: the degrees of freedom of the normal displacements, in the
    /// order of the nodes.
    ContactSpace(const ContactBoundary<dim>                         &boundary,
                 const std::vector<dealii::types::global_dof_index> &normals);

    const ContactBoundary<dim> &
    boundary() const
    {
      return nodes_and_faces;
    }

    /// The number of nodes.
    unsigned int
    size() const;

    /// The degrees of freedom of s.
    const std::vector<dealii::types::global_dof_index> &
    normal_dofs() const
    {
      return dofs;
    }

    /// s = N'u.
    Eigen::VectorXd
    trace(const DofVector &u) const;

    /// u += N s.
    void
    add_normal(const VectorView &s, DofVector &u) const;

    /// The unilateral constraint as bounds on degrees of freedom.
    UpperBounds
    bounds() const
    {
      const Eigen::VectorXd upper = nodes_and_faces.upper_bounds();
      return {{dofs.begin(), dofs.end()}, {upper.begin(), upper.end()}};
    }

    /// Returns whether u satisfies them.
    bool
    is_admissible(const DofVector &u) const;

    /// s of the body at rest, where u = 0: minus the gaps, but zero where these
    /// are negative.
    Eigen::VectorXd
    at_rest() const;

  private:
    ContactBoundary<dim>                         nodes_and_faces;
    std::vector<dealii::types::global_dof_index> dofs;
  };
} // namespace Debond

#endif
