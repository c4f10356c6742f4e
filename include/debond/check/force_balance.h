// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_force_balance_h
#define debond_check_force_balance_h

#include <debond/check/verification.h>

namespace Debond
{
  /// The vectors of the contact nodes among those of all nodes.
  template <int dim>
  std::vector<dealii::Tensor<1, dim>>
  at_contact_nodes(const DofVector            &vectors,
                   const ElasticUnknowns<dim> &unknowns);

  /// Sets the resultants of loads, supports and foundation, and their
  /// imbalance. @p residual: A u - f; @p resolved: the least sum of forces'
  /// sizes that rounding leaves; @p held_forces: of the bonds at vertices that
  /// are held.
  template <int dim>
  void
  compute_force_balance(const ElasticProblem<dim> &problem,
                        const DofVector           &residual,
                        const LoadFactors          factors,
                        const double               resolved,
                        const std::vector<double> &held_forces,
                        Verification<dim>         &result);
} // namespace Debond

#endif
