// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/node_supports.h>
#include <debond/mesh/field_value.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace Debond
{
  namespace
  {
    /// What the clamp of a face is called: the widest piece that is clamped as
    /// a whole.
    std::string
    clamp_name(const BoundaryConditions        &conditions,
               const dealii::types::boundary_id id)
    {
      std::string name = boundary_name(conditions.names, id);
      std::size_t size = 0;
      for (const auto &[piece, ids] : conditions.names)
        if (ids.count(id) > 0 && ids.size() > size &&
            std::includes(conditions.clamped.begin(),
                          conditions.clamped.end(),
                          ids.begin(),
                          ids.end()))
          {
            name = piece;
            size = ids.size();
          }
      return name;
    }
  } // namespace



  template <int dim>
  dealii::Tensor<1, dim>
  PrescribedNode<dim>::displacement() const
  {
    dealii::Tensor<1, dim> displacement;
    for (const Row &row : rows)
      displacement += row.value * row.direction;
    return displacement;
  }



  template <int dim>
  void
  PrescribedNode<dim>::fix_rest()
  {
    while (rows.size() < dim)
      {
        dealii::Tensor<1, dim> best;
        for (unsigned int d = 0; d < dim; ++d)
          {
            dealii::Tensor<1, dim> rest = dealii::Point<dim>::unit_vector(d);
            for (const Row &row : rows)
              rest -= row.direction[d] * row.direction;
            if (rest.norm() > best.norm())
              best = rest;
          }
        rows.push_back(
          {best / best.norm(), 0., dealii::numbers::invalid_unsigned_int});
      }
  }



  template <int dim>
  void
  NodeSupports<dim>::clamp(const std::vector<BoundaryFace<dim>> &faces,
                           const BoundaryConditions             &conditions)
  {
    std::map<std::string, unsigned int> numbers;
    for (const BoundaryFace<dim> &face : faces)
      {
        const auto [entry, is_new] =
          numbers.emplace(clamp_name(conditions, face.id),
                          static_cast<unsigned int>(support_names.size()));
        if (is_new)
          support_names.push_back(entry->first);
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          if (!fixed.is_constrained(face.dofs[n][0]))
            for (unsigned int d = 0; d < dim; ++d)
              {
                constrain(face.dofs[n][d], 0., entry->second);
                held.push_back({face.positions[n],
                                dealii::Point<dim>::unit_vector(d),
                                face.indices[n]});
              }
      }
  }



  template <int dim>
  void
  NodeSupports<dim>::constrain(const dealii::types::global_dof_index dof,
                               const double                          value,
                               const unsigned int                    support)
  {
    fixed.add_line(dof);
    if (value != 0.)
      prescribed(dof) = value;
    if (support != dealii::numbers::invalid_unsigned_int)
      supported_dofs.push_back({dof, support});
  }



  template <int dim>
  void
  NodeSupports<dim>::prescribe(const std::vector<BoundaryFace<dim>> &faces,
                               const PrescribedDisplacement<dim>    &condition,
                               const BoundaryConditions             &conditions,
                               const EdgeCoefficients<dim>          &edges)
  {
    const auto fail = [&](const std::string &message) {
      throw SupportError(condition.is_roller ?
                           SupportError::Subject::roller :
                           SupportError::Subject::displacement,
                         condition.name,
                         message);
    };
    // Of the unknown of a face's node.
    const auto prescribed_value = [&](const BoundaryFace<dim> &face,
                                      const unsigned int       node,
                                      const unsigned int       d) {
      if (condition.values == nullptr)
        return 0.;
      const auto value = [&](const unsigned int n) {
        return field_value(*condition.values, face.positions[n], d);
      };
      try
        {
          if (edges.find(face.indices[node]) == nullptr)
            return value(node);
          const auto &[a, b] = simplex_edges[node - dim];
          return 2. * value(node) - 0.5 * (value(a) + value(b));
        }
      catch (const std::invalid_argument &error)
        {
          fail(error.what());
          return 0.;
        }
    };
    const unsigned int support =
      static_cast<unsigned int>(support_names.size());
    support_names.push_back(condition.name);

    std::vector<bool> is_done(frame_of_node.size(), false);
    for (const BoundaryFace<dim> &face : faces)
      {
        if (condition.is_roller &&
            (face.normal - faces[0].normal).norm() > Tolerance::same_normal)
          fail("a roller is flat, but the normals of " + condition.name +
               " differ: prescribe components by Displacement " +
               condition.name);
        // What of the normal is not prescribed.
        double free_part = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          if (!condition.is_roller && !condition.components[d])
            free_part = std::max(free_part, std::abs(face.normal[d]));
        if (conditions.contact.count(face.id) > 0 &&
            free_part <= Tolerance::same_normal)
          fail(condition.name +
               " is a contact boundary, whose normal displacement is left to "
               "the foundation and cannot be prescribed");

        for (unsigned int v = 0; v < face.n_nodes; ++v)
          {
            if (is_done[face.indices[v]])
              continue;
            is_done[face.indices[v]] = true;
            std::vector<Row> rows;
            if (condition.is_roller)
              {
                // Sides along the axes have exact normals.
                dealii::Tensor<1, dim> normal = faces[0].normal;
                for (unsigned int d = 0; d < dim; ++d)
                  if (std::abs(normal[d]) < Tolerance::zero_in_normal)
                    normal[d] = 0.;
                rows.push_back({normal / normal.norm(), 0., support});
              }
            else
              for (unsigned int d = 0; d < dim; ++d)
                if (condition.components[d])
                  rows.push_back({dealii::Point<dim>::unit_vector(d),
                                  prescribed_value(face, v, d),
                                  support});
            if (fixed.is_constrained(face.dofs[v][0]))
              {
                for (const Row &row : rows)
                  if (row.value != 0.)
                    fail("the displacement at " +
                         point_text(face.positions[v]) +
                         " is prescribed, but the vertex is clamped: leave its "
                         "side out of Clamped boundaries");
                continue;
              }

            PrescribedNode<dim> &vertex = prescribed_nodes[face.indices[v]];
            vertex.dofs                 = face.dofs[v];
            vertex.position             = face.positions[v];
            for (Row row : rows)
              {
                const double value = row.value;
                double       size  = std::abs(value);
                for (const Row &other : vertex.rows)
                  {
                    const double part = row.direction * other.direction;
                    row.direction -= part * other.direction;
                    row.value -= part * other.value;
                    size = std::max(size, std::abs(other.value));
                  }
                const double length = row.direction.norm();
                if (length > Tolerance::same_normal)
                  {
                    row.direction /= length;
                    row.value /= length;
                    vertex.rows.push_back(row);
                  }
                else if (std::abs(row.value) > Tolerance::same_normal * size)
                  fail("the displacement at " + point_text(vertex.position) +
                       " is prescribed otherwise by " +
                       support_names[vertex.rows[0].support]);
              }
          }
      }
  }



  template <int dim>
  void
  NodeSupports<dim>::glue(NodePairs<dim> &pairs)
  {
    const auto directions = [this](const unsigned int node) {
      std::vector<dealii::Tensor<1, dim>> result;
      if (fixed.is_constrained(dim * node))
        for (unsigned int d = 0; d < dim; ++d)
          result.push_back(dealii::Point<dim>::unit_vector(d));
      else if (const auto entry = prescribed_nodes.find(node);
               entry != prescribed_nodes.end())
        for (const Row &row : entry->second.rows)
          result.push_back(row.direction);
      return result;
    };
    const auto is_within = [](const auto &some, const auto &others) {
      for (dealii::Tensor<1, dim> rest : some)
        {
          for (const dealii::Tensor<1, dim> &other : others)
            rest -= (rest * other) * other;
          if (rest.norm() > Tolerance::same_normal)
            return false;
        }
      return true;
    };
    ends_of_interfaces = pairs.ends();
    for (unsigned int k = 0; k < pairs.all().size(); ++k)
      {
        auto       pair   = pairs.all()[k];
        const auto first  = directions(pair.first),
                   second = directions(pair.second);
        // Of a clamped first node the second one is clamped, too.
        const auto is_clamped = [this](const unsigned int node) {
          return fixed.is_constrained(dim * node);
        };
        if (!is_within(first, second) ||
            (is_clamped(pair.first) && !is_clamped(pair.second)))
          {
            if (!is_within(second, first))
              throw std::invalid_argument(
                "supports hold both bodies along different directions where "
                "they are glued to each other, at " +
                point_text(prescribed_nodes.at(pair.first).position) +
                ": hold one of them as far as the other one there");
            pairs.exchange(pair);
            pair = pairs.all()[k];
          }
        if (prescribed.size() == 0)
          continue;
        const auto support_of = [&](const unsigned int node) {
          if (const auto entry = prescribed_nodes.find(node);
              entry != prescribed_nodes.end())
            return entry->second.rows[0].support;
          for (const auto &[dof, support] : supported_dofs)
            if (dof == dim * node)
              return support;
          return dealii::numbers::invalid_unsigned_int;
        };
        if (!first.empty() && !second.empty())
          {
            auto &both = glued_supports[pair.first];
            both       = {{support_of(pair.first), support_of(pair.second)}};
            if (pair.sign < 0.)
              std::swap(both[0], both[1]);
          }
        const auto of_second           = prescribed_nodes.find(pair.second);
        const dealii::Tensor<1, dim> u = of_second == prescribed_nodes.end() ?
                                           dealii::Tensor<1, dim>() :
                                           of_second->second.displacement();
        if (const auto own = prescribed_nodes.find(pair.first);
            own != prescribed_nodes.end())
          for (Row &row : own->second.rows)
            row.value = pair.sign * (row.value - row.direction * u);
      }
  }



  template <int dim>
  PrescribedNode<dim>
  NodeSupports<dim>::prescribed_at(const unsigned int        index,
                                   const NodeDofs<dim>      &node_dofs,
                                   const dealii::Point<dim> &position) const
  {
    const auto entry = prescribed_nodes.find(index);
    return entry == prescribed_nodes.end() ?
             PrescribedNode<dim>{node_dofs, position, {}} :
             entry->second;
  }



  template <int dim>
  void
  NodeSupports<dim>::constrain(const unsigned int         index,
                               const PrescribedNode<dim> &node)
  {
    if (node.rows.empty() || fixed.is_constrained(node.dofs[0]) ||
        frame(index) != nullptr)
      return;

    // Along the axes the unknowns stay Cartesian, and so they do if nothing is
    // unknown.
    const auto axis = [](const Row &row) {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::abs(row.direction[d]) == 1.)
          return d;
      return static_cast<unsigned int>(dim);
    };
    const bool are_axes =
      std::all_of(node.rows.begin(), node.rows.end(), [&](const Row &row) {
        return axis(row) < dim;
      });
    if (node.rows.size() < dim && !are_axes)
      {
        add_frame(index, node, {}, false);
        return;
      }
    for (const Row &row : node.rows)
      held.push_back({node.position, row.direction, index});
    if (node.rows.size() == dim)
      {
        const dealii::Tensor<1, dim> displacement = node.displacement();
        for (unsigned int d = 0; d < dim; ++d)
          {
            unsigned int bearing = 0;
            for (unsigned int k = 1; k < dim; ++k)
              if (std::abs(node.rows[k].direction[d]) >
                  std::abs(node.rows[bearing].direction[d]))
                bearing = k;
            constrain(node.dofs[d],
                      displacement[d],
                      node.rows[bearing].support);
          }
      }
    else
      for (const Row &row : node.rows)
        {
          const unsigned int d = axis(row);
          constrain(node.dofs[d], row.direction[d] * row.value, row.support);
        }
  }



  template <int dim>
  void
  NodeSupports<dim>::add_frame(
    const unsigned int                         index,
    const PrescribedNode<dim>                 &node,
    const std::vector<dealii::Tensor<1, dim>> &free_directions,
    const bool                                 fixes_rest)
  {
    std::vector<dealii::Tensor<1, dim>> directions = free_directions;
    for (const Row &row : node.rows)
      directions.push_back(row.direction);
    DisplacementFrame<dim> frame;
    frame.dofs           = node.dofs;
    frame.to_frame       = contact_frame(directions);
    frame.to_cartesian   = dealii::invert(frame.to_frame);
    frame_of_node[index] = static_cast<unsigned int>(node_frames.size());
    node_frames.push_back(frame);

    unsigned int k = static_cast<unsigned int>(free_directions.size());
    for (const Row &row : node.rows)
      {
        constrain(node.dofs[k++], row.value, row.support);
        held.push_back({node.position, row.direction, index});
      }
    if (fixes_rest)
      for (; k < dim; ++k)
        {
          constrain(node.dofs[k], 0., dealii::numbers::invalid_unsigned_int);
          held.push_back({node.position, frame.to_frame[k], index});
        }
  }



  template <int dim>
  std::vector<Support<dim>>
  NodeSupports<dim>::finish()
  {
    for (const auto &[index, node] : prescribed_nodes)
      constrain(index, node);
    prescribed_nodes.clear();
    if (prescribed.size() > 0 && prescribed.all_zero())
      prescribed.reinit(0);
    fixed.close();
    return std::move(held);
  }



  template <int dim>
  const DisplacementFrame<dim> *
  NodeSupports<dim>::frame(const unsigned int index) const
  {
    const unsigned int number = frame_of_node[index];
    return number == dealii::numbers::invalid_unsigned_int ?
             nullptr :
             &node_frames[number];
  }



  template struct PrescribedNode<2>;
  template struct PrescribedNode<3>;
  template class NodeSupports<2>;
  template class NodeSupports<3>;
} // namespace Debond
