// SPDX-License-Identifier: LGPL-2.1-or-later
// Load paths. A column that is pulled off its bonds uniformly has closed
// formulas for both branches and for the factors where it snaps, closes and
// changes its global minimum. On the benchmark: what follows from the structure
// of the problem (between changes of the bonds displacements are proportional
// to the factor and J is quadratic in it; dJ/d(factor) = -<f, u>; the least J
// is concave in the squared factor), and values of J from an independent code.

#include <debond/solve/load_path.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <sstream>

#include "../check.h"
#include "solved.h"

using namespace Debond;

namespace
{
  template <int dim>
  using Steps = std::vector<LoadPathStep<dim>>;

  template <int dim>
  using Path = FollowedPath<dim>;



  template <int dim>
  Path<dim>
  follow(const Parameters &parameters, const Scene<dim> &scene)
  {
    return follow_load_path<dim>(
      parameters.load_path,
      settings_of(parameters, scene),
      scene,
      {},
      [](const auto &...) {},
      nullptr);
  }



  template <int dim>
  Path<dim>
  follow(const Values &assignments)
  {
    const Parameters parameters = parameters_of(assignments);
    return follow<dim>(parameters, scene_of<dim>(parameters));
  }



  Values
  benchmark(const Values &others)
  {
    return Values{"Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)",
                  "Contact law/Bond stiffness=690"} +
           others;
  }



  /// Along a curve of stationary states the derivative of J by the factor is
  /// the work on the unit load or displacement, which is linear between
  /// breakpoints. The largest difference, relative to J's own largest one.
  template <int dim>
  double
  derivative_error(const Steps<dim> &arc)
  {
    double error = 0., largest = 0.;
    for (unsigned int k = 1; k < arc.size(); ++k)
      {
        const auto  &before = arc[k - 1], &after = arc[k];
        const double change =
          (after.displacement_factor - before.displacement_factor) *
            (before.state.unit_displacement_work +
             after.state.unit_displacement_work) /
            2. -
          (after.factor - before.factor) *
            (before.state.unit_load_work + after.state.unit_load_work) / 2.;
        raise(error,
              std::abs(after.state.functional - before.state.functional -
                       change));
        raise(largest, std::abs(change));
      }
    return error / largest;
  }



  void
  test_factors()
  {
    section("Factors");
    for (const std::string text : {"",
                                   "1",
                                   "0.5, 1, 1, -2",
                                   "0:0.1:0.3",
                                   "0:0.05:0.15, 0.15:-0.05:-0.1",
                                   "-1:0.25:1, 1:-1:0, 3",
                                   "0:0.3:1",
                                   "1:0.1:0",
                                   "0:0:1",
                                   "0:1",
                                   "0:1:2:3",
                                   "0:0.1:one",
                                   "1,, 2",
                                   "1e999",
                                   "0:1e-6:1"})
      {
        std::cout << "  " << text << " ->";
        try
          {
            for (const double factor : parse_load_factors(text))
              std::cout << ' ' << factor;
          }
        catch (const std::invalid_argument &error)
          {
            std::cout << " error: " << error.what();
          }
        std::cout << '\n';
      }

    const std::vector<double> up_and_down =
      parse_load_factors("0:0.07:2.8, 2.8:-0.07:0");
    bool same = up_and_down.size() == 81;
    for (unsigned int k = 0; k < up_and_down.size(); ++k)
      same = same && up_and_down[k] == up_and_down[80 - k];
    check("  loading and unloading meet the same factors", same);
  }



  /// Height H, stiffness E/H per area, nu = 0, clamped at the top, pulled off
  /// its bonds at the bottom by the traction t = 1 times the factor. Bonded:
  /// |u_nu| = t / (E/H + a) until that is M. Broken: |u_nu| = t / (E/H) as long
  /// as that is more than M.
  template <int dim>
  Values
  column(const Values &others)
  {
    const Values shared = {"Material/Young modulus=10",
                           "Material/Poisson ratio=0",
                           "Boundary conditions/Contact boundary=bottom",
                           "Boundary conditions/Clamped boundaries=top",
                           "Contact law/Bond stiffness=150",
                           "Contact law/Bond threshold=0.01",
                           "Contact law/Tangential displacement=free",
                           "Load path/Factors=0:0.07:2.8, 2.8:-0.07:0"};
    const Values body   = dim == 2 ? Values{"Mesh/Lengths=0.3, 0.2",
                                          "Mesh/Cells=3, 2",
                                          "Loads/Traction bottom=0; 1"} :
                                     Values{"Dimension=3",
                                          "Mesh/Lengths=0.3, 0.2, 0.1",
                                          "Mesh/Cells=2, 2, 1",
                                          "Loads/Traction bottom=0; 1; 0"};
    return shared + body + others;
  }



