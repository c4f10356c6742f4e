// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>

#include <debond/study/convergence.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    /// More iterations than the best value needs that are still good.
    constexpr double good_share = 1.1;
  } // namespace



  std::optional<PowerLaw>
  fit_power_law(const std::vector<double> &x, const std::vector<double> &y)
  {
    AssertDimension(x.size(), y.size());
    const double n      = static_cast<double>(x.size());
    double       mean_x = 0., mean_y = 0.;
    for (std::size_t i = 0; i < x.size(); ++i)
      {
        mean_x += std::log(x[i]) / n;
        mean_y += std::log(y[i]) / n;
      }
    double xx = 0., xy = 0.;
    for (std::size_t i = 0; i < x.size(); ++i)
      {
        const double dx = std::log(x[i]) - mean_x;
        xx += dx * dx;
        xy += dx * (std::log(y[i]) - mean_y);
      }
    if (!(xx > 0.))
      return {};
    return PowerLaw{xy / xx, std::exp(mean_y - xy / xx * mean_x)};
  }



  std::optional<ConvergenceRate>
  fit_rate(const std::vector<double> &relative_errors,
           const double               from,
           const double               to)
  {
    const auto first_at_most = [&](const double level) {
      return std::find_if(relative_errors.begin(),
                          relative_errors.end(),
                          [level](const double error) {
                            return error <= level;
                          });
    };
    const auto first = first_at_most(from);
    auto       last  = first_at_most(to);
    if (last == relative_errors.end() && first != last)
      --last;

    std::vector<double> k, errors;
    for (auto error = first; error != relative_errors.end() && error <= last;
         ++error)
      if (*error > 0.)
        {
          k.push_back(static_cast<double>(error - relative_errors.begin() + 1));
          errors.push_back(*error);
        }
    if (k.size() < 3)
      return {};
    const auto law = fit_power_law(k, errors);
    return ConvergenceRate{*law,
                           static_cast<unsigned int>(k.front()),
                           static_cast<unsigned int>(k.back())};
  }



  std::vector<double>
  relative_errors(const std::vector<double> &functionals, const double minimum)
  {
    std::vector<double> errors;
    for (const double functional : functionals)
      errors.push_back((functional - minimum) / std::abs(minimum));
    return errors;
  }



  std::optional<BestValue>
  best_value(const std::vector<double> &values,
             const std::vector<double> &iterations)
  {
    AssertDimension(values.size(), iterations.size());
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (iterations[i] > 0. && (!best || iterations[i] < iterations[*best]))
        best = i;
    if (!best)
      return {};

    const auto is_good = [&](const std::size_t i) {
      return iterations[i] > 0. &&
             iterations[i] <= good_share * iterations[*best];
    };
    std::size_t first = *best, last = *best;
    while (first > 0 && is_good(first - 1))
      --first;
    while (last + 1 < values.size() && is_good(last + 1))
      ++last;
    return BestValue{values[*best],
                     iterations[*best],
                     std::min(values[first], values[last]),
                     std::max(values[first], values[last]),
                     *best == 0 || *best + 1 == values.size()};
  }
} // namespace Debond
