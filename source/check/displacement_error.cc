// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/auto_derivative_function.h>

#include <debond/base/instantiate.h>
#include <debond/base/text.h>
#include <debond/check/displacement_error.h>
#include <debond/mesh/field_value.h>
#include <debond/mesh/owned_cells.h>

namespace Debond
{
  namespace
  {
    /// A displacement with derivatives by differences. Throws
    /// std::invalid_argument if it is not finite.
    template <int dim>
    class ExactDisplacement : public dealii::AutoDerivativeFunction<dim>
    {
    public:
      explicit ExactDisplacement(const dealii::Function<dim> &exact)
        : dealii::AutoDerivativeFunction<dim>(1., dim)
        , exact(exact)
      {
        this->set_formula(dealii::AutoDerivativeFunction<dim>::FourthOrder);
      }

      double
      value(const dealii::Point<dim> &point,
            const unsigned int        component) const override
      {
        try
          {
            return field_value(exact, point, component);
          }
        catch (const std::invalid_argument &)
          {
            throw std::invalid_argument(
              words("The exact displacement is not finite at (", point, ")."));
          }
      }

    private:
      const dealii::Function<dim> &exact;
    };
  } // namespace



  template <int dim>
  DisplacementError
  displacement_error(const ElasticProblem<dim>   &problem,
                     const DofVector             &u,
                     const dealii::Function<dim> &exact)
  {
    // The three norms are roots of integrals of squares: of the displacement,
    // of its gradient, and of its strain with the elasticity tensor. The same
    // integrals of the given displacement are what the errors are relative to,
    // so that one pass over the cells sums up both.
    dealii::SymmetricTensor<4, 3> stiffness;
    const DofVector displacement = problem.unknowns().cartesian_displacement(u);
    CellStresses<dim> cell_stresses(problem.fields(),
                                    displacement,
                                    1.,
                                    dealii::QGaussSimplex<dim>(3));
    const auto       &values = cell_stresses.values();

    ExactDisplacement<dim> known(exact);
    // Integrals of the squares that the norms are roots of.
    std::vector<double> errors(3), norms(3);
    const auto          add = [&](const double                  weight,
                         const double                  curvature,
                         const dealii::Tensor<1, dim> &value,
                         const dealii::Tensor<2, dim> &gradient,
                         std::vector<double>          &squares) {
      // The strain of the solid. Across the mesh it is u_r / r around an axis,
      // and zero in the plane, whose hypothesis is part of the stiffness.
      auto strain = resized<3>(dealii::symmetrize(gradient));
      strain[2][2] += curvature * value[0];
      squares[0] += weight * value.norm_square();
      squares[1] += weight * gradient.norm_square();
      squares[2] += weight * (strain * (stiffness * strain));
    };

    const MPI_Comm ranks = problem.unknowns().communicator();
    on_all_ranks(ranks, [&]() {
      for (const auto &cell : owned_cells(problem.unknowns().dof_handler()))
        {
          cell_stresses.reinit(cell);
          stiffness = problem.fields().solid_tensor(cell);
          // Differences of the fourth order take values up to two steps away.
          // The points of the rule are further than that from the faces, so
          // that no difference leaves the cell.
          known.set_h(1e-3 * cell->minimum_vertex_distance());
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const dealii::Point<dim> point  = values.quadrature_point(q);
              const double             weight = values.JxW(q);
              dealii::Tensor<1, dim>   exact_value;
              dealii::Tensor<2, dim>   exact_gradient;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  exact_value[d]    = known.value(point, d);
                  exact_gradient[d] = known.gradient(point, d);
                }
              const double curvature = values.has_axis() ? 1. / point[0] : 0.;
              add(weight, curvature, exact_value, exact_gradient, norms);
              add(weight,
                  curvature,
                  cell_stresses.displacement(q) - exact_value,
                  cell_stresses.gradient(q) - exact_gradient,
                  errors);
            }
        }
    });
    // Each rank has the integrals over its own cells.
    dealii::Utilities::MPI::sum(errors, ranks, errors);
    dealii::Utilities::MPI::sum(norms, ranks, norms);
    const auto norm = [&](const unsigned int k) {
      return std::sqrt(norms[k] > 0. ? errors[k] / norms[k] : errors[k]);
    };
    return {norm(0), norm(1), norm(2), 0.5 * norms[2]};
  }



  DEBOND_INSTANTIATE(displacement_error);
} // namespace Debond