  /// @p quadrature: of quadratic displacements, empty for linear ones with a
  /// proof.
  template <int dim>
  void
  test_column(const std::string &quadrature = "")
  {
    const double E = 10., H = 0.2, a = 150., M = 0.01, k = E / H;
    const double area         = dim == 2 ? 0.3 : 0.3 * 0.1;
    const bool   is_quadratic = !quadrature.empty();

    const Path<dim> path = follow<dim>(
      is_quadratic ? column<dim>({"Mesh/Degree=2",
                                  "Contact law/Quadrature=" + quadrature,
                                  "Load path/Global branch=search"}) :
                     column<dim>({"Load path/Global branch=prove"}));

    const double snap = M * (k + a), closing = M * k;
    const double exchange = M * std::sqrt(k * (k + a));
    const auto   energy   = [&](const double factor, const bool broken) {
      return area * (broken ? 0.5 * a * M * M - 0.5 * factor * factor / k :
                                  -0.5 * factor * factor / (k + a));
    };

    bool         broken = false, states = true, words = true;
    double       energy_error = 0., gap_error = 0., law_violation = 0.;
    double       snap_error = 1., closing_error = 1.;
    const double scale = std::abs(energy(2.8, true));
    for (const auto &step : path.steps)
      {
        const bool was_broken = broken;
        broken = was_broken ? step.factor > closing : step.factor > snap;
        if (broken && !was_broken && step.change_factor)
          snap_error = std::abs(*step.change_factor - snap);
        if (!broken && was_broken && step.change_factor)
          closing_error = std::abs(*step.change_factor - closing);
        states = states && step.status == "success" &&
                 std::abs(step.state.broken_part - broken) < 1e-12;
        raise(energy_error,
              std::abs(step.state.functional - energy(step.factor, broken)));
        raise(gap_error,
              std::abs(step.state.mean_gap -
                       step.factor / (broken ? k : k + a)));
        raise(law_violation, step.state.law_violation);

        const bool least_is_broken = step.factor > exchange;
        states                     = states && step.global &&
                 std::abs(step.global->broken_part - least_is_broken) < 1e-12;
        raise(energy_error,
              std::abs(step.global->functional -
                       energy(step.factor, least_is_broken)));
        const std::string known =
          is_quadratic && step.factor != 0. ? "best known" : "global";
        words = words && step.global->minimum == known &&
                step.state.minimum ==
                  (broken == least_is_broken ? known : "local minimum");
      }
    section("Column in ",
            dim,
            "D",
            (is_quadratic ? ", quadratic, " + quadrature : ""));
    check("  81 steps", path.steps.size() == 81);
    check("  states of both branches as in theory", states);
    check("  words", words);
    check("  error of the snap at M (E/H + a)", snap_error, 1e-12);
    check("  error of the closing at M E/H", closing_error, 1e-12);
    check("  error of J", energy_error / scale, 1e-12);
    check("  error of the gap", gap_error, 1e-13);
    check("  law violation", law_violation, 1e-11);
  }



  /// The same column with bonds that do not heal: once broken, it stays on the
  /// second branch, also where it would close, and is pressed on the foundation
  /// without bonds.
  template <int dim>
  void
  test_column_for_good(const std::string &quadrature, const int degree)
  {
    const double    a = 150., M = 0.01, k = 10. / 0.2;
    const double    area = dim == 2 ? 0.3 : 0.3 * 0.1;
    const Path<dim> path = follow<dim>(
      column<dim>({"Mesh/Degree=" + std::to_string(degree),
                   "Contact law/Quadrature=" + quadrature,
                   "Load path/Factors=-1, 0:0.07:2.8, 2.8:-0.07:0, -1, 1",
                   "Load path/Bonds heal=false"}));
    double energy_error = 0., dissipated_error = 0., zone_error = 0.,
           snap_error      = 1.;
    unsigned int n_changes = 0;
    bool         broken    = false;
    for (const auto &step : path.steps)
      {
        broken              = broken || step.factor > M * (k + a);
        const double pulled = std::max(0., step.factor);
        raise(energy_error,
              std::abs(step.state.functional -
                       area * (broken ?
                                 0.5 * a * M * M - 0.5 * pulled * pulled / k :
                                 -0.5 * pulled * pulled / (k + a))));
        raise(dissipated_error,
              std::abs(step.state.dissipated_energy -
                       (broken ? 0.5 * a * M * M * area : 0.)));
        // Closed cracks are not open.
        zone_error =
          std::max(zone_error,
                   std::abs(step.state.broken_zone -
                            (broken && step.factor > 0. ? area : 0.)));
        if (step.change_factor)
          {
            ++n_changes;
            snap_error = std::abs(*step.change_factor - M * (k + a));
          }
      }
    const double scale = area * a * M * M;
    section("Bonds that do not heal in ",
            dim,
            "D, degree ",
            degree,
            ", ",
            quadrature);
    check("  all steps", path.steps.size() == 84);
    check("  one change, the snap", n_changes == 1);
    check("  error of the snap", snap_error, 1e-12);
    check("  error of J", energy_error / scale, 1e-12);
    check("  error of the dissipated energy", dissipated_error / scale, 1e-12);
    check("  error of the broken zone", zone_error / area, 1e-12);
  }



