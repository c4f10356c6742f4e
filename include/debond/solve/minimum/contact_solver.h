// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_contact_solver_h
#define debond_solve_minimum_contact_solver_h

#include <debond/solve/minimum/correction_solver.h>
#include <debond/solve/minimum/method_choice.h>
#include <debond/solve/minimum/progress.h>
#include <debond/solve/minimum/solution.h>

namespace Debond
{
  /**
   * Minimises J on one mesh, by majorise-minimise or the energy bundle, under
   * one load after the other, each time from the point before, and to begin
   * with from the body at rest. What does not depend on loads is made once: a
   * factorisation of A, or a multigrid cycle. All functionals are J, with the
   * energy of what is prescribed. All functions are to be called by all ranks.
   */
  template <int dim>
  class ContactSolver
  {
  public:
    virtual ~ContactSolver() = default;

    /// The next minimisation starts from @p u, of which positive parts of s are
    /// cut off.
    virtual void
    start_from(const DofVector &u) = 0;

    /// Minimises J at these @p factors, at which @p bonds are. What it returns
    /// has no displacement.
    virtual Solution
    minimise(const LoadFactors            factors,
             const AdhesionIntegral<dim> &bonds,
             Progress                    &progress) = 0;

    /// The normal displacements s of the contact nodes.
    virtual Eigen::VectorXd
    point() const = 0;

    /// All degrees of freedom, w of ElasticUnknowns, at the factors of the last
    /// minimisation; before the first one under the whole load.
    virtual DofVector
    displacement() const = 0;

    /// The linear solver for the refinement of displacement().
    virtual std::unique_ptr<CorrectionSolver>
    correction() = 0;

    /// The problem on s alone under the whole load; null if there is none.
    virtual const Condensation *
    condensed() const
    {
      return nullptr;
    }
  };



  /// The solver of @p choice, which keeps references to the scene and the
  /// parameters. If that is multigrid and does not get to the end of a
  /// minimisation, a factorisation takes its place from there on, and a note of
  /// the minimum says so.
  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_contact_solver(const MethodChoice     &choice,
                      const SolverParameters &parameters,
                      const Scene<dim>       &scene);
} // namespace Debond

#endif
