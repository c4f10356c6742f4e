// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/patterns.h>
#include <debond/base/text.h>
#include <debond/study/plots.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
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



    /// The columns of a contact profile by their titles; empty if there is no
    /// such file.
    std::map<std::string, std::vector<double>>
    read_profile(const Case &one)
    {
      std::ifstream file(one.directory + "/contact_profile.csv");
      std::string   line;
      std::getline(file, line);
      const std::vector<std::string> titles =
        dealii::Utilities::split_string_list(line, ',');
      std::map<std::string, std::vector<double>> columns;
      while (std::getline(file, line))
        {
          const std::vector<std::string> entries =
            dealii::Utilities::split_string_list(line, ',');
          for (std::size_t i = 0; i < std::min(titles.size(), entries.size());
               ++i)
            {
              // Words, and values that are not finite.
              double number = std::numeric_limits<double>::quiet_NaN();
              read_number(entries[i], number);
              columns[titles[i]].push_back(number);
            }
        }
      return columns;
    }



    /// Where the nodes are along the contact boundary.
    struct Positions
    {
      std::string         label;
      std::vector<double> values;
      bool                in_a_row = true; ///< no two at the same place
    };



    /// The length along a straight boundary from its first node, or the
    /// coordinate if it is parallel to an axis; on any other boundary, as in
    /// 3D, the coordinate in which it is longest.
    Positions
    positions_along(const std::map<std::string, std::vector<double>> &profile)
    {
      std::vector<std::string>                 axes;
      std::vector<const std::vector<double> *> coordinates;
      for (const std::string axis : {"x", "y", "z"})
        if (const auto column = profile.find(axis); column != profile.end())
          {
            axes.push_back(axis);
            coordinates.push_back(&column->second);
          }
      Positions positions{"", {}};
      if (axes.empty())
        return positions;

      const std::size_t n = coordinates[0]->size();
      const auto distance = [&](const std::size_t i, const std::size_t j) {
        double sum = 0.;
        for (const auto *const x : coordinates)
          sum += ((*x)[j] - (*x)[i]) * ((*x)[j] - (*x)[i]);
        return std::sqrt(sum);
      };
      const auto farthest = [&](const std::size_t i) {
        std::size_t result = i;
        for (std::size_t j = 0; j < n; ++j)
          if (distance(i, j) > distance(i, result))
            result = j;
        return result;
      };
      const std::size_t b     = farthest(0);
      const std::size_t a     = farthest(b);
      const std::size_t first = std::min(a, b), last = std::max(a, b);
      const double      length = distance(first, last);
      if (length == 0.)
        {
          positions.label  = axes[0];
          positions.values = *coordinates[0];
          return positions;
        }

      bool        straight = true;
      std::size_t axis     = 0;
      double      largest  = 0.;
      positions.label      = "length along the contact boundary";
      for (std::size_t i = 0; i < n; ++i)
        {
          double along = 0.;
          for (const auto *const x : coordinates)
            along +=
              ((*x)[i] - (*x)[first]) * ((*x)[last] - (*x)[first]) / length;
          positions.values.push_back(along);
          const double from_first = distance(first, i);
          straight = straight && from_first * from_first - along * along <
                                   1e-12 * length * length;
        }
      for (std::size_t d = 0; d < axes.size(); ++d)
        {
          const auto [least, most] =
            std::minmax_element(coordinates[d]->begin(), coordinates[d]->end());
          const double extent = *most - *least;
          largest             = std::max(largest, extent);
          if (extent == largest)
            axis = d;
        }
      if (!straight || largest > (1. - 1e-12) * length)
        {
          positions.label  = axes[axis];
          positions.values = *coordinates[axis];
        }
      std::vector<double> sorted = positions.values;
      std::sort(sorted.begin(), sorted.end());
      for (std::size_t i = 1; i < n; ++i)
        positions.in_a_row =
          positions.in_a_row && sorted[i] - sorted[i - 1] > 1e-9 * length;
      return positions;
    }



    /// The points whose values are both finite.
    std::vector<std::pair<double, double>>
    join_columns(const std::vector<double> &x, const std::vector<double> &y)
    {
      std::vector<std::pair<double, double>> points;
      for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
        if (std::isfinite(x[i]) && std::isfinite(y[i]))
          points.emplace_back(x[i], y[i]);
      return points;
    }



    /// A quantity along the contact boundary: a curve, or points where several
    /// nodes have the same place, as in 3D.
    Plot
    profile_plot(const StudyView   &view,
                 const std::string &name,
                 const std::string &caption,
                 const std::string &y,
                 const std::string &y_label,
                 const std::string &style)
    {
      Plot plot{name, caption, "", y_label};
      for (const StudyRow &row : view.rows)
        if (row.result.has_results())
          {
            auto            profile   = read_profile(*row.one);
            const Positions positions = positions_along(profile);
            if (plot.x_label.empty())
              plot.x_label = positions.label;
            else if (plot.x_label != positions.label)
              plot.x_label = "position along the contact boundary";
            auto points = join_columns(positions.values, profile[y]);
            std::sort(points.begin(), points.end());
            plot.curves.push_back(
              {row.one->label, points, positions.in_a_row ? style : "points"});
          }
      return plot;
    }



    Plot
    displacement_plot(const StudyView &view)
    {
      return profile_plot(view,
                          "displacement",
                          "Normal displacement of the contact boundary; "
                          "negative: lifted off.",
                          "u_nu",
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
                          "normal_force_density",
                          "normal force density",
                          "linespoints pt 7 ps 0.5");
    }



    /// What the law allows between two displacements up to 0, and up to a
    /// pressure there.
    std::vector<std::pair<double, double>>
    law_graph(const ContactLawParameters &parameters,
              const double                least_u,
              const double                largest_force)
    {
      const AdhesiveLaw   law(parameters.branches);
      std::vector<double> ends = {
        std::min(least_u, -1.1 * law.bond_threshold())};
      for (const double kink : law.kinks())
        if (kink < 0.)
          ends.push_back(kink);
      ends.push_back(0.);
      std::vector<std::pair<double, double>> points;
      for (std::size_t k = 0; k + 1 < ends.size(); ++k)
        {
          // The force is linear on a branch.
          const double centre    = (ends[k] + ends[k + 1]) / 2.;
          const double force     = law.derivative(centre);
          const double curvature = law.curvature(centre);
          for (const double end : {ends[k], ends[k + 1]})
            points.emplace_back(end, force + curvature * (end - centre));
        }
      points.emplace_back(0., largest_force);
      return points;
    }



    bool
    is_same(const ContactLawParameters &a, const ContactLawParameters &b)
    {
      return std::equal(a.branches.begin(),
                        a.branches.end(),
                        b.branches.begin(),
                        b.branches.end(),
                        [](const ConvexBranch &c, const ConvexBranch &d) {
                          return c.curvature == d.curvature &&
                                 c.slope == d.slope && c.constant == d.constant;
                        });
    }



    /// One graph if all cases have the same law, else one with each case.
    Plot
    law_plot(const StudyView &view)
    {
      Plot                      plot{"law",
                "Normal force density of the contact nodes over their "
                                     "normal displacement, on the graph of the contact law.",
                "u_nu",
                "normal force density"};
      std::vector<const Case *> cases;
      double                    least_u = 0., largest_force = 0.;
      for (const StudyRow &row : view.rows)
        // Bonds that vary have no one graph.
        if (row.result.has_results() && !row.one->law.has_field())
          {
            auto profile = read_profile(*row.one);
            cases.push_back(row.one);
            plot.curves.push_back(
              {row.one->label,
               join_columns(profile["u_nu"], profile["normal_force_density"]),
               "points"});
            for (const auto &[u, force] : plot.curves.back().points)
              {
                least_u       = std::min(least_u, u);
                largest_force = std::max(largest_force, force);
              }
          }
      if (cases.empty())
        return plot;
      const auto graph_of = [&](const Case &one) {
        return law_graph(one.law, least_u, largest_force);
      };
      if (std::all_of(cases.begin(), cases.end(), [&](const Case *one) {
            return is_same(one->law, cases[0]->law);
          }))
        plot.curves.insert(plot.curves.begin(),
                           {"contact law", graph_of(*cases[0])});
      else
        for (std::size_t i = cases.size(); i-- > 0;)
          plot.curves.insert(
            plot.curves.begin() + static_cast<std::ptrdiff_t>(i) + 1,
            {"law of " + cases[i]->label, graph_of(*cases[i]), "lines", true});
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
      bool        needs_minimum                    = false;
    };



    const std::vector<PlotKind> &
    plot_kinds()
    {
      const std::string                  axis  = "a sweep over numbers > 0";
      static const std::vector<PlotKind> kinds = {
        {"history", "J over k", history_plot},
        {"convergence",
         "the error over k, both logarithmic",
         convergence_plot,
         can_always,
         "",
         true},
        {"fit",
         "the error over k with fitted lines",
         fit_plot,
         can_always,
         "",
         true},
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



  bool
  plot_needs_minimum(const std::string &name)
  {
    for (const PlotKind &kind : plot_kinds())
      if (kind.name == name)
        return kind.needs_minimum;
    return false;
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
