// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_contact_solver_h
#define debond_solve_minimum_contact_solver_h

#include <debond/solve/minimum/correction_solver.h>
#include <debond/solve/minimum/method_choice.h>
#include <debond/solve/minimum/progress.h>
#include <debond/solve/minimum/solve_result.h>

namespace Debond
{
  /// The end of a minimisation. A bundle method has an account of its own as
  /// well, and its v_k stands for the residual.
  struct ContactMinimum : MajoriseMinimiseResult
  {
    std::optional<ProximalBundleResult> bundle;
  };



  /**
   * Minimises J on one mesh, by majorise-minimise or the energy bundle, under
   * one load after the other, each time from the point before, and to begin
   * with from the body at rest. What does not depend on loads is made once: a
   * factorisation of A, or a multigrid cycle. All functionals are J, with the
   * energy of what is prescribed. All functions but point() are to be called by
   * all ranks.
   */
  template <int dim>
  class ContactSolver
  {
  public:
    virtual ~ContactSolver() = default;

    /// The next minimisation starts from @p u, whose normal displacements at
    /// the contact nodes are @p s: what is condensed reads s alone, multigrid u
    /// alone. Positive parts of s are cut off.
    virtual void
    start_from(const Eigen::VectorXd &s, const DofVector &u) = 0;

    /// The next minimisation starts from the minimum under the whole load on
    /// coarser meshes or coarser contact boundaries, if there are any. @p
    /// result gets the counts of a search there, and notes.
    virtual void
    start_from_coarser(const SolverParameters &parameters,
                       SolveResult            &result) = 0;

    /// Minimises J at these @p factors, at which @p bonds are.
    virtual ContactMinimum
    minimise(const LoadFactors            factors,
             const AdhesionIntegral<dim> &bonds,
             const SolverParameters      &parameters,
             Progress                    &progress) = 0;

    /// The normal displacements s of the contact nodes.
    virtual Eigen::VectorXd
    point() const = 0;

    /// All degrees of freedom, w of ElasticUnknowns, at the factors of the last
    /// minimisation, of which there has to be one.
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



  /// The solver of @p choice, which keeps a reference to the scene.
  template <int dim>
  std::unique_ptr<ContactSolver<dim>>
  make_contact_solver(const MethodChoice &choice, const Scene<dim> &scene);
} // namespace Debond

#endif
