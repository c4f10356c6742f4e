// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>

#include <debond/base/text.h>
#include <debond/contact/field_value.h>
#include <debond/elasticity/load_vector.h>
#include <debond/mesh/owned_cells.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Debond
{
  template <int dim>
  dealii::Tensor<1, dim>
  Traction<dim>::operator()(const dealii::Point<dim>     &point,
                            const dealii::Tensor<1, dim> &normal) const
  {
    try
      {
        return value->n_components == 1 ? -field_value(*value, point) * normal :
                                          field_vector(*value, point);
      }
    catch (const std::invalid_argument &error)
      {
        throw LoadError(entry, error.what());
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
        throw LoadError("Loads/Body force", error.what());
      }
  }



  template <int dim>
  dealii::Quadrature<dim - 1>
  face_rule(const unsigned int n_parts)
  {
    if constexpr (dim == 2)
      return dealii::QIterated<1>(dealii::QGauss<1>(4), n_parts);
    else
      {
        const dealii::QGaussSimplex<2> rule(3);
        std::vector<dealii::Point<2>>  points;
        std::vector<double>            weights;
        // A part with its corner here, its legs along the axes or against them.
        const auto add =
          [&](const unsigned int x, const unsigned int y, const double leg) {
            for (unsigned int q = 0; q < rule.size(); ++q)
              {
                points.emplace_back((x + leg * rule.point(q)[0]) / n_parts,
                                    (y + leg * rule.point(q)[1]) / n_parts);
                weights.push_back(rule.weight(q) / (n_parts * n_parts));
              }
          };
        for (unsigned int x = 0; x < n_parts; ++x)
          for (unsigned int y = 0; x + y < n_parts; ++y)
            {
              add(x, y, 1.);
              if (x + y + 1 < n_parts)
                add(x + 1, y + 1, -1.);
            }
        return {points, weights};
      }
  }



  namespace
  {
    /// Errors of the integral that no note speaks of, relative to the load.
    constexpr double small_error = 1e-6;

    /// A part of a face.
    template <int dim>
    using Part = std::array<dealii::Point<dim>, dim>;

    /// Two halves, or four triangles.
    template <int dim>
    std::vector<Part<dim>>
    divide(const Part<dim> &part)
    {
      const auto middle = [&](const unsigned int a, const unsigned int b) {
        return part[a] + 0.5 * (part[b] - part[a]);
      };
      if constexpr (dim == 2)
        return {{{part[0], middle(0, 1)}}, {{middle(0, 1), part[1]}}};
      else
        return {{{part[0], middle(0, 1), middle(0, 2)}},
                {{middle(0, 1), part[1], middle(1, 2)}},
                {{middle(0, 2), middle(1, 2), part[2]}},
                {{middle(0, 1), middle(1, 2), middle(0, 2)}}};
    }



    /// Of degree 3 and more.
    template <int dim>
    dealii::Quadrature<dim - 1>
    rule_with_ends()
    {
      if constexpr (dim == 2)
        return dealii::QGaussLobatto<1>(4);
      else
        return {{{0., 0.},
                 {1., 0.},
                 {0., 1.},
                 {0.5, 0.},
                 {0.5, 0.5},
                 {0., 0.5},
                 {1. / 3., 1. / 3.}},
                {1. / 40.,
                 1. / 40.,
                 1. / 40.,
                 1. / 15.,
                 1. / 15.,
                 1. / 15.,
                 9. / 40.}};
    }



    /// A traction on one face.
    template <int dim>
    struct LoadedFace
    {
      const Traction<dim>   *traction;
      dealii::Tensor<1, dim> normal;
      Part<dim>              corners;
      double                 measure;

      /// The mean on a part of it.
      dealii::Tensor<1, dim>
      mean(const Part<dim> &part, const dealii::Quadrature<dim - 1> &rule) const
      {
        dealii::Tensor<1, dim> sum;
        for (unsigned int q = 0; q < rule.size(); ++q)
          {
            dealii::Point<dim> point = part[0];
            for (unsigned int k = 1; k < dim; ++k)
              point += rule.point(q)[k - 1] * (part[k] - part[0]);
            sum += (dim - 1.) * rule.weight(q) * (*traction)(point, normal);
          }
        return sum;
      }

      /// How far the mean is from that of its parts.
      dealii::Tensor<1, dim>
      error(const Part<dim>                   &part,
            const dealii::Quadrature<dim - 1> &rule) const
      {
        dealii::Tensor<1, dim>       result = mean(part, rule);
        const std::vector<Part<dim>> parts  = divide<dim>(part);
        for (const Part<dim> &smaller : parts)
          result -= mean(smaller, rule) / static_cast<double>(parts.size());
        return result;
      }
    };



    /// Integrates a traction over faces, one after the other, and remembers the
    /// one on which that is worst.
    template <int dim>
    class TractionIntegral
    {
    public:
      TractionIntegral()
        : rule(face_rule<dim>(parts_of_a_face<dim>))
        , coarse_rule(face_rule<dim>(parts_of_a_face<dim> / 2))
      {}

      /// @p mean: by the rule.
      void
      look_at(const LoadedFace<dim>        &face,
              const dealii::Tensor<1, dim> &mean,
              const double                  mean_size)
      {
        size += mean_size * face.measure;
        const double difference =
          (face.mean(face.corners, coarse_rule) - mean).norm() * face.measure;
        if (difference > largest_difference)
          {
            largest_difference = difference;
            worst              = face;
          }
      }

      /// Appends a note if the worst face needs one.
      void
      add_note(std::vector<std::string> &notes) const
      {
        if (largest_difference <= small_error * size)
          return;
        const double error =
          worst.error(worst.corners, rule).norm() * worst.measure / size;
        if (error <= small_error)
          return;

        // The rule has points at the ends, for a jump near one of them would go
        // unnoticed; not at those of the face, where it may be a neighbor's.
        const dealii::Quadrature<dim - 1> with_ends = rule_with_ends<dim>();
        Part<dim>                         part      = worst.corners;
        for (const dealii::Point<dim> &corner : worst.corners)
          for (dealii::Point<dim> &inner : part)
            inner += 1e-10 * (corner - inner);
        for (unsigned int step = 0; step < (dim == 2 ? 30 : 15); ++step)
          {
            const std::vector<Part<dim>> parts = divide<dim>(part);
            part                               = *std::max_element(
              parts.begin(),
              parts.end(),
              [&](const Part<dim> &a, const Part<dim> &b) {
                return worst.error(a, with_ends).norm_square() <
                       worst.error(b, with_ends).norm_square();
              });
          }
        dealii::Point<dim> place;
        for (const dealii::Point<dim> &corner : part)
          place += corner / static_cast<double>(dim);
        const double here = worst.mean(part, with_ends).norm();
        double       jump = 0.;
        for (const dealii::Point<dim> &corner : part)
          jump = std::max(jump,
                          ((*worst.traction)(corner, worst.normal) -
                           (*worst.traction)(part[0], worst.normal))
                            .norm());
        notes.push_back(words(worst.traction->entry,
                              here * worst.measure > 100. * size ?
                                " grows without bound" :
                              jump > 1e-3 * here ? " jumps" :
                                                   " is not smooth",
                              " inside a face, at ",
                              point_text(place),
                              ", which makes an error of ",
                              error,
                              " of the whole: put a vertex there"));
      }

      const dealii::Quadrature<dim - 1> rule;

    private:
      const dealii::Quadrature<dim - 1> coarse_rule;
      LoadedFace<dim>                   worst;
      double                            largest_difference = 0.;
      double                            size               = 0.;
    };



    template <int dim>
    void
    add_tractions(const dealii::DoFHandler<dim> &dof_handler,
                  const Loads<dim>              &loads,
                  DofVector                     &forces,
                  std::vector<std::string>      *notes)
    {
      const dealii::MappingFE<dim> mapping(dealii::FE_SimplexP<dim>(1));
      const auto                  &fe = dof_handler.get_fe();
      std::map<std::string, TractionIntegral<dim>> integrals;
      const dealii::Quadrature<dim - 1>            rule =
        face_rule<dim>(parts_of_a_face<dim>);
      dealii::FEFaceValues<dim> fe_values(mapping,
                                          fe,
                                          rule,
                                          dealii::update_values |
                                            dealii::update_quadrature_points |
                                            dealii::update_normal_vectors);

      std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
      std::vector<dealii::Tensor<1, dim>>          values(rule.size());
      for (const auto &cell : owned_cells(dof_handler))
        for (const unsigned int f : cell->face_indices())
          {
            const auto face       = cell->face(f);
            const auto loads_here = loads.tractions.find(face->boundary_id());
            if (!face->at_boundary() || loads_here == loads.tractions.end())
              continue;
            fe_values.reinit(cell, f);
            cell->get_dof_indices(dofs);
            LoadedFace<dim> loaded = {nullptr,
                                      fe_values.normal_vector(0),
                                      {},
                                      face->measure()};
            for (unsigned int v = 0; v < dim; ++v)
              loaded.corners[v] = face->vertex(v);
            for (const Traction<dim> &traction : loads_here->second)
              {
                dealii::Tensor<1, dim> mean;
                double                 mean_size = 0.;
                for (unsigned int q = 0; q < rule.size(); ++q)
                  {
                    // A coordinate that all corners share has no rounding, for
                    // the traction may jump there.
                    dealii::Point<dim> point = fe_values.quadrature_point(q);
                    for (unsigned int d = 0; d < dim; ++d)
                      if (std::all_of(loaded.corners.begin(),
                                      loaded.corners.end(),
                                      [&](const dealii::Point<dim> &corner) {
                                        return corner[d] ==
                                               loaded.corners[0][d];
                                      }))
                        point[d] = loaded.corners[0][d];
                    values[q] = (dim - 1.) * rule.weight(q) *
                                traction(point, loaded.normal);
                    mean += values[q];
                    mean_size += values[q].norm();
                  }
                for (unsigned int i = 0; i < dofs.size(); ++i)
                  if (fe.has_support_on_face(i, f))
                    {
                      const unsigned int d =
                        fe.system_to_component_index(i).first;
                      // Rounded once: a constant traction has the forces of
                      // its closed form.
                      long double sum = 0.;
                      for (unsigned int q = 0; q < rule.size(); ++q)
                        sum += static_cast<long double>(
                                 fe_values.shape_value(i, q)) *
                               values[q][d];
                      forces(dofs[i]) +=
                        loaded.measure * static_cast<double>(sum);
                    }
                if (notes != nullptr)
                  {
                    loaded.traction = &traction;
                    integrals[traction.entry].look_at(loaded, mean, mean_size);
                  }
              }
          }
      if (notes != nullptr)
        for (const auto &[unused, integral] : integrals)
          integral.add_note(*notes);
    }



    template <int dim>
    void
    add_body_force(const dealii::DoFHandler<dim> &dof_handler,
                   const Loads<dim>              &loads,
                   DofVector                     &forces)
    {
      const dealii::MappingFE<dim> mapping(dealii::FE_SimplexP<dim>(1));
      const auto                  &fe = dof_handler.get_fe();
      dealii::FEValues<dim>        fe_values(mapping,
                                      fe,
                                      dealii::QGaussSimplex<dim>(fe.degree + 1),
                                      dealii::update_values |
                                        dealii::update_quadrature_points |
                                        dealii::update_JxW_values);

      std::vector<dealii::types::global_dof_index> dofs(fe.dofs_per_cell);
      for (const auto &cell : owned_cells(dof_handler))
        {
          fe_values.reinit(cell);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : fe_values.quadrature_point_indices())
            {
              const dealii::Tensor<1, dim> force =
                fe_values.JxW(q) *
                loads.force_at(fe_values.quadrature_point(q));
              for (unsigned int i = 0; i < dofs.size(); ++i)
                forces(dofs[i]) += fe_values.shape_value(i, q) *
                                   force[fe.system_to_component_index(i).first];
            }
        }
    }
  } // namespace



  template <int dim>
  DofVector
  load_vector(const dealii::DoFHandler<dim> &dof_handler,
              const Loads<dim>              &loads,
              std::vector<std::string>      *notes)
  {
    DofVector forces(dof_handler.n_dofs());
    if (loads.body_force)
      add_body_force(dof_handler, loads, forces);
    if (!loads.tractions.empty())
      add_tractions(dof_handler, loads, forces, notes);
    return forces;
  }



  template struct Traction<2>;
  template struct Traction<3>;
  template struct Loads<2>;
  template struct Loads<3>;
  template decltype(face_rule<2>)   face_rule<2>;
  template decltype(face_rule<3>)   face_rule<3>;
  template decltype(load_vector<2>) load_vector<2>;
  template decltype(load_vector<3>) load_vector<3>;
} // namespace Debond