  /// Nothing but the foundation holds the block, and without a pressure on it
  /// there are many minima with one J. Pressed by q times the factor t over a
  /// gap g: J = -A (t q g + (t q)^2 H/(2 E)), stretched by t e: E (t e)^2 / 2
  /// for each volume, cooled so that it shrinks by t e: -E (t e)^2 / (1 - nu),
  /// in 3D -3/2 E (t e)^2 / (1 - 2 nu).
  template <int dim>
  void
  test_without_pressure()
  {
    const double E = 10., nu = 0.3, L = 0.3, H = 0.2, g = 0.02, q = 0.4,
                 e    = 0.005;
    const double area = dim == 2 ? L : L * 0.1;
    const Values block =
      Values{"Material/Young modulus=10",
             "Material/Poisson ratio=0.3",
             "Material/Thermal expansion=1e-3",
             "Boundary conditions/Clamped boundaries=",
             "Boundary conditions/Contact boundary=bottom",
             "Contact law/Law=none",
             "Contact law/Tangential displacement=free",
             "Load path/Global branch=none"} +
      (dim == 2 ? Values{"Mesh/Lengths=0.3, 0.2",
                         "Mesh/Cells=6, 4",
                         "Boundary conditions/Roller boundaries=left"} :
                  Values{"Dimension=3",
                         "Mesh/Lengths=0.3, 0.2, 0.1",
                         "Mesh/Cells=3, 3, 2",
                         "Boundary conditions/Roller boundaries=left, back"});
    const auto test = [&](const std::string                         &name,
                          const Values                              &others,
                          const std::function<double(const double)> &energy) {
      const Path<dim> path  = follow<dim>(block + others);
      double          error = 0., largest = 0.;
      bool            verified = true;
      for (const auto &step : path.steps)
        {
          const double expected = energy(step.displacement_factor);
          raise(largest, std::abs(expected));
          raise(error, std::abs(step.state.functional - expected));
          verified = verified && step.status == "success";
        }
      check("  " + name + ", all steps", path.steps.size() == 5 && verified);
      check("  " + name + ", error of J", error / largest, 1e-11);
    };
    const std::string others = dim == 3 ? "; free" : "";
    section("Without pressure on the foundation in ", dim, "D");
    test("over a gap",
         {"Contact law/Initial gap=0.02",
          std::string("Loads/Traction top=0; -0.4") + (dim == 3 ? "; 0" : ""),
          "Load path/Factors=0, 0.5, 0, 2, 0"},
         [&](const double t) {
           return -area * (t * q * g + t * q * t * q * H / (2. * E));
         });
    test("stretched and squeezed",
         {"Boundary conditions/Displacement right=0.0015; free" + others,
          "Load path/Displacement factors=0, 1, -1, 2, 0"},
         [&](const double t) { return 0.5 * E * t * e * t * e * area * H; });
    test("cooled and heated",
         {"Loads/Temperature change=-5", "Load path/Factors=0, 1, -1, 2, 0"},
         [&](const double t) {
           return -E * t * e * t * e * area * H *
                  (dim == 2 ? 1. / (1. - nu) : 1.5 / (1. - 2. * nu));
         });
  }



  /// Pulled by its top, the column has a linear way from the prescribed
  /// displacement d = 0 to the snap at M (1 + a/k), has no force then, and
  /// closes at M.
  template <int dim>
  void
  test_moved_column(const std::string &name,
                    const Values      &entries,
                    const unsigned int n_steps)
  {
    const double    a = 150., M = 0.01, k = 10. / 0.2;
    const double    area = dim == 2 ? 0.3 : 0.3 * 0.1, snap = M * (1. + a / k);
    const Path<dim> path =
      follow<dim>(column<dim>(Values{"Boundary conditions/Clamped boundaries=",
                                     "Loads/Traction bottom=",
                                     "Load path/Factors="} +
                              entries));
    double error = 0., force_error = 0., change_error = 0.;
    bool   broken = false, verified = true;
    for (const auto &step : path.steps)
      {
        const double d          = step.displacement_factor;
        const bool   was_broken = broken;
        broken                  = broken ? d > M : d > snap;
        if (step.change_factor)
          raise(change_error,
                std::abs(*step.change_factor - (was_broken ? M : snap)));
        const double stiffness = d < 0. ? k : broken ? 0. : k * a / (k + a);
        const double energy =
          0.5 * stiffness * d * d + (broken ? 0.5 * a * M * M : 0.);
        raise(error, std::abs(step.state.functional - area * energy));
        raise(force_error,
              std::abs(step.state.unit_displacement_work -
                       area * stiffness * d));
        verified = verified && step.status == "success";
      }
    section("Column moved in ", dim, "D, ", name);
    check("  all steps", path.steps.size() == n_steps && verified);
    check("  error of snaps and closings", change_error / snap, 1e-12);
    check("  error of J", error / (area * a * M * M), 1e-12);
    check("  error of dJ/d(factor)", force_error / (area * a * M), 1e-11);
  }



