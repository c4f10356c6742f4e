// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_contact_solver_h
#define debond_solve_contact_solver_h

#include <debond/base/dof_vector.h>
#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/load_factors.h>
#include <debond/input/solver_parameters.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/solve/refinement.h>

#include <functional>

namespace Debond
{
  /**
   * Minimises J on one mesh, by majorise-minimise unless another method was
   * chosen, under one load after the other, each time from the point before.
   * What does not depend on loads is made once: a factorisation of A, or a
   * multigrid cycle. All functions but point() are to be called by all ranks.
   */
  template <int dim>
  class ContactSolver
  {
  public:
    using MayGoOn = std::function<bool()>;

    virtual ~ContactSolver() = default;

    /// At these @p factors, at which @p bonds are. The functionals of the
    /// result are J, those that @p monitor gets are less by what is prescribed.
    virtual MajoriseMinimiseResult
    minimise(const LoadFactors                factors,
             const AdhesionIntegral<dim>     &bonds,
             const SolverParameters          &parameters,
             const MajoriseMinimise::Monitor &monitor,
             const MayGoOn                   &may_go_on) = 0;

    /// The next minimisation starts from normal displacements @p s of the
    /// contact nodes, which are those of the displacement @p u.
    virtual void
    start_from(const Eigen::VectorXd &s, const DofVector &u) = 0;

    /// The normal displacements s of the contact nodes.
    virtual Eigen::VectorXd
    point() const = 0;

    /// All displacements at the same factors, refined where rounding has a say
    /// in them.
    virtual DofVector
    displacement(const LoadFactors            factors,
                 const AdhesionIntegral<dim> &bonds,
                 const MayGoOn               &may_go_on,
                 Refined                     &refined) = 0;

    /// The problem on s alone under the whole load; null if there is none.
    virtual const Condensation *
    condensed() const
    {
      return nullptr;
    }
  };
} // namespace Debond

#endif
