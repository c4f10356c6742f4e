// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/load_path_steps.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  template <int dim>
  LoadPathTotals
  load_path_totals(const std::vector<LoadPathStep<dim>> &steps,
                   const unsigned int                    n_factors)
  {
    // Differences that are rounding.
    constexpr double tolerance = 1e-9;

    LoadPathTotals totals;
    totals.factors = n_factors;
    totals.steps   = static_cast<unsigned int>(steps.size());
    totals.last    = steps.back().factors();

    double broken = 0.;
    for (const LoadPathStep<dim> &step : steps)
      {
        const BondChange change = {step.step,
                                   step.factor,
                                   step.displacement_factor,
                                   step.change_factor,
                                   broken,
                                   step.state.broken_part};
        const double     growth = change.broken_after - change.broken_before;
        const auto       size   = [](const std::optional<BondChange> &other) {
          return other ? std::abs(other->broken_after - other->broken_before) :
                                 tolerance;
        };
        if (growth > size(totals.largest_break))
          totals.largest_break = change;
        if (-growth > size(totals.largest_closing))
          totals.largest_closing = change;
        broken = change.broken_after;

        if (step.global)
          {
            const double excess =
              step.state.functional - step.global->functional;
            const double scale = std::abs(step.global->functional);
            ++totals.compared;
            if (excess > tolerance * scale)
              {
                ++totals.above_global;
                totals.largest_excess =
                  std::max(totals.largest_excess, excess / scale);
              }
          }
      }
    return totals;
  }


  template decltype(load_path_totals<2>) load_path_totals<2>;
  template decltype(load_path_totals<3>) load_path_totals<3>;
} // namespace Debond
