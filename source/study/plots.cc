// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/application/patterns.h>
#include <debond/application/text.h>
#include <debond/study/plots.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

namespace Debond
{
  namespace
  {
    struct StudyView
    {
      const StudyParameters       &study;
      const std::vector<StudyRow> &rows;
      const std::vector<BestRow>  &best;
    };



    /// Iterations that a curve is drawn through: all at first, then one in
    /// each percent.
    std::vector<std::size_t>
    drawn_iterations(const std::size_t n_iterations)
    {
      std::vector<std::size_t> iterations;
      for (std::size_t k = 1; k < n_iterations;
           k             = std::max(k + 1, k + k / 100))
        iterations.push_back(k);
      if (n_iterations > 0)
        iterations.push_back(n_iterations);
      return iterations;
    }



    Plot
    history_plot(const StudyView &view)
    {
      Plot plot{"history",
                "The functional over the iterations.",
                "iteration k",
                "J(x_k)"};
      for (const StudyRow &row : view.rows)
        {
          Curve curve{row.one->label, {}};
          for (const std::size_t k :
               drawn_iterations(row.result.history.size()))
            curve.points.emplace_back(static_cast<double>(k),
                                      row.result.history[k - 1]);
          plot.curves.push_back(curve);
        }
      return plot;
    }



    Curve
    error_curve(const StudyRow &row)
    {
      const std::vector<double> errors =
        relative_errors(row.result.history, *row.minimum);
      Curve curve{row.one->label, {}};
      for (const std::size_t k : drawn_iterations(errors.size()))
        curve.points.emplace_back(static_cast<double>(k), errors[k - 1]);
      return curve;
    }



    Plot
    convergence_plot(const StudyView &view)
    {
      Plot plot{"convergence",
                "The distance from the exact minimum of the mesh over the "
                "iterations, both logarithmic.",
                "iteration k",
                "(J(x_k) - J_min) / |J_min|",
                true,
                true};
      for (const StudyRow &row : view.rows)
        if (row.minimum)
          plot.curves.push_back(error_curve(row));
      return plot;
    }



    Plot
    fit_plot(const StudyView &view)
    {
      Plot                            plot{"fit",
                "Fitted lines C k^rate, each in the window it is fitted on.",
                "iteration k",
                "(J(x_k) - J_min) / |J_min|",
                true,
                true};
      const std::vector<std::string> &wanted = view.study.plots.fitted;
      for (const StudyRow &row : view.rows)
        {
          const bool is_wanted =
            wanted.empty() || row.one->values.empty() ||
            std::find(wanted.begin(), wanted.end(), row.one->values[0]) !=
              wanted.end();
          if (!is_wanted || !row.rate || !row.minimum)
            continue;
          plot.curves.push_back(error_curve(row));

          Curve line{"k^" + std::to_string(std::lround(row.rate->law.exponent)),
                     {},
                     "lines",
                     true};
          for (const double k : {row.rate->first, row.rate->last})
            line.points.emplace_back(k,
                                     row.rate->law.factor *
                                       std::pow(k, row.rate->law.exponent));
          plot.curves.push_back(line);
        }
      return plot;
    }



    bool
    has_positive_numbers(const Sweep &sweep)
    {
      return std::all_of(sweep.values.begin(),
                         sweep.values.end(),
                         [](const std::string &value) {
                           double number;
                           return read_number(value, number) && number > 0.;
                         });
    }



    /// The sweep that the x axis shows: the last one over positive numbers; as
    /// many as there are sweeps if there is none.
    std::size_t
    axis_sweep(const StudyParameters &study)
    {
      for (std::size_t i = study.sweeps.size(); i-- > 0;)
        if (has_positive_numbers(study.sweeps[i]))
          return i;
      return study.sweeps.size();
    }



