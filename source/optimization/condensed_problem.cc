// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/full_matrix.h>

#include <debond/optimization/condensed_problem.h>
#include <debond/optimization/eigen_view.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  CondensedProblem::CondensedProblem(const dealii::FullMatrix<double> &matrix,
                                     const dealii::Vector<double>     &load,
                                     const PiecewiseQuadratic &nonsmooth,
                                     dealii::Vector<double>   &start)
    : CondensedProblem(matrix, load, nonsmooth, start, ActiveSet(start.size()))
  {
    for (unsigned int i = 0; i < s.size(); ++i)
      active[i] = s(i) == 0.;
  }



  CondensedProblem::CondensedProblem(const dealii::FullMatrix<double> &matrix,
                                     const dealii::Vector<double>     &load,
                                     const PiecewiseQuadratic &nonsmooth,
                                     dealii::Vector<double>   &start,
                                     const ActiveSet          &first_active)
    : S(matrix)
    , g(load)
    , phi(nonsmooth)
    , s(start)
    , active(first_active)
  {}



  MajorantProblem::State
  CondensedProblem::evaluate()
  {
    dealii::Vector<double> S_s(s.size()), xi(s.size());
    if (s.size() > 0)
      S.vmult(S_s, s);
    phi.subgradient(s, xi);

    State state;
    state.n_active      = 0;
    double       energy = 0., work = 0.;
    double       largest_force = 0., violation = 0.;
    const double adhesion = phi.value(s);
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        energy += 0.5 * s(i) * S_s(i);
        work += g(i) * s(i);
        // S s + xi - g + mu = 0,  mu >= 0,  s <= 0,  mu's = 0.
        const double mu = g(i) - S_s(i) - xi(i);
        violation       = std::max(violation, s(i) < 0. ? std::abs(mu) : -mu);
        largest_force   = std::max(
          {largest_force, std::abs(g(i)), std::abs(S_s(i)), std::abs(xi(i))});
        state.n_active += s(i) == 0.;
        // A maximum would lose it.
        if (std::isnan(mu))
          violation = largest_force = mu;
      }
    state.functional          = energy - work + adhesion;
    state.functional_rounding = 16. * std::numeric_limits<double>::epsilon() *
                                (energy + std::abs(work) + adhesion);
    state.residual = largest_force == 0. ? 0. : violation / largest_force;
    // Far below any tolerance that makes sense.
    state.residual_rounding = 0.;
    return state;
  }



  bool
  CondensedProblem::majorise()
  {
    // Phi <= Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
    const unsigned int                n = s.size();
    const Eigen::SparseMatrix<double> E = phi.curvature(s);
    dealii::Vector<double>            xi(n);
    phi.subgradient(s, xi);
    M = eigen_view(S);
    M += E;
    r = eigen_view(g) - eigen_view(xi) + E * eigen_view(s);
    return true;
  }



  MajorantProblem::Minimisation
  CondensedProblem::minimise(const double)
  {
    const BoundQPResult qp =
      solve_bound_qp(M, r, Eigen::VectorXd::Zero(s.size()), active);
    std::copy(qp.x.begin(), qp.x.end(), s.begin());
    return {qp.converged, qp.steps, 0};
  }
} // namespace Debond
