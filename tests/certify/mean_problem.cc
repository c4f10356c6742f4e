// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The problem in the means and where its displacements are, beside the same by
// dense algebra from the condensed stresses: theorem 1, and, where all branches
// are certain, the ranges of means and ends.

#include <debond/certify/global_bound.h>
#include <debond/certify/mean_problem.h>
#include <debond/certify/side_ranges.h>
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/interval.h>
#include <debond/solve/scene.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <random>

#include "../check.h"
#include "../parameters_of.h"

using namespace Debond;

namespace
{
  /// constant + 1/2 x'A x - b'x of means and slopes x.
  struct Quadratic
  {
    double          constant;
    Eigen::MatrixXd A;
    Eigen::VectorXd b;

    double
    value(const Eigen::VectorXd &x) const
    {
      return constant + x.dot(0.5 * (A * x) - b);
    }
  };



  class Body
  {
  public:
    explicit Body(const Values &values)
      : parameters(parameters_of(values))
      , scene(parameters)
      , stresses(scene.problem().unknowns().dof_handler().get_triangulation(),
                 scene.conditions(),
                 scene.supports(),
                 scene.materials(),
                 scene.loads())
      , trace_constants(
          side_constants(stresses,
                         scene.materials(),
                         scene.conditions().tangential_displacement_fixed))
      , n(static_cast<unsigned int>(stresses.contact_sides().size()))
      , energies(n, 1.)
      , laws(n, law())
      , problems(stresses, trace_constants, laws, energies)
    {
      std::mt19937_64 engine(3);
      for (unsigned int i = 0; i < n; ++i)
        shifts.push_back(
          (0.1 + 0.3 * static_cast<double>(engine() >> 11) * 0x1p-53) *
          trace_constants[i]);
    }

    const BranchMinimum &
    law() const
    {
      return scene.law().branches();
    }

    /// G_theta of the certificate, theta for the shifts of a problem, which may
    /// be smaller than those asked for.
    Quadratic
    softened(const MeanProblem &problem) const
    {
      const auto         &sides = stresses.contact_sides();
      std::vector<double> weights(stresses.n_cells(), 1.);
      for (unsigned int i = 0; i < n; ++i)
        weights[sides[i].cell->active_cell_index()] -=
          problem.shifts[i] / trace_constants[i];
      const auto           condensed = stresses.condense(weights);
      const MeansAndSlopes x(*condensed);
      return {condensed->energy_at_zero(), x.A, x.b};
    }

    const Parameters                 parameters;
    const Scene<2>                   scene;
    const EquilibriumProblem<2>      stresses;
    const std::vector<double>        trace_constants;
    const unsigned int               n;
    const std::vector<double>        energies;
    const std::vector<BranchMinimum> laws;
    const MeanProblems               problems;
    std::vector<double>              shifts;
  };



  /// Nothing is known of the sides.
  void
  test_problem(const Body &body)
  {
    const unsigned int               n = body.n;
    const std::vector<CertifiedSide> nothing(n);
    const Eigen::VectorXd            zero = Eigen::VectorXd::Zero(n);
    const MeanProblem                problem =
      body.problems.mean_problem(nothing, zero, body.shifts);
    const Quadratic softened = body.softened(problem);
    const double    M        = std::abs(body.law()[0].lower);

    std::mt19937_64 engine(7);
    double          error    = 0.;
    bool            is_least = true;
    for (unsigned int trial = 0; trial < 20; ++trial)
      {
        Eigen::VectorXd s(n);
        for (unsigned int i = 0; i < n; ++i)
          s(i) = -2. * M * static_cast<double>(engine() >> 11) * 0x1p-53;
        /// The right side of theorem 1.
        const auto direct = [&](const Eigen::VectorXd &x) {
          double sum = softened.value(x);
          for (unsigned int i = 0; i < n; ++i)
            {
              const double D = problem.shifts[i], k = x(n + i);
              sum += body.stresses.contact_sides()[i].measure *
                     (RoundedBranches(body.law(), D).minimum().value(x(i)) -
                      D * k * k / 6.);
            }
          return sum;
        };
        const Eigen::VectorXd x     = problem.all(s);
        const double          value = direct(x);
        double                own =
          problem.constant + s.dot(0.5 * (problem.S * s) - problem.g);
        for (unsigned int i = 0; i < n; ++i)
          own += problem.phi->f[i].value(s(i));
        error = std::max({error,
                          std::abs(own - value) / std::abs(value),
                          (x.head(n) - s).norm() / s.norm()});
        for (unsigned int i = 0; i < n; ++i)
          {
            Eigen::VectorXd other = x;
            other(n + i) += 0.1 * M;
            is_least = is_least && direct(other) > value;
            other(n + i) -= 0.2 * M;
            is_least = is_least && direct(other) > value;
          }
      }
    check("  right side of theorem 1", error, 1e-9);
    check("  with the least slopes", is_least);
  }



