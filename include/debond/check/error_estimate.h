// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_error_estimate_h
#define debond_check_error_estimate_h

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>

namespace Debond
{
  /// An estimate of how far J is above the one of the continuous problem near
  /// by, from the stresses of the cells. It is no bound.
  struct ErrorEstimate
  {
    double functional = 0.; ///< energy

    /// The energy that it is compared with: |J|, or where J is near zero the
    /// energy of the stresses.
    double scale   = 0.;
    bool   is_of_J = true;

    /// The parts of the active cells, which add up to `functional`.
    std::vector<double> cells;

    /// The measured factor by which they are more than the residuals say.
    std::optional<double> factor;

    /// Zero if there is nothing to compare with.
    double
    relative() const
    {
      return scale > 0. ? functional / scale : 0.;
    }
  };



  /// The problem of an estimate and all that it was made of, with its bonds as
  /// they are.
  template <int dim>
  struct EstimatedProblem
  {
    const ElasticProblem<dim>   &problem;
    const AdhesionIntegral<dim> &adhesion;
    const BoundaryConditions    &conditions;
    const Supports<dim>         &supports;
    const Loads<dim>            &loads;
    const Loads<dim>             dead_loads = {};
  };



  /**
   * The residual estimate of the error of J at a displacement u. Tractions do
   * not fit together at the faces F of the cells,
   *
   *     r = [sigma n] inside, t - sigma n (- j_1'(u_nu) n on Gamma_C) outside,
   *
   * together with half of the body force of the cells at the face. To r the
   * body could yield by a function b_F on these cells that is a product of
   * barycentric coordinates, 1 in the middle of F; J would fall by
   *
   *     1/2 (mean_F b_F)^2 |F| int_F |r|^2 / sum_K M_K int_K |grad b_F|^2,
   *
   * M being mu, and lambda + 2 mu for jumps of the pressure, lambda times the
   * dilation, between cells of one material (in nearly incompressible ones it
   * may alternate from cell to cell without harm). Bonds that b_F stretches
   * resist as well. In 2D all cells have the int_K |grad b_F|^2 of half a
   * square: a stretched cell's own is larger, as if it had to yield by itself,
   * and made the estimate too low by the stretch. The sum of these numbers over
   * all faces, times a constant that depends on dimension and degree only, is
   * the estimate; doc/notes/accuracy.md compares it with errors that are
   * known.
   *
   * Directions in which the boundary is held have no r; where all nodes of a
   * face are in contact, only what pulls the body off counts. What the
   * quadrature of j_1, and the polygon in place of a curved boundary, change in
   * J is not in it.
   *
   * @p functional is J(u), @p factors the multiples of the loads that @p u
   * belongs to, @p error_factor that of an AdaptiveLevel, by which the estimate
   * is multiplied. Throws
   * std::invalid_argument with the place if a load or a bond is none at a point
   * of a face that the solution did not ask for.
   *
   * To be called by all ranks that share the problem: `cells` are those of the
   * mesh that a rank has, right at its own ones, all else is the whole's.
   */
  template <int dim>
  ErrorEstimate
  estimate_error(const EstimatedProblem<dim> &of,
                 const DofVector             &u,
                 const double                 functional,
                 const LoadFactors            factors      = 1.,
                 const std::optional<double>  error_factor = {});
} // namespace Debond

#endif
