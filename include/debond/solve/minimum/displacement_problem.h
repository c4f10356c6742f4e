// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_displacement_problem_h
#define debond_solve_minimum_displacement_problem_h

#include <debond/optimization/majorise/cone_qp.h>
#include <debond/optimization/majorise/majorant.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>
#include <debond/solve/minimum/contact_unknowns.h>

namespace Debond
{
  /**
   * J = 1/2 <A u, u> - <f, u> + Phi(s), s <= upper, on all unknowns u, of which
   * some are the normal displacements s. Majorants are minimised by truncated
   * nonsmooth Newton multigrid (Graeser, Sack, Sander, 2009): one Gauss-Seidel
   * step on the contact normals, on all ranks the same; conjugate gradients
   * with a multigrid cycle for all unknowns that are not in contact, to a tenth
   * of the residual as long as the contact set changes; projection onto the
   * bounds and an exact line search.
   *
   * Residuals are Euclidean norms of forces, relative to the largest of the
   * load, the internal forces and the forces of the foundation. All functions
   * are to be called by all ranks.
   */
  class DisplacementProblem : public MajorantProblem
  {
  public:
    /// Keeps references but to @p load; @p start is the current point, of which
    /// s has to be within the bounds, @p cycle that of A. Each linear iteration
    /// asks @p interruption, which ends minimise() and leaves u as it was
    /// before.
    template <int dim>
    DisplacementProblem(const ElasticProblem<dim> &problem,
                        const DofVector           &load,
                        const PiecewiseQuadratic  &phi,
                        TruncatedMultigrid        &cycle,
                        DistributedVector         &start,
                        const Interruption        &interruption);

    State
    evaluate() override;

    bool
    majorise() override;

    Minimisation
    minimise(const double tolerance) override;

  private:
    using Vector = DistributedVector;

    /// The @p force, without that of kinks, that nothing holds.
    Eigen::VectorXd
    beyond_hold(const Eigen::VectorXd &s, const Eigen::VectorXd &force) const;

    /// Minimises the majorant in one displacement of the contact boundary after
    /// the other.
    void
    smooth_contact(Vector &force);

    /// Conjugate gradients to @p tolerance, an absolute one, with the nodes of
    /// the active set held. Returns false if they did not get there.
    bool
    solve_majorant(const Vector &force,
                   const double  tolerance,
                   Vector       &correction,
                   unsigned int &n_iterations) const;

    const DistributedMatrix          &A;
    const Vector                      f;
    const Vector                      diagonal; ///< of A
    const PiecewiseQuadratic         &phi;
    const ContactUnknowns             contact;
    const Bounds                      bounds;          ///< with Phi's kinks
    const Eigen::SparseMatrix<double> contact_block;   ///< of A
    const std::vector<unsigned int>   rows_of_contact; ///< that couple to it
    TruncatedMultigrid               &cycle;
    Vector                           &u;
    const Interruption               &interruption;

    /// The state of the last evaluate().
    Vector internal;            ///< A u
    double largest_force  = 0.; ///< what residuals are relative to
    double force_rounding = 0.; ///< what rounding leaves in A u

    /// The majorant of Phi: that of J is 1/2 <A v, v> - <f, v> + 1/2 s'E s -
    /// b's + const.
    Majorant  majorant;
    ActiveSet active;

    /// The majorant and the contact set that the cycle is prepared for.
    bool                        is_prepared = false;
    Eigen::SparseMatrix<double> cycle_E;
    ActiveSet                   cycle_active;
  };
} // namespace Debond

#endif