  /// Clamped at its top and moved by it, with quadratic displacements; and a
  /// tack test, in which it is pressed on the foundation and lifted again. In
  /// 2D the mesh is fine there: rounding adds up in the sum of all forces.
  template <int dim>
  void
  test_moved_columns(const std::string &quadrature)
  {
    const bool is_3d = dim == 3;
    test_moved_column<dim>(
      "quadratic, " + quadrature,
      {"Mesh/Degree=2",
       "Contact law/Quadrature=" + quadrature,
       std::string("Boundary conditions/Displacement top=0; 1") +
         (is_3d ? "; 0" : ""),
       "Load path/Displacement factors=-0.01, 0:0.003:0.06, 0.06:-0.003:0"},
      43);
    test_moved_column<dim>(
      "tack test",
      {is_3d ? "Mesh/Cells=3, 3, 2" : "Mesh/Cells=24, 16",
       std::string("Boundary conditions/Roller boundaries=left") +
         (is_3d ? ", back" : ""),
       std::string("Boundary conditions/Displacement top=free; 1") +
         (is_3d ? "; free" : ""),
       "Load path/Displacement factors=0:0.011:0.099, -0.01, 0.03, 0.05, 0.2, "
       "0, 0.1"},
      16);
  }



  /// What holds for any path: of differences, at @p least of the first @p
  /// n_steps.
  void
  check_structure(const Path<2>     &path,
                  const unsigned int least   = 30,
                  const unsigned int n_steps = 1000)
  {
    const Steps<2> &steps     = path.steps;
    double          quadratic = 0., work = 0., above = 0., error = 0.;
    unsigned int    n_compared = 0;
    for (unsigned int k = 0; k < steps.size(); ++k)
      {
        const auto  &state = steps[k].state;
        const double scale = state.elastic_energy + state.adhesion_energy +
                             std::abs(steps[k].factor * state.unit_load_work);
        error = std::max({error,
                          state.law_violation,
                          state.equilibrium_residual,
                          state.force_imbalance});
        if (steps[k].global)
          raise(above,
                (steps[k].global->functional - state.functional) /
                  (scale + 1e-300));
        if (k == 0 || k + 1 == steps.size() || k >= n_steps ||
            steps[k - 1].state.broken_part != state.broken_part ||
            steps[k + 1].state.broken_part != state.broken_part ||
            steps[k - 1].factor == steps[k + 1].factor)
          continue;
        ++n_compared;
        const double left  = steps[k - 1].state.functional;
        const double right = steps[k + 1].state.functional;
        const double h     = steps[k + 1].factor - steps[k - 1].factor;
        raise(work,
              std::abs((right - left) / h + state.unit_load_work) *
                std::abs(h) / scale);
        const double third = right - 2. * state.functional + left +
                             0.5 * h *
                               (steps[k + 1].state.unit_load_work -
                                steps[k - 1].state.unit_load_work) /
                               2.;
        raise(quadratic, std::abs(third) / scale);
      }
    check("  both differences at many steps", n_compared >= least);
    check("  error of dJ/d(factor) = -<f, u>", work, 1e-10);
    check("  error of second differences of J", quadratic, 1e-10);
    check("  global branch above the followed one by", above, 1e-12);
    check("  violation of the law", error, 1e-9);
  }



  const LoadPathStep<2> &
  step_at(const Steps<2> &steps, const double factor)
  {
    for (const auto &step : steps)
      if (step.factor == factor)
        return step;
    throw std::invalid_argument("no step with this factor");
  }