    /// A point for each case, in one curve for each combination of the other
    /// sweeps.
    void
    add_curves_over_axis(const StudyView   &view,
                         const std::string &title,
                         const std::string &pointer,
                         Plot              &plot)
    {
      const std::size_t            axis = axis_sweep(view.study);
      std::vector<std::string>     order;
      std::map<std::string, Curve> curves;
      for (const StudyRow &row : view.rows)
        {
          std::vector<std::string> others;
          if (!title.empty())
            others.push_back(title);
          for (std::size_t i = 0; i < view.study.sweeps.size(); ++i)
            if (i != axis)
              others.push_back(view.study.sweeps[i].label + " = " +
                               row.one->values[i]);
          const std::string name = join(others, ", ");
          if (curves.count(name) == 0)
            {
              order.push_back(name);
              curves[name] = {name, {}, "linespoints pt 7 ps 0.6"};
            }
          double x;
          read_number(row.one->values[axis], x);
          if (row.result.has_results())
            curves[name].points.emplace_back(x, row.result.number(pointer));
        }
      for (const std::string &name : order)
        plot.curves.push_back(curves[name]);
    }



    Plot
    steps_plot(const StudyView &view)
    {
      Plot plot{"steps",
                "Kinds of steps.",
                view.study.sweeps[axis_sweep(view.study)].label,
                "steps",
                true};
      for (const char *kind : {"long", "short", "null"})
        add_curves_over_axis(view,
                             kind,
                             std::string("/iterations/") + kind,
                             plot);
      return plot;
    }



    Plot
    iterations_plot(const StudyView &view)
    {
      Plot plot{"iterations",
                "Iterations until the method stops.",
                view.study.sweeps[axis_sweep(view.study)].label,
                "iterations",
                true,
                true};
      add_curves_over_axis(view, "", "/iterations/total", plot);
      return plot;
    }



    Plot
    best_plot(const StudyView &view)
    {
      Plot  plot{"best",
                "The value that needs the fewest iterations, over the edge h "
                 "of the cells, with the fitted power of h.",
                "h",
                view.study.sweeps[1].label,
                true,
                true};
      Curve points{"fewest iterations", {}, "points"};
      Curve smallest{"smallest within 10 %", {}, "linespoints"};
      Curve largest{"largest within 10 %", {}, "linespoints"};
      for (const BestRow &row : view.best)
        {
          points.points.emplace_back(row.cell_edge, row.best.value);
          smallest.points.emplace_back(row.cell_edge, row.best.smallest_good);
          largest.points.emplace_back(row.cell_edge, row.best.largest_good);
        }
      plot.curves = {smallest, largest};
      if (const auto law = fit_best_values(view.best); law)
        {
          Curve line{"h^" + std::to_string(law->exponent).substr(0, 4), {}};
          for (const BestRow &row : view.best)
            line.points.emplace_back(row.cell_edge,
                                     law->factor *
                                       std::pow(row.cell_edge, law->exponent));
          plot.curves.push_back(line);
        }
      plot.curves.push_back(points);
      return plot;
    }



    /// Two columns of a contact profile.
    std::vector<std::pair<double, double>>
    profile_points(const Case &one, const std::string &x, const std::string &y)
    {
      std::ifstream file(one.directory + "/contact_profile.csv");
      std::string   line;
      std::getline(file, line);
      const std::vector<std::string> titles =
        dealii::Utilities::split_string_list(line, ',');
      const auto column = [&titles](const std::string &title) {
        return std::find(titles.begin(), titles.end(), title) - titles.begin();
      };
      const std::size_t                      i = column(x), j = column(y);
      std::vector<std::pair<double, double>> points;
      while (std::getline(file, line))
        {
          const std::vector<std::string> entries =
            dealii::Utilities::split_string_list(line, ',');
          double a, b;
          if (std::max(i, j) < entries.size() && read_number(entries[i], a) &&
              read_number(entries[j], b))
            points.emplace_back(a, b);
        }
      return points;
    }



    Plot
    profile_plot(const StudyView   &view,
                 const std::string &name,
                 const std::string &caption,
                 const std::string &x,
                 const std::string &y,
                 const std::string &style)
    {
      std::string y_label = y;
      std::replace(y_label.begin(), y_label.end(), '_', ' ');
      Plot plot{name, caption, x, y == "u_nu" ? y : y_label};
      for (const StudyRow &row : view.rows)
        if (row.result.has_results())
          plot.curves.push_back(
            {row.one->label, profile_points(*row.one, x, y), style});
      return plot;
    }



