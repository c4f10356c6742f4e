// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/edge_coefficients.h>

namespace Debond
{
  template <int dim>
  EdgeCoefficients<dim>::EdgeCoefficients(
    const dealii::DoFHandler<dim>              &dof_handler,
    const std::set<dealii::types::boundary_id> &contact)
  {
    if (dof_handler.get_fe().degree == 1)
      return;
    number_of_node.assign(dof_handler.n_dofs() / dim,
                          dealii::numbers::invalid_unsigned_int);
    const auto add = [&](const auto &line) {
      const unsigned int middle = line->dof_index(0) / dim;
      if (find(middle) != nullptr)
        return;
      number_of_node[middle] = static_cast<unsigned int>(edges.size());
      edges.push_back({middle, {}});
      for (unsigned int v = 0; v < 2; ++v)
        edges.back().ends[v] = line->vertex_dof_index(v, 0) / dim;
    };
    for (const auto &cell : dof_handler.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && contact.count(face->boundary_id()) > 0)
          {
            if constexpr (dim == 2)
              add(face);
            else
              for (unsigned int l = 0; l < face->n_lines(); ++l)
                add(face->line(l));
          }
  }



  template class EdgeCoefficients<2>;
  template class EdgeCoefficients<3>;
} // namespace Debond