  /// All bonds are broken: the functional is quadratic.
  void
  test_ranges(const Body &body)
  {
    const unsigned int n = body.n;
    const double       M = std::abs(body.law()[0].lower);

    std::vector<CertifiedSide> ranges(n);
    const Interval             known = {-1e15 * M, -100. * M};
    for (CertifiedSide &side : ranges)
      {
        side.mean    = known;
        side.at_ends = {{known, known}};
      }
    const MeanProblem problem =
      body.problems.mean_problem(ranges, Eigen::VectorXd::Zero(n), body.shifts);

    Quadratic direct = body.softened(problem);
    for (const auto &side : body.stresses.contact_sides())
      direct.constant +=
        side.measure * static_cast<double>(body.law()[1].constant);
    const Eigen::LLT<Eigen::MatrixXd> factor(direct.A);
    const Eigen::VectorXd             x     = factor.solve(direct.b);
    const double                      least = direct.value(x);
    const Eigen::MatrixXd             inverse =
      factor.solve(Eigen::MatrixXd::Identity(2 * n, 2 * n));

    const double upper = least + 1e-4 * std::abs(least);
    shrink_ranges(
      problem, upper, false, []() { return true; }, ranges);

    double       of_means = 0., of_ends = 0.;
    const double radius = std::sqrt(2. * (upper - least));
    for (unsigned int i = 0; i < n; ++i)
      {
        const auto difference = [&](const double xi, const Interval &found) {
          const double distance =
            radius * std::sqrt(inverse(i, i) + 2. * xi * inverse(i, n + i) +
                               xi * xi * inverse(n + i, n + i));
          const double   centre = x(i) + xi * x(n + i);
          const Interval own =
            intersection(known, {centre - distance, centre + distance});
          return std::max(std::abs(found.lower - own.lower),
                          std::abs(found.upper - own.upper)) /
                 distance;
        };
        of_means = std::max(of_means, difference(0., ranges[i].mean));
        for (const unsigned int end : {0, 1})
          of_ends =
            std::max(of_ends,
                     difference(end == 0 ? -1. : 1., ranges[i].at_ends[end]));
      }
    check("  ranges of the means", of_means, 1e-3);
    check("  of the ends", of_ends, 1e-3);
  }



  void
  test(const std::string &name, const Values &values)
  {
    std::cout << name << std::endl;
    test_problem(Body(values));
    test_ranges(Body(values + Values{"Contact law/Bond threshold=1e-12"}));
  }
} // namespace



int
main(int argc, char **)
{
  print_figures          = argc > 1;
  const Values benchmark = {"Contact law/Quadrature=gauss 8",
                            "Loads/Traction top=0; 0.69",
                            "Mesh/Cells=12, 2"};
  test("benchmark, lifted everywhere", benchmark);
  test("strip held at one end, free to slide",
       benchmark + Values{"Boundary conditions/Clamped boundaries=left",
                          "Contact law/Tangential displacement=free"});
  test("pad held on top",
       benchmark + Values{"Mesh/Lengths=0.4, 0.1",
                          "Boundary conditions/Clamped boundaries=top",
                          "Loads/Traction top=",
                          "Loads/Body force=0; 30"});
}