  void
  test_benchmark()
  {
    section("Benchmark with a = 690");
    const Path<2> path =
      follow<2>(benchmark({"Load path/Factors=0:0.1:2.5, 2.5:-0.1:0"}));
    check_structure(path);

    const LoadPathStep<2> &full = step_at(path.steps, 1.);
    check("  error of J of the intact state at factor 1",
          std::abs(full.state.functional / -7.354549556e-05 - 1.),
          1e-9);
    check("  error of J of the global branch at factor 1",
          std::abs(full.global->functional / -2.3973127534e-04 - 1.),
          1e-10);
    check("  it is known to be no global minimum, which is found",
          full.state.minimum == "local minimum" &&
            full.global->minimum == "global");

    // The gap of the intact state is proportional to the factor.
    const LoadPathTotals totals = load_path_totals(path.steps, 51);
    const double         snap   = 0.002 / full.state.largest_gap;
    check("  error of the snap where the largest gap is M",
          std::abs(*totals.largest_break->change_factor / snap - 1.),
          1e-11);
    check("  snap in the step that passes this factor",
          totals.largest_break->factor > snap &&
            totals.largest_break->factor < snap + 0.1 &&
            totals.largest_break->broken_before == 0.);
    check("  bonds close below factor 1, with less load than they break",
          totals.largest_closing->factor < 1. &&
            totals.largest_closing->broken_after == 0.);
    const auto &last = path.steps.back().state;
    check("  nothing is left at rest",
          last.functional == 0. && last.largest_gap == 0. &&
            last.minimum == "global" && path.result.u.linfty_norm() == 0.);

    // The least of parabolas in the factor is concave in its square.
    double convexity = 0.;
    for (unsigned int k = 1; k < 25; ++k)
      {
        const auto &left = path.steps[k - 1], &middle = path.steps[k],
                   &right = path.steps[k + 1];
        const double x0   = left.factor * left.factor,
                     x1   = middle.factor * middle.factor,
                     x2   = right.factor * right.factor;
        const double line = (left.global->functional * (x2 - x1) +
                             right.global->functional * (x1 - x0)) /
                            (x2 - x0);
        raise(convexity,
              (line - middle.global->functional) /
                std::abs(right.global->functional));
      }
    check("  convexity of the global branch in the squared factor",
          convexity,
          1e-12);

    const Path<2> halved =
      follow<2>(benchmark({"Load path/Factors=0:0.05:2.5, 2.5:-0.05:0",
                           "Load path/Global branch=none"}));
    const LoadPathTotals halved_totals = load_path_totals(halved.steps, 101);
    check("  difference of the snap with half the steps",
          std::abs(*halved_totals.largest_break->change_factor / snap - 1.),
          1e-11);
    double difference = 0.;
    for (unsigned int k = 0; k <= 20; ++k)
      raise(difference,
            std::abs(halved.steps[2 * k].state.functional -
                     path.steps[k].state.functional));
    check("  difference of the branch with half the steps up to the snap",
          difference / std::abs(path.steps[20].state.functional),
          1e-12);
    check("  no global branch if none is wanted",
          !halved.steps[10].global && !halved.steps[10].relative_gap);
  }



  void
  test_single_factor()
  {
    section("One factor");
    const Path<2>     path   = follow<2>(benchmark({"Load path/Factors=1"}));
    const Parameters  single = parameters_of(benchmark({"Solver/Search=none"}));
    const SolveResult result = solved(single, scene_of<2>(single));
    DofVector         difference = result.u;
    difference -= path.result.u;
    check("  the same number of iterations as a single run",
          result.iterations == path.result.iterations);
    check("  difference of the displacements",
          difference.linfty_norm() / result.u.linfty_norm(),
          1e-13);
    check("  difference of J",
          std::abs(result.functional / path.result.functional - 1.),
          1e-12);

    const Path<2> half = follow<2>(benchmark({"Load path/Factors=0.5"}));
    check(
      "  error of a quarter of J under half the load, also in the history",
      std::max(std::abs(4. * half.result.functional / result.functional - 1.),
               std::abs(4. * half.result.majorise_history.back().functional /
                          result.functional -
                        1.)),
      1e-12);
  }



  void
  test_other_laws()
  {
    for (const Values &entries :
         std::vector<Values>{{"Contact law/Quadrature=gauss 2"},
                             {"Contact law/Quadrature=gauss 4",
                              "Mesh/Degree=2"}})
      {
        const Path<2> gauss =
          follow<2>(benchmark(Values{"Load path/Factors=0:0.1:2.5, 2.5:-0.1:0",
                                     "Load path/Global branch=none"} +
                              entries));
        section(entries.front());
        // Up to the snap; later on points break between nodes.
        check_structure(gauss, 19, 20);
        double largest = 0.;
        for (const auto &step : gauss.steps)
          raise(largest, step.state.broken_part);
        check("  bonds break", largest > 0.5);
        const LoadPathTotals totals = load_path_totals(gauss.steps, 51);
        const double         snap   = *totals.largest_break->change_factor;
        check("  the factor of the snap is in its step",
              snap <= totals.largest_break->factor &&
                snap >= totals.largest_break->factor - 0.1);
        // Where the largest gap is M; that at a Gauss point is less.
        check("  after that of nodes",
              snap >= 0.002 / gauss.steps[10].state.largest_gap * (1. - 1e-2));
        const auto &last = gauss.steps.back().state;
        check("  nothing is left at rest",
              last.functional == 0. && last.largest_gap == 0.);
      }

    section("No adhesion, both signs of the load");
    const Path<2> contact =
      follow<2>(benchmark({"Load path/Factors=-1, -0.5, 0.25, 0.5, 1",
                           "Contact law/Law=none",
                           "Mesh/Cells=20, 2"}));
    const auto &steps = contact.steps;
    check(
      "  error of J, quadratic for each sign",
      std::max(
        std::abs(steps[0].state.functional / steps[1].state.functional - 4.),
        std::abs(steps[4].state.functional / steps[3].state.functional - 4.)),
      1e-12);
    check("  all are global minima",
          steps[0].state.minimum == "global" &&
            steps[3].state.minimum == "global");
    check("  no bond that changes",
          !steps[2].change_factor && !steps[3].change_factor);
  }



