// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_displacement_error_h
#define debond_check_displacement_error_h

#include <debond/elasticity/elastic_problem.h>

namespace Debond
{
  /// How far a computed displacement is from a given one, in norms relative to
  /// those of the given one (absolute where it is zero).
  struct DisplacementError
  {
    double l2;          ///< of u
    double h1;          ///< of the gradient of u
    double energy_norm; ///< <A u, u>^(1/2)

    /// 1/2 <A u, u> of the given displacement.
    double exact_energy;
  };

  /// Integrated by a rule of degree 5 on each cell; the gradient of @p exact
  /// is a difference quotient of fourth order. Throws std::invalid_argument
  /// naming the point where @p exact is not finite.
  template <int dim>
  DisplacementError
  displacement_error(const ElasticProblem<dim>   &problem,
                     const DofVector             &u,
                     const dealii::Function<dim> &exact);
} // namespace Debond

#endif
