// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/quadrature_lib.h>

#include <debond/base/ranks.h>
#include <debond/check/displacement_error.h>
#include <debond/mesh/owned_cells.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    template <int dim>
    dealii::Tensor<1, dim>
    value_at(const dealii::Point<dim>    &point,
             const dealii::Function<dim> &exact)
    {
      dealii::Vector<double> values(dim);
      dealii::Tensor<1, dim> result;
      try
        {
          exact.vector_value(point, values);
          for (unsigned int d = 0; d < dim; ++d)
            result[d] = values[d];
        }
      catch (const std::exception &)
        {
          result[0] = std::numeric_limits<double>::quiet_NaN();
        }
      if (!std::isfinite(result.norm()))
        {
          std::ostringstream message;
          message << "The exact displacement is not finite at (" << point
                  << ").";
          throw std::invalid_argument(message.str());
        }
      return result;
    }



    /// Its error is of the order step^4.
    template <int dim>
    dealii::Tensor<2, dim>
    gradient_at(const dealii::Point<dim>    &point,
                const double                 step,
                const dealii::Function<dim> &exact)
    {
      dealii::Tensor<2, dim> gradient;
      for (unsigned int e = 0; e < dim; ++e)
        {
          const auto at = [&](const int steps) {
            dealii::Point<dim> neighbour = point;
            neighbour[e] += steps * step;
            return value_at(neighbour, exact);
          };
          const dealii::Tensor<1, dim> derivative =
            (8. * (at(1) - at(-1)) - (at(2) - at(-2))) / (12. * step);
          for (unsigned int d = 0; d < dim; ++d)
            gradient[d][e] = derivative[d];
        }
      return gradient;
    }



    /// The integrals of squares that the norms are roots of.
    struct Squares
    {
      double value    = 0.;
      double gradient = 0.;
      double energy   = 0.;
    };



    double
    relative_norm(const double error, const double exact)
    {
      return std::sqrt(exact > 0. ? error / exact : error);
    }
  } // namespace



  template <int dim>
  DisplacementError
  displacement_error(const ElasticProblem<dim>   &problem,
                     const DofVector             &u,
                     const dealii::Function<dim> &exact)
  {
    dealii::SymmetricTensor<4, dim> stiffness;
    const DofVector displacement = problem.unknowns().cartesian_displacement(u);
    CellStresses<dim> cell_stresses(problem.fields(),
                                    displacement,
                                    1.,
                                    dealii::QGaussSimplex<dim>(3),
                                    dealii::update_values |
                                      dealii::update_quadrature_points |
                                      dealii::update_JxW_values);
    const auto       &values = cell_stresses.values();

    Squares    errors, norms;
    const auto add = [&](const double                  weight,
                         const dealii::Tensor<1, dim> &value,
                         const dealii::Tensor<2, dim> &gradient,
                         Squares                      &squares) {
      const dealii::SymmetricTensor<2, dim> strain =
        dealii::symmetrize(gradient);
      squares.value += weight * value.norm_square();
      squares.gradient += weight * gradient.norm_square();
      squares.energy += weight * (strain * (stiffness * strain));
    };

    const MPI_Comm ranks = problem.unknowns().communicator();
    on_all_ranks(ranks, [&]() {
      for (const auto &cell : owned_cells(problem.unknowns().dof_handler()))
        {
          cell_stresses.reinit(cell);
          stiffness =
            problem.fields().material(cell).template elasticity_tensor<dim>();
          // The points of the rule are further than twice that from the faces.
          const double step = 1e-3 * cell->minimum_vertex_distance();
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const dealii::Point<dim>    &point  = values.quadrature_point(q);
              const double                 weight = values.JxW(q);
              const dealii::Tensor<1, dim> exact_value = value_at(point, exact);
              const dealii::Tensor<2, dim> exact_gradient =
                gradient_at(point, step, exact);
              add(weight, exact_value, exact_gradient, norms);
              add(weight,
                  cell_stresses.displacement(q) - exact_value,
                  cell_stresses.gradient(q) - exact_gradient,
                  errors);
            }
        }
    });
    for (Squares *const squares : {&errors, &norms})
      for (double *const sum :
           {&squares->value, &squares->gradient, &squares->energy})
        *sum = dealii::Utilities::MPI::sum(*sum, ranks);

    return {relative_norm(errors.value, norms.value),
            relative_norm(errors.gradient, norms.gradient),
            relative_norm(errors.energy, norms.energy),
            0.5 * norms.energy};
  }



  template decltype(displacement_error<2>) displacement_error<2>;
  template decltype(displacement_error<3>) displacement_error<3>;
} // namespace Debond
