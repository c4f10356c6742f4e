// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/elasticity/constrained_dofs.h>
#include <debond/elasticity/contact_frame.h>

#include <cmath>

namespace Debond
{
  template <int dim>
  void
  ConstrainedDofs<dim>::constrain(const PrescribedNode<dim> &node)
  {
    const unsigned int first = dim * node.node;
    if (node.rows.empty() || !done.insert(node.node).second)
      return;

    // A frame is needed only if some unknowns are constrained along directions
    // that are no axes. Along the axes the unknowns stay Cartesian, and so they
    // do if nothing is unknown.
    const auto axis = [](const auto &row) {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(row.direction[d]) == 1.)
          return d;
      return static_cast<unsigned int>(dim);
    };
    // Normals along the axes have been cleared of rounding, so that the
    // comparison with 1 may be exact.
    const bool are_axes =
      std::all_of(node.rows.begin(), node.rows.end(), [&](const auto &row) {
        return axis(row) < dim;
      });
    if (node.rows.size() < dim && !are_axes)
      {
        add_frame(node, {}, false);
        return;
      }
    for (const auto &row : node.rows)
      held.push_back({node.position, row.direction, node.node});
    if (node.rows.size() == dim)
      {
        // All components are prescribed, whatever the directions of the
        // supports are: the displacement is put together from the rows, and
        // each component counts as borne by the support whose direction is
        // nearest to its axis.
        const dealii::Tensor<1, dim> displacement = node.displacement();
        for (unsigned int d = 0; d < dim; ++d)
          {
            unsigned int bearing = 0;
            for (unsigned int k = 1; k < dim; ++k)
              if (std::abs(node.rows[k].direction[d]) >
                  std::abs(node.rows[bearing].direction[d]))
                bearing = k;
            constrain(first + d, displacement[d], node.rows[bearing].support);
          }
      }
    else
      for (const auto &row : node.rows)
        {
          const unsigned int d = axis(row);
          // The direction may be against the axis, hence the sign.
          constrain(first + d, row.direction[d] * row.value, row.support);
        }
  }



  template <int dim>
  void
  ConstrainedDofs<dim>::add_frame(
    const PrescribedNode<dim>                 &node,
    const std::vector<dealii::Tensor<1, dim>> &free_directions,
    const bool                                 fixes_rest)
  {
    // The rows of the frame are the directions of the node's unknowns: first
    // the free ones, which at contact nodes are the normals, then the
    // prescribed ones, and then what contact_frame() adds to make a basis.
    // Several normals of a node need not be orthogonal, therefore u is found
    // with the inverse of the frame.
    std::vector<dealii::Tensor<1, dim>> directions = free_directions;
    for (const auto &row : node.rows)
      directions.push_back(row.direction);
    const dealii::Tensor<2, dim> to_frame = contact_frame(directions);
    node_frames.push_back({node.node, dealii::invert(to_frame), to_frame});
    done.insert(node.node);

    const unsigned int first = dim * node.node;
    unsigned int       k = static_cast<unsigned int>(free_directions.size());
    for (const auto &row : node.rows)
      {
        constrain(first + k++, row.value, row.support);
        held.push_back({node.position, row.direction, node.node});
      }
    if (fixes_rest)
      for (; k < dim; ++k)
        {
          // No support bears what is fixed by u_tau = 0: it is the foundation
          // that does, or the other body.
          constrain(first + k, 0., dealii::numbers::invalid_unsigned_int);
          held.push_back({node.position, to_frame[k], node.node});
        }
  }



  template <int dim>
  std::vector<Support<dim>>
  ConstrainedDofs<dim>::finish(const NodeSupports<dim> &supports)
  {
    // Contact nodes have been done with their frames already, and constrain()
    // leaves them as they are.
    for (const auto &[unused, node] : supports.all())
      constrain(node);
    // A support that prescribes zero is no reason to have a lifting: vectors of
    // zeros are released, which is how others know that there is none.
    for (DofVector *part : {&prescribed, &gap})
      if (part->size() > 0 && part->all_zero())
        part->reinit(0);
    fixed.close();
    done.clear();
    return std::move(held);
  }



  template <int dim>
  void
  ConstrainedDofs<dim>::constrain(const dealii::types::global_dof_index dof,
                                  const double                          value,
                                  const unsigned int                    support)
  {
    // The constraints are homogeneous, x_dof = 0, since all vectors are w in u
    // = w + G. The value goes into the lifting G.
    fixed.add_line(dof);
    if (value != 0.)
      prescribed(dof) = value;
    if (support != dealii::numbers::invalid_unsigned_int)
      supported_dofs.push_back({dof, support});
  }



  DEBOND_INSTANTIATE_CLASS(ConstrainedDofs);
} // namespace Debond
