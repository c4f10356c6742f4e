// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/full_matrix.h>

#include <debond/linear_algebra/eigen_view.h>
#include <debond/optimization/majorise/condensed_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    /// Of a Cholesky factorisation and two products, in units of rounding of
    /// the terms in a row of S s.
    constexpr double rounding_factor = 4.;
  } // namespace



  CondensedProblem::CondensedProblem(const dealii::FullMatrix<double> &matrix,
                                     const dealii::Vector<double>     &load,
                                     const PiecewiseQuadratic &nonsmooth,
                                     dealii::Vector<double>   &start)
    : S(matrix)
    , g(load)
    , phi(nonsmooth)
    , s(start)
    , active(start.size())
  {
    for (unsigned int i = 0; i < s.size(); ++i)
      active[i] = s(i) == 0.;
  }



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
    double       largest_terms = 0., energy_terms = 0.;
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

        // The terms of a row of S s nearly cancel.
        double terms = 0.;
        for (unsigned int j = 0; j < s.size(); ++j)
          terms += std::abs(S(i, j) * s(j));
        largest_terms = std::max(largest_terms, terms);
        energy_terms += std::abs(s(i)) * terms;
        // A maximum would lose it.
        if (std::isnan(mu))
          violation = largest_force = mu;
      }
    state.functional         = energy - work + adhesion;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    state.functional_rounding =
      epsilon * (16. * (energy + std::abs(work) + adhesion) + energy_terms);
    state.residual = largest_force == 0. ? 0. : violation / largest_force;
    state.residual_rounding =
      largest_force == 0. ?
        0. :
        rounding_factor * epsilon * largest_terms / largest_force;
    return state;
  }



  bool
  CondensedProblem::majorise()
  {
    // Phi <= Phi(s_k) + xi'(s - s_k) + 1/2 (s - s_k)'E (s - s_k).
    const unsigned int     n = s.size();
    dealii::Vector<double> xi(n);
    phi.subgradient(s, xi);
    const Eigen::SparseMatrix<double> previous_E = E;
    const Eigen::VectorXd             previous_r = r;
    E                                            = phi.curvature(s);
    const Eigen::VectorXd E_s                    = E * eigen_view(s);
    r = eigen_view(g) - eigen_view(xi) + E_s;
    if (previous_r.size() == r.size() && majorised)
      {
        constexpr double noise = 1e-12;
        // Squares of what rounding leaves of a vanishing load would underflow.
        const auto size = [](const Eigen::VectorXd &v) {
          return v.lpNorm<Eigen::Infinity>();
        };
        if (size(r - previous_r) <= noise * (size(E_s) + size(r)) &&
            (E - previous_E).norm() <= noise * E.norm())
          return false;
      }
    majorised = true;
    M         = eigen_view(S);
    M += E;
    return true;
  }



  MajorantProblem::Minimisation
  CondensedProblem::minimise(const double)
  {
    const BoundQPResult qp =
      solve_bound_qp(M, r, Eigen::VectorXd::Zero(s.size()), active);
    std::copy(qp.x.begin(), qp.x.end(), s.begin());
    return {qp.status, qp.steps, 0};
  }
} // namespace Debond
