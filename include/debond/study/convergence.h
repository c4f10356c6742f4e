// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_convergence_h
#define debond_study_convergence_h

#include <optional>
#include <vector>

namespace Debond
{
  /// y = C x^exponent, by least squares in the logarithms.
  struct PowerLaw
  {
    double exponent;
    double factor;
  };

  /// The fit to two or more points with positive coordinates; none if the x
  /// are all the same.
  std::optional<PowerLaw>
  fit_power_law(const std::vector<double> &x, const std::vector<double> &y);

  /// How a history converges: error_k = C k^rate in a window.
  struct ConvergenceRate
  {
    PowerLaw     law;
    unsigned int first; ///< iteration, from 1
    unsigned int last;
  };

  /**
   * Fits the rate of the relative errors (J(x_k) - J_min) / |J_min| from the
   * first iteration with an error of at most @p from to the first one with at
   * most @p to, or to the last with a positive error. None if there are less
   * than three iterations in that window.
   */
  std::optional<ConvergenceRate>
  fit_rate(const std::vector<double> &relative_errors,
           const double               from,
           const double               to);

  /// (J - J_min) / |J_min| for each J.
  std::vector<double>
  relative_errors(const std::vector<double> &functionals, const double minimum);

  /// The value of a parameter that needs the fewest iterations.
  struct BestValue
  {
    double value;
    double iterations;

    /// The values next to each other that need at most 10 % more.
    double smallest_good;
    double largest_good;

    /// Whether it is the first or the last value, so that the best may be
    /// beyond it.
    bool at_end;
  };

  /// @p iterations is positive, or zero where the case failed; the values
  /// ascend or descend. None if all failed.
  std::optional<BestValue>
  best_value(const std::vector<double> &values,
             const std::vector<double> &iterations);
} // namespace Debond

#endif
