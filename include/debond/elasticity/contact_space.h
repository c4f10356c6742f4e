// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_contact_space_h
#define debond_elasticity_contact_space_h

#include <debond/base/views.h>
#include <debond/contact/boundary.h>
#include <debond/optimization/bundle/direction_problem.h>

namespace Debond
{
  /**
   * The normal displacements s of the contact nodes, counted from where they
   * touch the foundation, within the vector of all unknowns u: s = N'u, where
   * each node's normal displacement is an unknown of its own. Where bonds shear
   * the displacements along tangents follow them in s, see
   * ContactBoundary::n_unknowns(). Who reads or writes u at contact nodes does
   * it here.
   */
  template <int dim>
  class ContactSpace
  {
  public:
    ContactSpace() = default;

    /// @p dofs: the degrees of freedom of s.
    ContactSpace(const ContactBoundary<dim>                         &boundary,
                 const std::vector<dealii::types::global_dof_index> &dofs);

    const ContactBoundary<dim> &
    boundary() const
    {
      return nodes_and_faces;
    }

    /// The number of components of s.
    unsigned int
    size() const
    {
      return static_cast<unsigned int>(all_dofs.size());
    }

    /// The degrees of freedom of s.
    const std::vector<dealii::types::global_dof_index> &
    dofs() const
    {
      return all_dofs;
    }

    /// Those of the normal displacements.
    const std::vector<dealii::types::global_dof_index> &
    normal_dofs() const
    {
      return normals;
    }

    /// s = N'u.
    Eigen::VectorXd
    trace(const DofVector &u) const;

    /// u += N s.
    void
    add(const VectorView &s, DofVector &u) const;

    /// Takes away from u what of s is above the bounds.
    void
    enforce_bounds(DofVector &u) const
    {
      add(-(trace(u) - nodes_and_faces.upper_bounds()).cwiseMax(0.), u);
    }

    /// The unilateral constraint as bounds on degrees of freedom.
    UpperBounds
    bounds() const
    {
      return {{normals.begin(), normals.end()},
              std::vector<double>(normals.size(), 0.)};
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
    std::vector<dealii::types::global_dof_index> all_dofs, normals;
  };
} // namespace Debond

#endif
