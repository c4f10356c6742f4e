// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_coulomb_h
#define debond_solve_path_coulomb_h

#include <debond/contact/adhesion_integral.h>
#include <debond/solve/minimum/solution.h>

#include <functional>

namespace Debond
{
  /// What a step of a path has for Coulomb's friction.
  struct StepWithFriction
  {
    /// The minimum with the friction that the bonds have then.
    std::function<Solution()> minimise;

    /// The forces that press at the last minimum, of all nodes.
    std::function<Eigen::VectorXd()> pressures;
  };



  /**
   * The discrete problem of Coulomb is a fixed point of problems with a given
   * bound (Necas, Jarusek, Haslinger, Boll. Un. Mat. Ital. 17, 1980), which are
   * contracted if coefficients are small: each has the pressures that the last
   * one has led to, and after the first few those of Anderson's acceleration
   * (Walker, Ni, SIAM J. Numer. Anal. 49, 2011). The first has the friction
   * that the bonds have.
   */
  template <int dim>
  Solution
  settle_friction(const StepWithFriction &step, AdhesionIntegral<dim> &bonds);
} // namespace Debond

#endif
