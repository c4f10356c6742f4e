// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/edge_coefficients.h>
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



    template <int dim>
    [[noreturn]] void
    fail(const PrescribedDisplacement<dim> &condition,
         const std::string                 &message)
    {
      throw SupportError(condition.is_roller ?
                           SupportError::Subject::roller :
                           SupportError::Subject::displacement,
                         condition.name,
                         message);
    }



    /// Throws if something is prescribed that a face cannot have. @p normal: of
    /// the first face of the piece.
    template <int dim>
    void
    check(const PrescribedDisplacement<dim> &condition,
          const BoundaryConditions          &conditions,
          const BoundaryFace<dim>           &face,
          const dealii::Tensor<1, dim>      &normal)
    {
      if (condition.is_roller &&
          (face.normal - normal).norm() > Tolerance::same_normal)
        fail(condition,
             "a roller is flat, but the normals of " + condition.name +
               " differ: prescribe components by Displacement " +
               condition.name);
      // What of the normal is not prescribed.
      double free_part = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        if (!condition.is_roller && !condition.components[d])
          free_part = std::max(free_part, std::abs(face.normal[d]));
      if (conditions.contact.count(face.id) > 0 &&
          free_part <= Tolerance::same_normal)
        fail(condition,
             condition.name +
               " is a contact boundary, whose normal displacement is left to "
               "the foundation and cannot be prescribed");
    }



    /// The prescribed component d of the unknown of a node of a face, a
    /// coefficient if @p is_coefficient.
    template <int dim>
    double
    prescribed_value(const PrescribedDisplacement<dim> &condition,
                     const BoundaryFace<dim>           &face,
                     const unsigned int                 node,
                     const bool                         is_coefficient,
                     const unsigned int                 d)
    {
      if (condition.values == nullptr)
        return 0.;
      const auto value = [&](const unsigned int n) {
        return field_value(*condition.values, face.positions[n], d);
      };
      try
        {
          return is_coefficient ? edge_coefficient<dim>(node, value) :
                                  value(node);
        }
      catch (const std::invalid_argument &error)
        {
          fail(condition, error.what());
        }
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
  bool
  PrescribedNode<dim>::add(Row row)
  {
    double size = std::abs(row.value);
    for (const Row &other : rows)
      {
        const double part = row.direction * other.direction;
        row.direction -= part * other.direction;
        row.value -= part * other.value;
        size = std::max(size, std::abs(other.value));
      }
    const double length = row.direction.norm();
    if (length <= Tolerance::same_normal)
      return std::abs(row.value) <= Tolerance::same_normal * size;
    row.direction /= length;
    row.value /= length;
    rows.push_back(row);
    return true;
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
          if (!fixed.is_constrained(dim * face.indices[n]))
            for (unsigned int d = 0; d < dim; ++d)
              {
                constrain(dim * face.indices[n] + d, 0., entry->second);
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
                               const ChangeOfBasis<dim>             &basis)
  {
    const auto support = static_cast<unsigned int>(support_names.size());
    support_names.push_back(condition.name);

    std::set<unsigned int> done;
    for (const BoundaryFace<dim> &face : faces)
      {
        check(condition, conditions, face, faces[0].normal);
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          {
            const unsigned int index = face.indices[n];
            if (!done.insert(index).second)
              continue;
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
                  rows.push_back(
                    {dealii::Point<dim>::unit_vector(d),
                     prescribed_value(condition,
                                      face,
                                      n,
                                      basis.find(BasisStep::coefficients,
                                                 index) != nullptr,
                                      d),
                     support});
            if (fixed.is_constrained(dim * index))
              {
                for (const Row &row : rows)
                  if (row.value != 0.)
                    fail(condition,
                         "the displacement at " +
                           point_text(face.positions[n]) +
                           " is prescribed, but the vertex is clamped: leave "
                           "its side out of Clamped boundaries");
                continue;
              }

            PrescribedNode<dim> &node = prescribed_nodes[index];
            node.node                 = index;
            node.position             = face.positions[n];
            for (const Row &row : rows)
              if (!node.add(row))
                fail(condition,
                     "the displacement at " + point_text(node.position) +
                       " is prescribed otherwise by " +
                       support_names[node.rows[0].support]);
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
                                   const dealii::Point<dim> &position) const
  {
    const auto entry = prescribed_nodes.find(index);
    return entry == prescribed_nodes.end() ?
             PrescribedNode<dim>{index, position, {}} :
             entry->second;
  }



  template <int dim>
  void
  NodeSupports<dim>::constrain(const PrescribedNode<dim> &node)
  {
    const unsigned int first = dim * node.node;
    if (node.rows.empty() || fixed.is_constrained(first) ||
        nodes_with_frames.count(node.node) > 0)
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
        add_frame(node, {}, false);
        return;
      }
    for (const Row &row : node.rows)
      held.push_back({node.position, row.direction, node.node});
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
            constrain(first + d, displacement[d], node.rows[bearing].support);
          }
      }
    else
      for (const Row &row : node.rows)
        {
          const unsigned int d = axis(row);
          constrain(first + d, row.direction[d] * row.value, row.support);
        }
  }



  template <int dim>
  void
  NodeSupports<dim>::add_frame(
    const PrescribedNode<dim>                 &node,
    const std::vector<dealii::Tensor<1, dim>> &free_directions,
    const bool                                 fixes_rest)
  {
    std::vector<dealii::Tensor<1, dim>> directions = free_directions;
    for (const Row &row : node.rows)
      directions.push_back(row.direction);
    const dealii::Tensor<2, dim> to_frame = contact_frame(directions);
    node_frames.push_back({node.node, dealii::invert(to_frame), to_frame});
    nodes_with_frames.insert(node.node);

    const unsigned int first = dim * node.node;
    unsigned int       k = static_cast<unsigned int>(free_directions.size());
    for (const Row &row : node.rows)
      {
        constrain(first + k++, row.value, row.support);
        held.push_back({node.position, row.direction, node.node});
      }
    if (fixes_rest)
      for (; k < dim; ++k)
        {
          constrain(first + k, 0., dealii::numbers::invalid_unsigned_int);
          held.push_back({node.position, to_frame[k], node.node});
        }
  }



  template <int dim>
  std::vector<Support<dim>>
  NodeSupports<dim>::finish()
  {
    for (const auto &[unused, node] : prescribed_nodes)
      constrain(node);
    prescribed_nodes.clear();
    nodes_with_frames.clear();
    if (prescribed.size() > 0 && prescribed.all_zero())
      prescribed.reinit(0);
    fixed.close();
    return std::move(held);
  }



  template struct PrescribedNode<2>;
  template struct PrescribedNode<3>;
  template class NodeSupports<2>;
  template class NodeSupports<3>;
} // namespace Debond
