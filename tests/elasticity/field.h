// SPDX-License-Identifier: LGPL-2.1-or-later
// Fields from lambdas, and equilibria without contact.
#ifndef debond_tests_elasticity_field_h
#define debond_tests_elasticity_field_h

#include <deal.II/base/function.h>
#include <deal.II/lac/sparse_direct.h>

#include <debond/elasticity/elastic_problem.h>

#include <functional>
#include <memory>

template <int dim>
class Field : public dealii::Function<dim>
{
public:
  using Expression =
    std::function<dealii::Tensor<1, dim>(const dealii::Point<dim> &)>;

  Field(const Expression &expression, const unsigned int n_components)
    : dealii::Function<dim>(n_components)
    , expression(expression)
  {}

  double
  value(const dealii::Point<dim> &point,
        const unsigned int        component) const override
  {
    return expression(point)[component];
  }

private:
  const Expression expression;
};



template <int dim>
std::shared_ptr<const dealii::Function<dim>>
field(const typename Field<dim>::Expression &expression,
      const unsigned int                     n_components = dim)
{
  return std::make_shared<Field<dim>>(expression, n_components);
}



/// The resultant of all loads.
template <int dim>
dealii::Tensor<1, dim>
total_load(const Debond::ElasticProblem<dim> &problem)
{
  const Debond::DofVector forces = problem.fields().applied_nodal_forces();
  dealii::Tensor<1, dim>  result;
  for (unsigned int i = 0; i < forces.size(); ++i)
    result[i % dim] += forces(i);
  return result;
}



/// Without prescribed displacements.
template <int dim>
dealii::Vector<double>
solve(const Debond::ElasticProblem<dim> &problem)
{
  dealii::SparseDirectUMFPACK A;
  A.initialize(problem.matrix());
  dealii::Vector<double> w(problem.load().size());
  A.vmult(w, problem.load());
  problem.unknowns().constraints().set_zero(w);
  return w;
}

#endif
