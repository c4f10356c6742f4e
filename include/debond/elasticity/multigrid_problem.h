// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_multigrid_problem_h
#define debond_elasticity_multigrid_problem_h

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/multigrid.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/majorant_problem.h>
#include <debond/optimization/piecewise_quadratic.h>

#include <Eigen/SparseCore>

#include <functional>

namespace Debond
{
  /**
   * J on all unknowns, for bodies whose factorisation would take too much
   * memory or time: majorants are minimised by active sets, and each linear
   * system is solved by conjugate gradients with a multigrid V-cycle of A as
   * preconditioner, both restricted to the unknowns that are not in contact.
   * Systems are solved to a tenth of the residual that their active set
   * started with, until that is all that the caller requires.
   *
   * Residuals are Euclidean norms of forces, relative to the largest of the
   * load, the internal forces and the forces of the foundation.
   */
  template <int dim>
  class MultigridProblem : public MajorantProblem
  {
  public:
    /// Keeps references; @p u is the current point, of which the normal
    /// displacements have to be <= 0. As soon as @p may_go_on returns false,
    /// which each linear iteration asks, minimise() ends and leaves u as it was
    /// before.
    MultigridProblem(const ElasticProblem<dim>   &problem,
                     const PiecewiseQuadratic    &phi,
                     const Multigrid             &multigrid,
                     dealii::Vector<double>      &u,
                     const std::function<bool()> &may_go_on = {});

    State
    evaluate() override;

    bool
    majorise() override;

    Minimisation
    minimise(const double tolerance) override;

  private:
    class Operator;
    class Preconditioner;

    /// Minus the majorant's gradient at u: a force for each unknown.
    void
    majorant_force(dealii::Vector<double> &force) const;

    /// Sets the normals of active nodes to zero.
    void
    restrict_to_free(dealii::Vector<double> &v) const;

    const dealii::TrilinosWrappers::SparseMatrix &A;
    const dealii::Vector<double>                 &f;
    const PiecewiseQuadratic                     &phi;
    const Multigrid                              &multigrid;
    dealii::Vector<double>                       &u;
    std::function<bool()>                         may_go_on;
    const ContactSpace<dim>                      &contact;

    /// Of contact.
    const std::vector<dealii::types::global_dof_index> &normals;

    dealii::Vector<double> diagonal; ///< of A

    /// As of the last evaluate().
    double largest_force  = 0.; ///< what residuals are relative to
    double force_rounding = 0.; ///< what rounding leaves in A u

    /// The majorant 1/2 <A v, v> - <f, v> + 1/2 s'E s - b_c's + const.
    Eigen::SparseMatrix<double> E;
    Eigen::VectorXd             b_c;
    ActiveSet                   active;
  };
} // namespace Debond

#endif
