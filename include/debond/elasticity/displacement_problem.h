// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_displacement_problem_h
#define debond_elasticity_displacement_problem_h

#include <debond/elasticity/correction_solver.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/linear_algebra/views.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/majorise_minimise.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <Eigen/SparseCore>

#include <functional>
#include <vector>

namespace Debond
{
  /**
   * J = 1/2 <A u, u> - <f, u> + Phi(s), s <= 0, on all unknowns u, of which
   * some are the normal displacements s. Majorants are minimised by truncated
   * nonsmooth Newton multigrid (Graeser, Sack, Sander, 2009): one Gauss-Seidel
   * step on the contact normals, on all ranks the same; conjugate gradients
   * with a multigrid cycle for all unknowns that are not in contact, to a tenth
   * of the residual as long as the contact set changes; projection onto s <= 0
   * and an exact line search.
   *
   * Residuals are Euclidean norms of forces, relative to the largest of the
   * load, the internal forces and the forces of the foundation.
   */
  class DisplacementProblem : public MajorantProblem
  {
  public:
    State
    evaluate() override;

    bool
    majorise() override;

    /// As soon as may_go_on returns false, which each linear iteration asks, it
    /// ends and leaves u as it was before.
    Minimisation
    minimise(const double tolerance) override;

  protected:
    /// Keeps references; @p start is the current point, of which the normal
    /// displacements have to be <= 0, @p cycle the preconditioner.
    DisplacementProblem(const DofVector                 &load,
                        const PiecewiseQuadratic        &nonsmooth,
                        const std::vector<unsigned int> &normals,
                        CorrectionSolver                &cycle,
                        DofVector                       &start,
                        const std::function<bool()>     &go_on);

    /// dst = A src.
    virtual void
    multiply(DofVector &dst, const DofVector &src) const = 0;

    /// v += the columns of A of normal displacements, times @p factors.
    virtual void
    add_contact_columns(const Eigen::VectorXd &factors, DofVector &v) const = 0;

    /// The entries of all normal displacements, and <a, b>: what ranks that
    /// share the unknowns have to do together.
    virtual Eigen::VectorXd
    trace(const DofVector &v) const;

    virtual double
    product(const DofVector &a, const DofVector &b) const
    {
      return a * b;
    }

    /// The unknowns s, dealii::numbers::invalid_unsigned_int for those that
    /// other ranks have.
    const std::vector<unsigned int> normals;

    // To be set before the first call.
    DofVector                   diagonal;     ///< of A
    Eigen::SparseMatrix<double> contact_rows; ///< and columns of s, of A

  private:
    /// Products of deal.II's solvers.
    class Vector;
    struct LinearOperator;

    double
    norm(const DofVector &v) const;

    /// v += the entries of all normal displacements, as far as they are here.
    void
    add_normal(const VectorView &s, DofVector &v) const;

    /// Minus the majorant's gradient at u: a force for each unknown.
    void
    majorant_force(DofVector &force) const;

    /// dst = (A + E) src on the unknowns that are not active, zero on the
    /// others.
    void
    multiply_majorant(DofVector &dst, const DofVector &src) const;

    /// Sets the normals of active nodes to zero.
    void
    restrict_to_free(DofVector &v) const;

    /// Minimises the majorant in one normal displacement after the other.
    void
    smooth_contact(DofVector &force);

    /// Conjugate gradients to @p tolerance, an absolute one, with the nodes of
    /// the active set held. Returns false if they did not get there.
    bool
    solve_majorant(const DofVector &force,
                   const double     tolerance,
                   DofVector       &correction,
                   unsigned int    &n_iterations) const;

    const DofVector            &f;
    const PiecewiseQuadratic   &phi;
    CorrectionSolver           &cycle;
    DofVector                  &u;
    const std::function<bool()> may_go_on;

    /// As of the last evaluate().
    double largest_force  = 0.; ///< what residuals are relative to
    double force_rounding = 0.; ///< what rounding leaves in A u

    /// The majorant 1/2 <A v, v> - <f, v> + 1/2 s'E s - b_c's + const.
    Eigen::SparseMatrix<double> E;
    Eigen::VectorXd             b_c;
    ActiveSet                   active;

    /// What the cycle is prepared for.
    bool                        is_prepared = false;
    Eigen::SparseMatrix<double> cycle_E;
    ActiveSet                   cycle_active;
  };

} // namespace Debond

#endif
