// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/output/load_path_plots.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace Debond
{
  namespace
  {
    /// A curve of a plot by its factor and state.
    template <int dim>
    using PointOfState =
      std::pair<double, double> (*)(const double, const LoadPathState<dim> &);



    std::string
    curve_title(const std::string &name, const double first, const double last)
    {
      std::ostringstream title;
      title << name << ' ' << first << " to " << last;
      return title.str();
    }



    template <int dim>
    bool
    has_constant_loads(const std::vector<LoadPathStep<dim>> &steps)
    {
      return std::all_of(steps.begin(), steps.end(), [&](const auto &step) {
        return step.factor == steps[0].factor;
      });
    }



    template <int dim>
    std::string
    name_of_factor(const std::vector<LoadPathStep<dim>> &steps)
    {
      return steps.size() > 1 && has_constant_loads(steps) ?
               "displacement factor" :
               "factor";
    }



    /// Whether the body is moved and its loads do no work that grows.
    template <int dim>
    bool
    is_moved_alone(const std::vector<LoadPathStep<dim>> &steps)
    {
      const auto any = [&](const double LoadPathState<dim>::*const number) {
        return std::any_of(steps.begin(), steps.end(), [&](const auto &step) {
          return step.state.*number != 0.;
        });
      };
      return any(&LoadPathState<dim>::unit_displacement_work) &&
             (has_constant_loads(steps) ||
              !any(&LoadPathState<dim>::unit_load_work));
    }



    /// The factor of the loads by step, or that of prescribed displacements if
    /// the loads are constant.
    template <int dim>
    std::vector<double>
    factors_of(const std::vector<LoadPathStep<dim>> &steps,
               const bool                            constant_loads)
    {
      std::vector<double> factors;
      for (const LoadPathStep<dim> &step : steps)
        factors.push_back(constant_loads ? step.displacement_factor :
                                           step.factor);
      return factors;
    }



    /// The steps at which the factor turns, with the first and the last one.
    std::vector<unsigned int>
    turning_points(const std::vector<double> &factors)
    {
      std::vector<unsigned int> turns = {0};
      double                    last  = 0.; // change that was one
      for (unsigned int k = 1; k < factors.size(); ++k)
        if (const double change = factors[k] - factors[k - 1]; change != 0.)
          {
            if (change * last < 0.)
              turns.push_back(k - 1);
            last = change;
          }
      turns.push_back(static_cast<unsigned int>(factors.size() - 1));
      return turns;
    }



    template <int dim>
    std::vector<Curve>
    curves(const std::vector<LoadPathStep<dim>> &steps,
           const std::vector<LoadPathStep<dim>> &arc,
           const PointOfState<dim>               point)
    {
      std::vector<Curve>        result;
      const bool                constant_loads = has_constant_loads(steps);
      const std::vector<double> factors     = factors_of(steps, constant_loads);
      const std::vector<unsigned int> turns = turning_points(factors);
      for (unsigned int t = 0; t + 1 < turns.size(); ++t)
        {
          Curve curve{curve_title(name_of_factor(steps),
                                  factors[turns[t]],
                                  factors[turns[t + 1]]),
                      {},
                      "linespoints pt 7 ps 0.4"};
          for (unsigned int k = turns[t]; k <= turns[t + 1]; ++k)
            curve.points.push_back(point(factors[k], steps[k].state));
          result.push_back(curve);
        }

      std::map<double, std::pair<double, double>> global;
      for (const LoadPathStep<dim> &step : steps)
        if (step.global)
          global[step.factor] = point(step.factor, *step.global);
      if (!global.empty())
        {
          Curve curve{"global branch", {}};
          for (const auto &[factor, values] : global)
            curve.points.push_back(values);
          result.push_back(curve);
        }

      if (!arc.empty())
        {
          Curve                     curve{"arc", {}};
          const std::vector<double> of_arc = factors_of(arc, constant_loads);
          for (unsigned int k = 0; k < arc.size(); ++k)
            curve.points.push_back(point(of_arc[k], arc[k].state));
          result.push_back(curve);
        }
      return result;
    }
  } // namespace



  std::vector<std::string>
  load_path_plot_names()
  {
    return {"load_path",
            "load_path_energy",
            "load_path_force",
            "load_path_displacement"};
  }



  template <int dim>
  std::vector<Plot>
  load_path_plots(const std::vector<LoadPathStep<dim>> &steps,
                  const std::vector<LoadPathStep<dim>> &arc)
  {
    using State     = LoadPathState<dim>;
    const auto make = [&steps, &arc](const std::string      &name,
                                     const std::string      &caption,
                                     const std::string      &x_label,
                                     const std::string      &y_label,
                                     const PointOfState<dim> point) {
      Plot plot{name, caption, x_label, y_label};
      plot.curves = curves(steps, arc, point);
      return plot;
    };
    const std::vector<std::string> names = load_path_plot_names();
    const std::string              label = name_of_factor(steps);
    return {make(names[0],
                 "The broken part of the contact boundary.",
                 label,
                 "broken part",
                 [](const double factor, const State &state) {
                   return std::make_pair(factor, state.broken_part);
                 }),
            make(names[1],
                 "The energy.",
                 label,
                 "J",
                 [](const double factor, const State &state) {
                   return std::make_pair(factor, state.functional);
                 }),
            make(names[2],
                 "The normal force of the foundation; negative: it pulls.",
                 label,
                 "normal force",
                 [](const double factor, const State &state) {
                   return std::make_pair(factor, state.normal_force);
                 }),
            is_moved_alone(steps) ?
              make(names[3],
                   "The forces of the supports over the displacement that they "
                   "prescribe.",
                   label,
                   "work of the supports on the unit displacement",
                   [](const double factor, const State &state) {
                     return std::make_pair(factor,
                                           state.unit_displacement_work);
                   }) :
              make(names[3],
                   "The loads over the displacement that belongs to them.",
                   "<f, u>",
                   label,
                   [](const double factor, const State &state) {
                     return std::make_pair(state.unit_load_work, factor);
                   })};
  }



  template decltype(load_path_plots<2>) load_path_plots<2>;
  template decltype(load_path_plots<3>) load_path_plots<3>;
} // namespace Debond