    Plot
    displacement_plot(const StudyView &view)
    {
      return profile_plot(view,
                          "displacement",
                          "Normal displacement of the contact boundary; "
                          "negative: lifted off.",
                          "x",
                          "u_nu",
                          "lines");
    }



    Plot
    force_plot(const StudyView &view)
    {
      return profile_plot(view,
                          "force",
                          "Normal force density of the contact boundary; "
                          "positive: pressed, negative: held.",
                          "x",
                          "normal_force_density",
                          "linespoints pt 7 ps 0.5");
    }



    Plot
    law_plot(const StudyView &view)
    {
      Plot plot =
        profile_plot(view,
                     "law",
                     "Normal force density of the contact nodes over their "
                     "normal displacement, on the graph of the contact law.",
                     "u_nu",
                     "normal_force_density",
                     "points");
      double least_u = 0., largest_force = 0.;
      for (const Curve &curve : plot.curves)
        for (const auto &[u, force] : curve.points)
          {
            least_u       = std::min(least_u, u);
            largest_force = std::max(largest_force, force);
          }
      const double a = view.rows.front().one->law.bond_stiffness;
      const double M = view.rows.front().one->law.bond_threshold;
      plot.curves.insert(plot.curves.begin(),
                         {"contact law",
                          {{std::min(least_u, -M), 0.},
                           {-M, 0.},
                           {-M, -a * M},
                           {0., 0.},
                           {0., largest_force}}});
      return plot;
    }



    bool
    can_always(const StudyParameters & /*study*/)
    {
      return true;
    }



    bool
    has_axis(const StudyParameters &study)
    {
      return axis_sweep(study) < study.sweeps.size();
    }



    bool
    has_second_axis(const StudyParameters &study)
    {
      return study.sweeps.size() > 1 && has_positive_numbers(study.sweeps[1]);
    }



    struct PlotKind
    {
      std::string name;
      std::string documentation;
      Plot (*make)(const StudyView &);
      bool (*is_possible)(const StudyParameters &) = can_always;
      std::string requirement                      = {};
    };



    const std::vector<PlotKind> &
    plot_kinds()
    {
      const std::string                  axis  = "a sweep over numbers > 0";
      static const std::vector<PlotKind> kinds = {
        {"history", "J over k", history_plot},
        {"convergence", "the error over k, both logarithmic", convergence_plot},
        {"fit", "the error over k with fitted lines", fit_plot},
        {"iterations",
         "iterations over the parameter",
         iterations_plot,
         has_axis,
         axis},
        {"steps",
         "kinds of steps over the parameter",
         steps_plot,
         has_axis,
         axis},
        {"best",
         "the value of the second sweep with the fewest iterations over h",
         best_plot,
         has_second_axis,
         "a second sweep over numbers > 0"},
        {"displacement", "u_nu along the contact boundary", displacement_plot},
        {"force",
         "the normal force density along the contact boundary",
         force_plot},
        {"law", "the contact nodes on the graph of the contact law", law_plot}};
      return kinds;
    }
  } // namespace



  std::string
  plot_documentation()
  {
    std::vector<std::string> words;
    for (const PlotKind &kind : plot_kinds())
      words.push_back(kind.name + ": " + kind.documentation);
    return join(words, "; ");
  }



  std::string
  why_no_plot(const std::string &name, const StudyParameters &study)
  {
    for (const PlotKind &kind : plot_kinds())
      if (kind.name == name)
        return kind.is_possible(study) ?
                 "" :
                 "the plot " + name + " needs " + kind.requirement;
    return "there is no plot '" + name + "'; known are " + plot_documentation();
  }



  std::vector<Plot>
  make_plots(const StudyParameters       &study,
             const std::vector<StudyRow> &rows,
             const std::vector<BestRow>  &best)
  {
    const StudyView   view{study, rows, best};
    std::vector<Plot> plots;
    for (const std::string &wanted : study.plots.kinds)
      for (const PlotKind &kind : plot_kinds())
        if (kind.name == wanted)
          if (const Plot plot = kind.make(view); has_points(plot))
            plots.push_back(plot);
    return plots;
  }
} // namespace Debond