  void
  test_failures()
  {
    section("Failures");
    const Path<2> limited =
      follow<2>(benchmark({"Load path/Factors=0:0.5:4",
                           "Solver/Majorise minimise/Maximum iterations=2"}));
    check(
      "  few iterations",
      limited.steps.size() == 6 &&
        limited.result.status == SolverStatus::iteration_limit &&
        limited.steps.back().message.find(
          "load path, step 6, factor 2.5: majorise-minimise: relative residual") ==
          0);

    const Path<2> unverified = follow<2>(benchmark(
      {"Load path/Factors=0:0.5:4", "Verification/Tolerance=1e-300"}));
    check("  no verification",
          unverified.steps.size() == 2 &&
            unverified.steps.back().status == "not verified" &&
            unverified.steps.back().message.find(
              "load path, step 2, factor 0.5: verification") == 0);
  }


  /// The same column, pulled by a traction or by its top: from 0 along the
  /// bonded states to the snap, then with the gap M and a falling pull of the
  /// bonds back to where they close, then along the broken states.
  template <int dim>
  void
  test_column_arc(const bool is_moved)
  {
    const double E = 10., H = 0.2, a = 150., M = 0.01, k = E / H;
    const double area    = dim == 2 ? 0.3 : 0.3 * 0.1;
    const double snap    = is_moved ? M * (1. + a / k) : M * (k + a),
                 closing = is_moved ? M : M * k, end = 1.4 * snap;

    const std::string factors =
      "0:" + std::to_string(end / 20.) + ":" + std::to_string(end);
    Values scene =
      column<dim>({"Load path/Global branch=none", "Load path/Arc=true"});
    if (is_moved)
      scene = with(scene,
                   {"Boundary conditions/Clamped boundaries=",
                    std::string("Boundary conditions/Displacement top=0; 1") +
                      (dim == 3 ? "; 0" : ""),
                    "Loads/Traction bottom=",
                    "Load path/Factors=",
                    "Load path/Displacement factors=" + factors});
    else
      scene.push_back("Load path/Factors=" + factors);
    const Path<dim> path = follow<dim>(scene);

    section("Arc of the column in ",
            dim,
            "D, ",
            (is_moved ? "moved" : "loaded"));
    const auto &arc = path.arc;
    // From rest the body leaves the foundation at once.
    unsigned int first = 0;
    while (first + 1 < arc.size() && arc[first + 1].state.largest_gap == 0.)
      ++first;
    check("  rest, snap, closing and end", arc.size() == first + 4);
    if (arc.size() != first + 4)
      return;
    const std::vector<double> where = {0., snap, closing, end};
    const std::vector<double> gaps  = {0., M, M, is_moved ? end : end / k};
    const Values words        = {"stable", "stable", "unstable", "stable"};
    double       factor_error = 0., gap_error = 0., energy_error = 0.,
           work_error = 0., law_violation = 0.;
    bool named = true;
    for (unsigned int i = 0; i < 4; ++i)
      {
        const auto  &step   = arc[first + i];
        const double factor = is_moved ? step.displacement_factor : step.factor;
        const double w      = gaps[i];
        const double bonds  = 0.5 * a * std::min(w, M) * std::min(w, M);
        const double energy =
          area * (is_moved ? 0.5 * k * (where[i] - w) * (where[i] - w) + bonds :
                             0.5 * k * w * w + bonds - where[i] * w);
        const double work = is_moved ? area * k * (where[i] - w) : area * w;
        raise(factor_error, std::abs(factor - where[i]) / snap);
        gap_error = std::max({gap_error,
                              std::abs(step.state.mean_gap - w) / M,
                              std::abs(step.state.largest_gap - w) / M});
        raise(energy_error,
              std::abs(step.state.functional - energy) / (area * a * M * M));
        raise(work_error,
              std::abs((is_moved ? step.state.unit_displacement_work :
                                   step.state.unit_load_work) -
                       work) /
                (area * (is_moved ? a * M : M)));
        // Of a column that moves without bonds all forces are rounding.
        if (work != 0.)
          raise(law_violation, step.state.law_violation);
        named = named && step.status == words[i];
      }
    check("  factors", factor_error, 1e-12);
    check("  gaps", gap_error, 1e-12);
    check("  J", energy_error, 1e-12);
    check("  work on the unit load or displacement", work_error, 1e-12);
    check("  contact law", law_violation, 1e-9);
    check("  the way back is unstable", named);
    double error = 1.;
    for (const auto &step : path.steps)
      if (step.change_factor)
        error = std::abs(*step.change_factor - snap) / snap;
    check("  the followed path snaps there", error, 1e-12);
  }



