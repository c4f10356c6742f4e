// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/base/tolerances.h>
#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/simplex_values.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/owned_cells.h>
#include <debond/mesh/simplex_parts.h>

namespace Debond
{
  template <int dim>
  dealii::Tensor<1, dim>
  Traction<dim>::operator()(const dealii::Point<dim>     &point,
                            const dealii::Tensor<1, dim> &normal) const
  {
    try
      {
        // A field with one component is a pressure. It pushes against the
        // outward normal, and a positive one is a compression.
        return value->n_components == 1 ? -field_value(*value, point) * normal :
                                          field_vector(*value, point);
      }
    catch (const std::invalid_argument &error)
      {
        throw EntryError(entry, error.what());
      }
  }



  template <int dim>
  dealii::Tensor<1, dim>
  Loads<dim>::traction(const dealii::types::boundary_id id,
                       const dealii::Point<dim>        &point,
                       const dealii::Tensor<1, dim>    &normal) const
  {
    dealii::Tensor<1, dim> sum;
    if (const auto entry = tractions.find(id); entry != tractions.end())
      for (const Traction<dim> &traction : entry->second)
        sum += traction(point, normal);
    return sum;
  }



  template <int dim>
  dealii::Tensor<1, dim>
  Loads<dim>::force_at(const dealii::Point<dim> &point) const
  {
    try
      {
        return field_vector(*body_force, point);
      }
    catch (const std::invalid_argument &error)
      {
        throw EntryError("Loads/Body force", error.what());
      }
  }



