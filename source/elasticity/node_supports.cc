// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/contact_frame.h>
#include <debond/elasticity/edge_coefficients.h>
#include <debond/elasticity/node_supports.h>
#include <debond/mesh/field_value.h>

namespace Debond
{
  namespace
  {
    /// The name of the clamp of a face: the widest piece that is clamped as a
    /// whole.
    std::string
    clamp_name(const BoundaryConditions        &conditions,
               const dealii::types::boundary_id id)
    {
      // A clamp may consist of several pieces with names, and reactions are
      // reported by name. The widest name whose ids are all clamped says most;
      // a name that is clamped in part would count forces of a free piece.
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
      // A roller has one normal, that of its first face, which is prescribed at
      // all its nodes. On a curved side the nodes would move along a direction
      // that is not theirs.
      if (condition.is_roller &&
          (face.normal - normal).norm() > Tolerance::same_normal)
        fail(condition,
             "a roller is flat, but the normals of " + condition.name +
               " differ: prescribe components by Displacement " +
               condition.name);
      // On the contact boundary the normal displacement must not be prescribed
      // wholly. It is prescribed wholly if all components that the normal has
      // are. A roller prescribes it always.
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
      // The values at the nodes of the face are interpolated. If the unknown in
      // the middle of an edge is a coefficient, it follows from the middle and
      // the two ends.
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
    // The rows are orthonormal, so that the sum of value times direction
    // satisfies them all and is the shortest vector that does.
    dealii::Tensor<1, dim> displacement;
    for (const Row &row : rows)
      displacement += row.value * row.direction;
    return displacement;
  }



  template <int dim>
  bool
  PrescribedNode<dim>::add(Row row)
  {
    // One step of the Gram-Schmidt process, on the direction and with it on the
    // value: what the other rows prescribe already is subtracted from both. If
    // no direction remains the row is dependent on the others, and consistent
    // with them if no value remains, to the largest value of all. Otherwise the
    // rest is normalised, which divides the value as well.
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
        // Of the axes the one of which the most is outside of the rows gives
        // the next direction. The rows stay orthonormal, and no almost
        // dependent axis loses digits.
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
    // Clamps come before other supports: the directions of a clamped node are
    // the axes, and what is prescribed later has to be zero there. A node on
    // several clamped sides is held by the first one.
    std::map<std::string, unsigned int> numbers;
    for (const BoundaryFace<dim> &face : faces)
      {
        const auto [entry, is_new] =
          numbers.emplace(clamp_name(conditions, face.id),
                          static_cast<unsigned int>(support_names.size()));
        if (is_new)
          support_names.push_back(entry->first);
        for (unsigned int n = 0; n < face.n_nodes; ++n)
          {
            const unsigned int   index = face.indices[n];
            PrescribedNode<dim> &node =
              nodes.emplace(index, at(index, face.positions[n])).first->second;
            for (unsigned int d = 0; d < dim && !node.is_clamped; ++d)
              node.rows.push_back(
                {dealii::Point<dim>::unit_vector(d), 0., entry->second});
            node.is_clamped = true;
          }
      }
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

    // Faces share nodes, and a field is evaluated once at each of them. The
    // rows of a condition are added one by one to those of other supports at
    // the node, so that supports along different directions complement each
    // other.
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
                // Normals of sides along the axes are cleared of rounding, so
                // that their nodes need no frame.
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
            PrescribedNode<dim> &node =
              nodes.emplace(index, at(index, face.positions[n])).first->second;
            for (const Row &row : rows)
              if (!node.add(row))
                fail(condition,
                     "the displacement at " + point_text(node.position) +
                       (node.is_clamped ?
                          " is prescribed, but the vertex is clamped: leave "
                          "its side out of Clamped boundaries" :
                          " is prescribed otherwise by " +
                            support_names[node.rows[0].support]));
          }
      }
  }



  template <int dim>
  void
  NodeSupports<dim>::hold_axis(const std::vector<dealii::Point<dim>> &positions,
                               const double                           diameter)
  {
    // On the axis u_r = 0, as the strain u_r / r would be infinite otherwise.
    // No support bears this, for the forces around the axis balance each other.
    // Coordinates of mesh files are rounded, hence the tolerance.
    const double on_it = Tolerance::same_place * diameter;
    for (unsigned int index = 0; index < positions.size(); ++index)
      {
        const dealii::Point<dim> &position = positions[index];
        if (position[0] < -on_it)
          throw EntryError("Symmetry",
                           "the body reaches to " + point_text(position) +
                             ", but x is the distance from the axis");
        if (position[0] > on_it)
          continue;
        axis_nodes.insert(index);
        PrescribedNode<dim> &node =
          nodes.emplace(index, at(index, position)).first->second;
        if (!node.add({dealii::Point<dim>::unit_vector(0),
                       0.,
                       dealii::numbers::invalid_unsigned_int}))
          throw SupportError(SupportError::Subject::displacement,
                             name(node.rows[0].support),
                             "it moves " + point_text(position) +
                               " away from the axis");
      }
  }



  template <int dim>
  void
  NodeSupports<dim>::glue(NodePairs<dim> &pairs)
  {
    // Whether one node is held wherever the other one is.
    const auto is_held_as = [this](const unsigned int node,
                                   const unsigned int other) {
      const std::vector<Row> own = at(node, {}).rows, all = at(other, {}).rows;
      return std::all_of(all.begin(), all.end(), [&own](const Row &row) {
        dealii::Tensor<1, dim> rest = row.direction;
        for (const Row &held : own)
          rest -= (rest * held.direction) * held.direction;
        return rest.norm() <= Tolerance::same_normal;
      });
    };
    // The unknowns of a first node are the jump, those of a second one its
    // displacement. A displacement that is prescribed at the first node is one
    // of the jump only if the second node is held in the same directions, since
    // the jump is a difference. Therefore the second node has to be the one
    // that is held wherever the other one is.
    ends_of_interfaces = pairs.ends();
    for (unsigned int k = 0; k < pairs.all().size(); ++k)
      {
        auto pair = pairs.all()[k];
        if (!is_held_as(pair.second, pair.first))
          {
            if (!is_held_as(pair.first, pair.second))
              throw std::invalid_argument(
                "supports hold both bodies along different directions where "
                "they are glued to each other, at " +
                point_text(nodes.at(pair.first).position) +
                ": hold one of them as far as the other one there");
            pairs.exchange(k);
            pair = pairs.all()[k];
          }
        const auto first = nodes.find(pair.first);
        if (first == nodes.end() || first->second.rows.empty())
          continue;
        const PrescribedNode<dim> &second = nodes.at(pair.second);
        std::vector<Row>          &rows   = first->second.rows;
        auto                      &both   = glued[pair.first];
        both = {{rows[0].support, second.rows[0].support}};
        // The first node is on the low side after an exchange; the list has the
        // support of the high side first.
        if (pair.sign < 0.)
          std::swap(both[0], both[1]);
        // From u_first = sign [u] + u_second, the prescribed jump along the row
        // is sign (value - direction . u_second).
        for (Row &row : rows)
          row.value =
            pair.sign * (row.value - row.direction * second.displacement());
      }
  }



  DEBOND_INSTANTIATE_CLASS(PrescribedNode);
  DEBOND_INSTANTIATE_CLASS(NodeSupports);
} // namespace Debond
