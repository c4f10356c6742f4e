// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/exceptions.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

#include <debond/optimization/bound_qp.h>

#include <set>

namespace Debond
{
  namespace
  {
    /// Updates of all indices at once before the finite rule takes over. The
    /// benchmark needs at most 12 up to its mesh 640x64.
    constexpr unsigned int maximum_joint_updates = 50;



    /// Solves M_ff x_f = r_f on the given indices, zero elsewhere. LAPACK takes
    /// a third of the time of Eigen's code, which is compiled for any machine.
    /// Throws LACExceptions::ExcSingular if M_ff is not positive
    /// definite.
    void
    solve_on(const std::vector<unsigned int>         &free,
             const Eigen::Ref<const Eigen::MatrixXd> &M,
             const Eigen::VectorXd                   &r,
             Eigen::VectorXd                         &x)
    {
      if (free.empty())
        return;
      dealii::LAPACKFullMatrix<double> M_free(
        static_cast<unsigned int>(free.size()));
      dealii::Vector<double> x_free(static_cast<unsigned int>(free.size()));
      for (unsigned int l = 0; l < free.size(); ++l)
        {
          x_free(l) = r(free[l]);
          for (unsigned int k = 0; k < free.size(); ++k)
            M_free(k, l) = M(free[k], free[l]);
        }
      M_free.set_property(dealii::LAPACKSupport::symmetric);
      M_free.compute_cholesky_factorization();
      M_free.solve(x_free);
      for (unsigned int k = 0; k < free.size(); ++k)
        x(free[k]) = x_free(k);
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
    while (result.steps < maximum_active_set_steps)
      {
        ++result.steps;
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
            solve_on(free, M, r - M * result.x, result.x);
          }
        catch (const dealii::LACExceptions::ExcSingular &)
          {
            return result;
          }

        result.mu = r - M * result.x;
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