  template <int dim>
  dealii::Quadrature<dim - 1>
  face_rule(const unsigned int n_parts)
  {
    // The rule is repeated on equal parts of the face, because expressions of
    // users have kinks and jumps inside of faces, which no rule of high degree
    // integrates well. The points of a part are affine images of those of the
    // reference face, with the weights divided by the number of parts.
    const dealii::QGaussSimplex<dim - 1> rule(dim == 2 ? 4 : 3);
    std::vector<dealii::Point<dim - 1>>  points;
    std::vector<double>                  weights;
    for_each_part<dim - 1>(n_parts, [&](const auto &corners) {
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          points.push_back(corners[0]);
          for (unsigned int d = 0; d + 1 < dim; ++d)
            points.back() += rule.point(q)[d] * (corners[d + 1] - corners[0]);
          weights.push_back(rule.weight(q) / std::pow(n_parts, dim - 1));
        }
    });
    return {points, weights};
  }



  namespace
  {
    /// A traction on the face on which its integral is worst.
    template <int dim>
    struct WorstFace
    {
      const Traction<dim>   *traction   = nullptr;
      double                 size       = 0.; ///< of the load on all faces
      double                 difference = 0.; ///< from a coarser rule
      dealii::Tensor<1, dim> normal;
      std::array<dealii::Point<dim>, dim> corners;
      double                              measure = 0.;
    };



    /// The mean of a traction on a face, times the way around the axis.
    template <int dim>
    dealii::Tensor<1, dim>
    mean_traction(const Traction<dim>                       &traction,
                  const Symmetry                             symmetry,
                  const dealii::Tensor<1, dim>              &normal,
                  const std::array<dealii::Point<dim>, dim> &corners,
                  const dealii::Quadrature<dim - 1>         &rule)
    {
      // The reference triangle has the area 1/2, to which the weights sum in
      // 3D; the factor dim - 1 makes them sum to one, so that the result is a
      // mean and the caller multiplies it by the measure of the face. Around an
      // axis the mean has the factor 2 pi r and its measure is the length in
      // the section.
      dealii::Tensor<1, dim> sum;
      for (unsigned int q = 0; q < rule.size(); ++q)
        {
          dealii::Point<dim> point = corners[0];
          for (unsigned int k = 1; k < dim; ++k)
            point += rule.point(q)[k - 1] * (corners[k] - corners[0]);
          sum += (dim - 1.) * rule.weight(q) * circumference(symmetry, point) *
                 traction(point, normal);
        }
      return sum;
    }



    /// Appends a note if the integral over the worst face is not good enough.
    template <int dim>
    void
    add_note(const WorstFace<dim>     &worst,
             const Symmetry            symmetry,
             std::vector<std::string> &notes)
    {
      // The difference between the rule and one of half as many parts is an
      // indicator that costs little on each face. Only if it is large on some
      // face is the integral there compared with one of twice as many parts,
      // which estimates the error that was made. Both are relative to the load
      // of the entry on all faces: a bad face of a small part of the load is
      // not worth a note.
      if (worst.difference <= Tolerance::load_integral * worst.size)
        return;
      const auto mean_by = [&](const unsigned int n_parts) {
        return mean_traction<dim>(*worst.traction,
                                  symmetry,
                                  worst.normal,
                                  worst.corners,
                                  face_rule<dim>(n_parts));
      };
      const double error =
        worst.measure *
        (mean_by(2 * parts_of_a_face<dim>) - mean_by(parts_of_a_face<dim>))
          .norm() /
        worst.size;
      if (error <= Tolerance::load_integral)
        return;
      // The place in the note is the centre of the face.
      dealii::Point<dim> centre;
      for (const dealii::Point<dim> &corner : worst.corners)
        centre += corner / static_cast<double>(dim);
      notes.push_back(words(worst.traction->entry,
                            " is not smooth inside the face at ",
                            point_text(centre),
                            ", which makes an error of about ",
                            error,
                            " of the whole: put a vertex where it jumps"));
    }



    /// The point with the coordinates that all corners of its face share
    /// without rounding, for tractions may jump there.
    template <int dim>
    dealii::Point<dim>
    on_face(dealii::Point<dim>                         point,
            const std::array<dealii::Point<dim>, dim> &corners)
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (std::all_of(corners.begin(),
                        corners.end(),
                        [&](const dealii::Point<dim> &corner) {
                          return corner[d] == corners[0][d];
                        }))
          point[d] = corners[0][d];
      return point;
    }



    /// The integral of the shape function @p i with these weighted values at
    /// the points, rounded once: a constant traction has the forces of its
    /// closed form.
    template <int dim>
    double
    integral(const dealii::FEFaceValues<dim>           &fe_values,
             const unsigned int                         i,
             const std::vector<dealii::Tensor<1, dim>> &values)
    {
      // Each shape function of the element has one component, and the values
      // contain the weights of the rule.
      const unsigned int d =
        fe_values.get_fe().system_to_component_index(i).first;
      long double sum = 0.;
      for (unsigned int q = 0; q < values.size(); ++q)
        sum +=
          static_cast<long double>(fe_values.shape_value(i, q)) * values[q][d];
      return static_cast<double>(sum);
    }



    template <int dim>
    void
    add_tractions(const dealii::DoFHandler<dim> &dof_handler,
                  const Loads<dim>              &loads,
                  const Symmetry                 symmetry,
                  DofVector                     &forces,
                  std::vector<std::string>      *notes)
    {
      // Each rank integrates over the faces of its own cells. The forces are
      // those of f_2 phi_k at the points of the rule. With them two means are
      // computed for each entry of the scene, by the rule and by half as many
      // parts: their difference on the worst face decides on a note. A face is
      // judged for each entry apart, as tractions on one boundary add up.
      const dealii::MappingFE<dim> mapping(dealii::FE_SimplexP<dim>(1));
      const auto                  &fe = dof_handler.get_fe();
      std::map<std::string, WorstFace<dim>> worst_faces;
      const dealii::Quadrature<dim - 1>     rule =
        face_rule<dim>(parts_of_a_face<dim>);
      const dealii::Quadrature<dim - 1> coarse_rule =
        face_rule<dim>(parts_of_a_face<dim> / 2);
      dealii::FEFaceValues<dim> fe_values(mapping,
                                          fe,
                                          rule,
                                          dealii::update_values |
                                            dealii::update_quadrature_points |
                                            dealii::update_normal_vectors);

      std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
      std::vector<dealii::Tensor<1, dim>>          values(rule.size());
      // A traction that is not finite throws on the rank that has the face.
      // Nothing within communicates.
      on_all_ranks(dof_handler.get_communicator(), [&]() {
        for (const auto &cell : owned_cells(dof_handler))
          for (const unsigned int f : cell->face_indices())
            {
              if (!cell->at_boundary(f))
                continue;
              // Ids of outer faces are known, for the cell is an own one.
              const auto face       = cell->face(f);
              const auto loads_here = loads.tractions.find(face->boundary_id());
              if (loads_here == loads.tractions.end())
                continue;
              fe_values.reinit(cell, f);
              cell->get_dof_indices(dofs);
              // Faces are flat: one normal and one measure for all points.
              const dealii::Tensor<1, dim> normal  = fe_values.normal_vector(0);
              const double                 measure = face->measure();
              std::array<dealii::Point<dim>, dim> corners;
              for (unsigned int v = 0; v < dim; ++v)
                corners[v] = face->vertex(v);
              for (const Traction<dim> &traction : loads_here->second)
                {
                  dealii::Tensor<1, dim> by_rule;
                  double                 mean_size = 0.;
                  for (unsigned int q = 0; q < rule.size(); ++q)
                    {
                      const auto &point = fe_values.quadrature_point(q);
                      values[q] =
                        (dim - 1.) * rule.weight(q) *
                        circumference(symmetry, point) *
                        traction(on_face<dim>(point, corners), normal);
                      by_rule += values[q];
                      mean_size += values[q].norm();
                    }
                  for (unsigned int i = 0; i < dofs.size(); ++i)
                    // In deal.II 9.4.1 simplex elements answer yes for all
                    // nodes of the cell. Shape functions of nodes off the face
                    // vanish on it, up to rounding, and so do their forces.
                    if (fe.has_support_on_face(i, f))
                      forces(dofs[i]) +=
                        measure * integral(fe_values, i, values);
                  if (notes == nullptr)
                    continue;
                  WorstFace<dim> &worst = worst_faces[traction.entry];
                  worst.size += measure * mean_size;
                  const double difference =
                    measure *
                    (mean_traction<dim>(
                       traction, symmetry, normal, corners, coarse_rule) -
                     by_rule)
                      .norm();
                  // `size` continues to sum up over all faces, whichever is the
                  // worst.
                  if (difference > worst.difference)
                    worst = {&traction,
                             worst.size,
                             difference,
                             normal,
                             corners,
                             measure};
                }
            }
      });
      if (notes == nullptr)
        return;
      // The sum below is collective, so that all ranks need the same entries in
      // the same order: a rank without a face of a load enters it with zeros. A
      // map is sorted by name, which is the order on all ranks. Each rank
      // writes a note on its own worst face, relative to the load of all.
      for (const auto &[unused, tractions] : loads.tractions)
        for (const Traction<dim> &traction : tractions)
          worst_faces[traction.entry];
      for (auto &[unused, worst] : worst_faces)
        {
          worst.size =
            dealii::Utilities::MPI::sum(worst.size,
                                        dof_handler.get_communicator());
          add_note(worst, symmetry, *notes);
        }
    }



    template <int dim>
    void
    add_body_force(const dealii::DoFHandler<dim> &dof_handler,
                   const Loads<dim>              &loads,
                   const Symmetry                 symmetry,
                   DofVector                     &forces)
    {
      // The forces are int f_0 phi_k, by a rule that is exact for products with
      // linear forces. A force that jumps should do so between cells.
      const auto                                  &fe = dof_handler.get_fe();
      SimplexValues<dim>                           values(fe.base_element(0),
                                dealii::QGaussSimplex<dim>(fe.degree + 1),
                                symmetry);
      std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
      for (const auto &cell : owned_cells(dof_handler))
        {
          values.reinit(*cell);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const dealii::Tensor<1, dim> force =
                values.JxW(q) * loads.force_at(values.quadrature_point(q));
              for (unsigned int i = 0; i < dofs.size(); ++i)
                forces(dofs[i]) +=
                  values.shape_value(i / dim, q) * force[i % dim];
            }
        }
    }
  } // namespace



  template <int dim>
  DofVector
  load_vector(const dealii::DoFHandler<dim> &dof_handler,
              const Loads<dim>              &loads,
              const Symmetry                 symmetry,
              std::vector<std::string>      *notes)
  {
    DofVector forces(dof_handler.n_dofs());
    if (loads.body_force)
      on_all_ranks(dof_handler.get_communicator(), [&]() {
        add_body_force(dof_handler, loads, symmetry, forces);
      });
    if (!loads.tractions.empty())
      add_tractions(dof_handler, loads, symmetry, forces, notes);
    return forces;
  }



  DEBOND_INSTANTIATE_CLASS(Traction);
  DEBOND_INSTANTIATE_CLASS(Loads);
  DEBOND_INSTANTIATE(face_rule);
  DEBOND_INSTANTIATE(load_vector);
} // namespace Debond