  struct Refined
  {
    std::string  name;
    Values       scene;
    double       target;
    Values       uniform; ///< much finer
    unsigned int most_unknowns;
  };



  /// One mesh for all factors, beside a uniform one that is much finer (of the
  /// least J that of linear displacements is off by 7e-4).
  void
  test_refined(const Refined &test)
  {
    section("A path on a refined mesh, ", test.name);
    const Values scene = Values{"Contact law/Bond stiffness=69",
                                "Mesh/Cells=20,2",
                                "Load path/Factors=0.5:0.5:2",
                                "Load path/Global branch=none"} +
                         test.scene;
    const double     target = test.target;
    const Parameters parameters =
      parameters_of(with(benchmark(scene),
                         {"Accuracy/Target=" + std::to_string(target),
                          "Solver/Method=automatic"}));
    const auto [mesh, levels, result] = refined<2>(parameters);
    check("  no shortfall", result.shortfall.empty());
    check("  the estimate is below the target",
          levels.back().estimated_error,
          target);
    check("  that of the mesh before is not",
          levels.size() > 1 &&
            levels[levels.size() - 2].estimated_error > target);

    const Path<2> on_refined = follow<2>(parameters, *mesh);
    const Path<2> on_uniform = follow<2>(benchmark(scene) + test.uniform);
    check("  all factors", on_refined.steps.size() == on_uniform.steps.size());
    // The estimate is of J with the bonds as they are: that other bonds broke
    // for good on the way is no part of it.
    const auto stored = [](const Path<2> &path, const unsigned int k) {
      const auto &state = path.steps[k].state;
      return state.functional - state.dissipated_energy;
    };
    double error = 0.;
    for (unsigned int k = 0; k < on_uniform.steps.size(); ++k)
      raise(error,
            std::abs(1. - stored(on_refined, k) / stored(on_uniform, k)));
    check("  J at all factors", error, 1.25 * target);
    check("  fewer unknowns than the uniform mesh",
          mesh->problem().unknowns().n_dofs() < test.most_unknowns);
  }



  /// All bonds break, and the body is unloaded until their gaps are less than
  /// M: what is left is that without bonds, and so is its estimate, also on
  /// refined meshes.
  void
  test_estimate_for_good()
  {
    for (const int degree : {1, 2})
      {
        std::cout << "The estimate after unloading, bonds do not heal, degree "
                  << degree << '\n';
        const Values scene    = {"Loads/Traction top=0; 0.69",
                                 "Load path/Global branch=none",
                                 "Contact law/Bond threshold=1e-6",
                                 "Mesh/Degree=" + std::to_string(degree),
                                 std::string("Contact law/Quadrature=") +
                                   (degree == 1 ? "nodal" : "gauss 3"),
                                 "Solver/Method=automatic"};
        const auto   estimate = [&](const Values &others) {
          const Parameters parameters =
            parameters_of(benchmark(scene) + others);
          const Scene<2> here   = scene_of<2>(parameters);
          double         result = 0.;
          follow_load_path<2>(
            parameters.load_path,
            settings_of(parameters, here),
            here,
            {},
            [&](const auto &progress,
                const auto   &/*verification*/,
                const auto &bonds) {
              const auto &step = progress.steps.back();
              result           = estimate_error<2>({here.problem(),
                                                    bonds,
                                                    here.conditions(),
                                                    here.supports(),
                                                    here.loads(),
                                                    &here.dead_loads()},
                                         progress.u,
                                         step.state.functional,
                                         step.factors())
                         .functional;
            },
            nullptr);
          return result;
        };
        const double for_good =
          estimate({"Load path/Factors=1, 1e-5", "Load path/Bonds heal=false"});
        const double none =
          estimate({"Load path/Factors=1, 1e-5", "Contact law/Law=none"});
        const double healed = estimate({"Load path/Factors=1, 1e-5"});
        // Of nodes those of the clamped corners hold.
        check("  is that without bonds",
              std::abs(for_good / none - 1.),
              degree == 1 ? 3e-3 : 1e-9);
        check("  which is not that with bonds",
              std::abs(healed / none - 1.) > 0.1);
      }
  }



  /// A body that only bonds hold comes off on the way: the factors before that
  /// have a mesh.
  void
  test_refined_until_it_comes_off()
  {
    section("A body that comes off, on a refined mesh");
    const Parameters parameters = parameters_of(
      benchmark({"Boundary conditions/Clamped boundaries=",
                 "Contact law/Bond stiffness=69",
                 "Contact law/Tangential displacement=fixed",
                 "Loads/Traction top=0; if(x < 0.2, 0.069, 0.0345)",
                 "Mesh/Cells=20,2",
                 "Load path/Factors=0.5, 1, 10",
                 "Accuracy/Target=1e-4",
                 "Solver/Method=automatic"}));
    const auto [mesh, levels, result] = refined<2>(parameters);
    check("  it comes off", result.solve.status == SolverStatus::comes_off);
    check("  after two factors", result.path.steps.size() == 2);
    check("  several meshes", levels.size() > 2);
    check("  the estimate is below the target",
          levels.back().estimated_error,
          1e-4);
  }



