// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_optimization_majorise_condensed_problem_h
#define debond_optimization_majorise_condensed_problem_h

#include <debond/optimization/majorise/bound_qp.h>
#include <debond/optimization/majorise/majorant_problem.h>
#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /**
   * 1/2 s'S s - g's + Phi(s) subject to s <= 0 with a dense symmetric positive
   * definite S. Majorants are minimised exactly, whatever the tolerance, by
   * active sets with a Cholesky factorisation each.
   */
  class CondensedProblem : public MajorantProblem
  {
  public:
    /// Keeps references; @p s is the current point and has to be <= 0. The
    /// active set of the first majorant starts where it is zero.
    CondensedProblem(const dealii::FullMatrix<double> &S,
                     const dealii::Vector<double>     &g,
                     const PiecewiseQuadratic         &phi,
                     dealii::Vector<double>           &s);

    State
    evaluate() override;

    bool
    majorise() override;

    Minimisation
    minimise(const double tolerance) override;

  private:
    const dealii::FullMatrix<double> &S;
    const dealii::Vector<double>     &g;
    const PiecewiseQuadratic         &phi;
    dealii::Vector<double>           &s;

    /// The majorant 1/2 s'M s - r's + const, M = S + E, once there is one.
    bool                        majorised = false;
    Eigen::SparseMatrix<double> E;
    Eigen::MatrixXd             M;
    Eigen::VectorXd             r;
    ActiveSet                   active;
  };
} // namespace Debond

#endif
