// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/exceptions.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <debond/optimization/majorise/bound_qp.h>

#include <algorithm>
#include <set>

namespace Debond
{
  namespace
  {
    /// Updates of all indices at once before the finite rule takes over. The
    /// benchmark needs at most 12 up to its mesh 640x64.
    constexpr unsigned int maximum_joint_updates = 50;



    /// If that many updates have not found the active set, it may be for
    /// rounding in the solutions: on slender bodies small errors of forces have
    /// long levers.
    constexpr unsigned int updates_before_refinement = 15;

    constexpr unsigned int largest_number_of_refinements = 5;



    /// r - M x with sums in extended precision.
    Eigen::VectorXd
    residual(const Eigen::Ref<const Eigen::MatrixXd> &M,
             const Eigen::VectorXd                   &r,
             const Eigen::VectorXd                   &x)
    {
      Eigen::Matrix<long double, Eigen::Dynamic, 1> sum = r.cast<long double>();
      for (Eigen::Index j = 0; j < x.size(); ++j)
        if (x(j) != 0.)
          for (Eigen::Index i = 0; i < r.size(); ++i)
            sum(i) -= static_cast<long double>(M(i, j)) * x(j);
      return sum.cast<double>();
    }



    /// Solves M_ff x_f = r_f on the given indices, where x is zero before, for
    /// the other entries of x given; refined by residuals in extended precision
    /// if @p refined. LAPACK takes a third of the time of Eigen's code, which
    /// is compiled for any machine. Throws LACExceptions::ExcSingular if M_ff
    /// is not positive definite.
    void
    solve_on(const std::vector<unsigned int>         &free,
             const Eigen::Ref<const Eigen::MatrixXd> &M,
             const Eigen::VectorXd                   &r,
             const bool                               refined,
             Eigen::VectorXd                         &x)
    {
      if (free.empty())
        return;
      dealii::LAPACKFullMatrix<double> M_free(
        static_cast<unsigned int>(free.size()));
      for (unsigned int l = 0; l < free.size(); ++l)
        for (unsigned int k = 0; k < free.size(); ++k)
          M_free(k, l) = M(free[k], free[l]);
      M_free.set_property(dealii::LAPACKSupport::symmetric);
      M_free.compute_cholesky_factorization();

      dealii::Vector<double> x_free(static_cast<unsigned int>(free.size()));
      const auto             correct = [&](const Eigen::VectorXd &missing) {
        for (unsigned int k = 0; k < free.size(); ++k)
          x_free(k) = missing(free[k]);
        M_free.solve(x_free);
        for (unsigned int k = 0; k < free.size(); ++k)
          x(free[k]) += x_free(k);
      };
      correct(r - M * x);
      for (unsigned int k = 0; refined && k < largest_number_of_refinements;
           ++k)
        {
          correct(residual(M, r, x));
          if (x_free.linfty_norm() <= std::numeric_limits<double>::epsilon() *
                                        x.lpNorm<Eigen::Infinity>())
            break;
        }
    }
  } // namespace



  unsigned int
  ActiveSetRule::update(const Eigen::VectorXd &excess,
                        const Eigen::VectorXd &mu,
                        const double           excess_noise,
                        const double           mu_noise,
                        ActiveSet             &active)
  {
    const bool only_first = n_updates++ >= maximum_joint_updates;
    unsigned   changes    = 0;
    for (unsigned int i = 0; i < active.size(); ++i)
      {
        const bool wrong =
          active[i] != 0 ? mu(i) < -mu_noise : excess(i) > excess_noise;
        if (!wrong)
          continue;
        active[i] = active[i] == 0;
        ++changes;
        if (only_first)
          break;
      }
    return changes;
  }



  BoundQPResult
  solve_bound_qp(const Eigen::Ref<const Eigen::MatrixXd> &M,
                 const Eigen::VectorXd                   &r,
                 const Eigen::VectorXd                   &b,
                 ActiveSet                               &active)
  {
    const unsigned int n = static_cast<unsigned int>(r.size());
    BoundQPResult      result;
    ActiveSetRule      rule;
    // A set that comes back is one of several between which rounding decides.
    std::set<ActiveSet> seen;
    while (result.steps < std::min(maximum_active_set_steps, 100 + 2 * n))
      {
        const bool refined = result.steps++ >= updates_before_refinement;
        std::vector<unsigned int> free;
        result.x = b;
        for (unsigned int i = 0; i < n; ++i)
          if (active[i] == 0)
            {
              free.push_back(i);
              result.x(i) = 0.;
            }

        try
          {
            solve_on(free, M, r, refined, result.x);
          }
        catch (const dealii::LACExceptions::ExcSingular &)
          {
            return result;
          }

        result.mu = refined ? residual(M, r, result.x) : r - M * result.x;
        for (const unsigned int i : free)
          result.mu(i) = 0.;

        const double largest_force =
          r.lpNorm<Eigen::Infinity>() +
          (M.cwiseAbs() * result.x.cwiseAbs()).lpNorm<Eigen::Infinity>();
        if (rule.update(result.x - b,
                        result.mu,
                        active_set_noise * result.x.lpNorm<Eigen::Infinity>(),
                        active_set_noise * largest_force,
                        active) == 0 ||
            (result.steps > maximum_joint_updates &&
             !seen.insert(active).second))
          {
            result.converged = result.x.allFinite();
            result.x         = result.x.cwiseMin(b);
            return result;
          }
      }
    return result;
  }
} // namespace Debond