  void
  test_arcs()
  {
    section("Arcs of the benchmark");
    const Values loaded = {"Load path/Factors=0:0.5:2.5",
                           "Load path/Global branch=none",
                           "Load path/Arc=true"};
    // Without bonds at the corner that is moved: they break between
    // breakpoints.
    const Values moved    = {"Loads/Traction top=",
                             "Parts/Glued=bottom: x < 0.39",
                             "Boundary conditions/Contact boundary=Glued",
                             "Boundary conditions/Displacement right=free; 0.02",
                             "Boundary conditions/Clamped boundaries=left",
                             "Load path/Displacement factors=0:0.25:1",
                             "Load path/Global branch=none",
                             "Load path/Arc=true"};
    Values       for_good = moved;
    for_good.emplace_back("Load path/Bonds heal=false");
    for (const auto &[name, scene] :
         {std::make_pair("loaded", loaded),
          std::make_pair("moved", moved),
          std::make_pair("moved, bonds do not heal", for_good)})
      {
        const Path<2> path  = follow<2>(benchmark(scene));
        const auto   &arc   = path.arc;
        const auto    count = [&](const std::string &word) {
          return std::count_if(arc.begin(), arc.end(), [&](const auto &step) {
            return step.status == word;
          });
        };
        section("  ", name);
        check("  ends where the path ends",
              !arc.empty() && arc.back().factor == path.steps.back().factor &&
                arc.back().displacement_factor ==
                  path.steps.back().displacement_factor);
        check("  has unstable states", count("unstable") > 2);
        check("  and no others",
              count("stable") + count("unstable") ==
                static_cast<long>(arc.size()));
        check("  J is the integral of the work", derivative_error(arc), 1e-10);
        double violation = 0., error = 1.;
        for (const auto &step : arc)
          raise(violation, step.state.law_violation);
        check("  contact law", violation, 1e-9);
        // The first break of the path is where a bond of the arc comes to its
        // kink.
        for (const auto &step : path.steps)
          if (step.change_factor)
            {
              for (const auto &state : arc)
                error = std::min(error,
                                 std::abs(*step.change_factor -
                                          (name == std::string("loaded") ?
                                             state.factor :
                                             state.displacement_factor)));
              break;
            }
        check("  the first break of the path is on it", error, 1e-10);
      }

    section("  back to rest");
    const Path<2> back = follow<2>(benchmark({"Load path/Factors=2:-0.5:0",
                                              "Load path/Global branch=none",
                                              "Load path/Arc=true"}));
    check("  ends at rest", !back.arc.empty() && back.arc.back().factor == 0.);
    check("  where all is zero",
          !back.arc.empty() && back.arc.back().state.largest_gap == 0. &&
            back.arc.back().state.functional == 0.);
    check("  each state is verified",
          std::all_of(back.arc.begin(), back.arc.end(), [](const auto &step) {
            return step.status == "stable" || step.status == "unstable";
          }));
    check("  without a note", back.result.notes.empty());
  }
} // namespace



int
main(int argc, char *[])
{
  print_figures = argc > 1;
  test_factors();
  test_column<2>();
  test_column<3>();
  test_column<2>("gauss 3");
  test_column<3>("gauss 3");
  test_column_for_good<2>("nodal", 1);
  test_column_for_good<2>("gauss 2", 1);
  test_column_for_good<2>("gauss 3", 2);
  test_column_for_good<3>("gauss 2", 2);
  test_moved_columns<2>("gauss 3");
  test_moved_columns<3>("gauss 2");
  test_without_pressure<2>();
  test_without_pressure<3>();
  test_column_arc<2>(false);
  test_column_arc<3>(false);
  test_column_arc<2>(true);
  test_column_arc<3>(true);
  test_arcs();
  test_refined({"linear", {}, 5e-3, {"Mesh/Cells=160,16"}, 6000});
  test_refined({"quadratic",
                {"Mesh/Degree=2", "Contact law/Quadrature=gauss 8"},
                1e-3,
                {"Mesh/Cells=80,8"},
                2000});
  test_refined({"bonds that do not heal",
                {"Mesh/Degree=2",
                 "Contact law/Quadrature=gauss 4",
                 "Contact law/Bond stiffness=690",
                 "Load path/Factors=0.5:0.5:2.5, 1, 0.5",
                 "Load path/Bonds heal=false"},
                1e-2,
                {"Mesh/Cells=80,8"},
                4000});
  test_estimate_for_good();
  test_refined_until_it_comes_off();
  test_benchmark();
  test_single_factor();
  test_other_laws();
  test_failures();
}
