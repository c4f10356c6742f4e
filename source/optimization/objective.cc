// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/lac/vector.h>

#include <debond/optimization/objective.h>

namespace Debond
{
  namespace
  {
    /// The restriction by plain evaluation at x + t d.
    template <typename VectorType>
    class PlainRestriction : public LineRestriction<VectorType>
    {
    public:
      PlainRestriction(const Objective<VectorType> &objective,
                       const VectorType            &x,
                       const VectorType            &d)
        : objective(objective)
        , x(x)
        , d(d)
        , value_at_x(objective.value(x))
      {}

      double
      change(const double t) const override
      {
        point = x;
        point.add(t, d);
        return objective.value(point) - value_at_x;
      }

      void
      subgradient(const double t, VectorType &eta) const override
      {
        point = x;
        point.add(t, d);
        objective.subgradient(point, eta);
      }

    private:
      const Objective<VectorType> &objective;
      const VectorType            &x;
      const VectorType            &d;
      const double                 value_at_x;
      mutable VectorType           point;
    };
  } // namespace



  template <typename VectorType>
  std::unique_ptr<LineRestriction<VectorType>>
  Objective<VectorType>::along(const VectorType &x, const VectorType &d) const
  {
    return std::make_unique<PlainRestriction<VectorType>>(*this, x, d);
  }



  template class Objective<dealii::Vector<double>>;
  template class Objective<dealii::LinearAlgebra::distributed::Vector<double>>;
} // namespace Debond
