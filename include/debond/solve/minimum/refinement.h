// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_refinement_h
#define debond_solve_minimum_refinement_h

#include <debond/solve/minimum/correction_solver.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  struct RefinementResult
  {
    bool         converged         = false;
    unsigned int systems           = 0; ///< linear systems
    unsigned int linear_iterations = 0; ///< for all of them

    /// The relative error of the last point in the energy norm, as the solver
    /// of corrections sees it.
    double error = 0.;
  };



  /**
   * What rounding of the terms in the rows of A u can change of the energy of
   * @p u: epsilon <u, D u>, D the diagonal of A. As a part of <u, A u> it grows
   * with the fourth power of length over thickness.
   */
  template <int dim>
  double
  rounding_of_energy(const ElasticProblem<dim> &problem,
                     const LoadFactors          factors,
                     const DofVector           &u);



  /**
   * Results are refined if rounding can change more of their energy than this:
   * between 1e-10 on small meshes, which slender bodies of few cells reach
   * where all else in them is exact to the last digits, and 1e-9 on large ones,
   * whose sums have more terms. @p n_unknowns are the free ones.
   */
  double
  allowed_energy_rounding(const unsigned int n_unknowns);



  /**
   * Goes on from @p u by majorise-minimise in extended precision
   * (ExtendedOperator), or by Newton steps where Phi softens, so that only the
   * rounding of the result remains of its errors. Bounds of u_nu are kept by
   * active sets. The linear systems are solved by flexible conjugate gradients
   * with @p solver as preconditioner (Notay, SIAM J. Sci. Comput. 22, 2000), to
   * 1e-13 of the energy. The few directions in which factors in double
   * precision are wrong take a few steps more.
   *
   * u becomes the result if it converged, and stays as it is otherwise. The
   * load is @p factors times that of the last assemble().
   */
  template <int dim>
  RefinementResult
  refine(const ElasticProblem<dim> &problem,
         const PiecewiseQuadratic  &phi,
         const LoadFactors          factors,
         CorrectionSolver          &solver,
         const Interruption        &interruption,
         DofVector                 &u);



  struct Refined
  {
    bool is_refined = false; ///< u is a minimiser in extended precision

    /// The note for the user, empty if all is as in any other scene.
    std::string note;
  };



  /// Refines the minimiser @p u, or what rounding left of the way to one, if
  /// rounding in double precision can change more of its energy than
  /// allowed_energy_rounding(). What is at rest but for rounding becomes
  /// zero.
  template <int dim>
  Refined
  refine_where_needed(const Scene<dim>         &scene,
                      const PiecewiseQuadratic &phi,
                      const LoadFactors         factors,
                      CorrectionSolver         &solver,
                      const Interruption       &interruption,
                      DofVector                &u);
} // namespace Debond

#endif
