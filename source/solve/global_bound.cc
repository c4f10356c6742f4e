// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/trace_constant.h>
#include <debond/solve/global_bound.h>
#include <debond/solve/mean_problem.h>
#include <debond/solve/side_ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Debond
{
  namespace
  {
    using ContactSide = EquilibriumProblem<2>::ContactSide;



    /// How far a proof goes, relative to J, which is much less than what meshes
    /// leave, and relative to the interval as it is. That of the first one is
    /// as wide as this, relative to J.
    constexpr double proof_tolerance      = 1e-6;
    constexpr double part_of_the_interval = 0.002;
    constexpr double first_interval       = 1e-2;

    /// Nodes of each bound after the first of the first mesh: what is then not
    /// decided is left to the ranges.
    constexpr unsigned int n_later_nodes = 400;

    /// Shifts at the kinks, relative to the stiffness of the bonds. Large ones
    /// cost stiffness, small ones round the law: the finer the mesh, the larger
    /// the best one is.
    constexpr std::array<double, 2> first_shifts = {{2., 6.}};

    /// Problems in which what is certain is used, as long as each makes the
    /// interval narrower by a part.
    constexpr unsigned int n_stages = 18;

    /// Shifts where no piece is certain are at least so many times the
    /// stiffness of the bonds, in turn: what makes ranges narrower and what
    /// makes the bound higher differ from scene to scene.
    constexpr std::array<double, 3> least_shifts = {{1., 3., 0.3}};

    /// Stages without such a gain that end it.
    constexpr unsigned int n_idle_stages = 3;

    constexpr double least_gain = 0.05;

    /// What another one may save of what the sides lose.
    constexpr double part_of_losses = 0.5;



    /// Nothing if the element is none.
    std::optional<RectangleAboveSide>
    rectangle(const ContactSide &side, const EquilibriumElement<2> &element)
    {
      const dealii::Tensor<1, 2> a = element.corners[1] - element.corners[0];
      const dealii::Tensor<1, 2> b = element.corners[2] - element.corners[1];
      if (element.corners.size() != 4 ||
          std::abs(a * b) > 1e-10 * a.norm() * b.norm())
        return {};
      return RectangleAboveSide{side.measure, element.measure / side.measure};
    }



    /// Between the side and the opposite corner of its cell.
    TriangleAboveSide
    triangle(const ContactSide &side, const EquilibriumElement<2> &element)
    {
      dealii::Point<2> apex = element.centre;
      if (element.corners.size() == 3)
        for (unsigned int i = 0; i < 3; ++i)
          if (element.corners[i].distance(side.corners[0]) >
                1e-8 * side.measure &&
              element.corners[i].distance(side.corners[1]) >
                1e-8 * side.measure)
            apex = element.corners[i];
      const dealii::Tensor<1, 2> along =
        (side.corners[1] - side.corners[0]) / side.measure;
      const dealii::Tensor<1, 2> to_apex = apex - side.corners[0];
      const double               place   = to_apex * along;
      // Mirrored triangles have the same constant.
      return {side.measure,
              (to_apex - place * along).norm(),
              std::min(place, side.measure - place)};
    }



    /// The piece of the law on which all of the interval is, if it is one.
    std::optional<unsigned int>
    piece_of(const Interval &interval, const BranchMinimum &law)
    {
      const unsigned int piece = law.index(interval.upper);
      if (law.index(interval.lower) != piece)
        return {};
      return piece;
    }
  } // namespace



  std::vector<double>
  side_constants(const EquilibriumProblem<2> &equilibrium,
                 const ByRegion<Material>    &materials,
                 const bool                   tangential_fixed)
  {
    // Of shapes with a side of length 1.
    struct Known
    {
      double                height;
      std::optional<double> apex;
      Material              material;
      double                constant;
    };
    std::vector<Known>  known;
    std::vector<double> constants;
    for (const ContactSide &side : equilibrium.contact_sides())
      {
        const EquilibriumElement<2> &element =
          equilibrium.elements()[side.element];
        Known own = {0., {}, materials(side.material), 0.};
        if (const auto Q = rectangle(side, element))
          own.height = Q->height / Q->width;
        else
          {
            const TriangleAboveSide triangle_above = triangle(side, element);
            own.height = triangle_above.height / triangle_above.width;
            own.apex   = triangle_above.apex / triangle_above.width;
          }
        const auto is_same = [](const double one, const double other) {
          return std::abs(one - other) <= 1e-9;
        };
        auto same =
          std::find_if(known.begin(), known.end(), [&](const Known &other) {
            return is_same(other.height / own.height, 1.) &&
                   other.apex.has_value() == own.apex.has_value() &&
                   (!own.apex ||
                    is_same((*other.apex - *own.apex) / own.height, 0.)) &&
                   other.material.young_modulus == own.material.young_modulus &&
                   other.material.poisson_ratio == own.material.poisson_ratio;
          });
        if (same == known.end())
          {
            own.constant =
              own.apex ?
                trace_constant(TriangleAboveSide{1., own.height, *own.apex},
                               own.material,
                               tangential_fixed) :
                trace_constant(RectangleAboveSide{1., own.height},
                               own.material,
                               tangential_fixed);
            same = known.insert(known.end(), own);
          }
        // Shapes count as the same if they are to less than this.
        constexpr double rounding = 1e-7;
        constants.push_back((1. - rounding) * same->constant / side.measure);
      }
    return constants;
  }



  GlobalBound
  bound_global(const EquilibriumProblem<2>    &equilibrium,
               const std::vector<double>      &trace_constants,
               const BranchMinimum            &law,
               const Eigen::VectorXd          &means,
               const std::vector<double>      &energies,
               const double                    upper,
               std::vector<CertifiedSide>      known,
               const bool                      with_deviations,
               const BranchAndBoundParameters &proof_parameters,
               const std::function<bool()>    &may_go_on)
  {
    const MeanProblems sides(equilibrium, trace_constants, law, energies);

    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<CertifiedSide> &ranges = known;

    const bool is_known =
      std::any_of(ranges.begin(), ranges.end(), [](const CertifiedSide &side) {
        return std::isfinite(side.linear().upper);
      });
    BranchAndBoundParameters   parameters = proof_parameters;
    GlobalBound                result;
    std::optional<MeanProblem> best, latest;
    Eigen::VectorXd            latest_values;
    const std::vector<double>  none(ranges.size(), 0.);
    /// Returns the bound.
    const auto add_bound = [&](const std::vector<double> &D) {
      const double interval = std::isfinite(result.lower) ?
                                upper - result.lower :
                                first_interval * std::abs(upper);
      parameters.tolerance  = std::max(proof_tolerance * std::abs(upper),
                                      part_of_the_interval * interval);
      if (is_known || std::isfinite(result.lower))
        parameters.maximum_nodes =
          std::min(parameters.maximum_nodes, n_later_nodes);
      MeanProblem problem = sides.mean_problem(ranges, means, D, none);
      const BranchAndBoundResult proof =
        BranchAndBound(parameters)
          .minimize(problem.S,
                    problem.g,
                    *problem.phi,
                    problem.kept_of(means),
                    [&](const ProofProgress &) { return may_go_on(); });
      result.nodes += proof.nodes;
      const double lower = proof.status == ProofStatus::no_bound ?
                             -infinity :
                             problem.constant + proof.lower - problem.rounding;
      latest_values      = problem.all(proof.s);
      latest             = std::move(problem);
      if (lower > result.lower)
        {
          result.lower    = lower;
          result.rounding = latest->rounding;
          result.status   = proof.status;
          result.losses   = sides.losses(*latest, latest_values);
        }
      return lower;
    };

    double                           best_lower = -infinity;
    Eigen::VectorXd                  best_values;
    std::vector<std::vector<double>> first_trials;
    if (is_known)
      {
        const auto shifts = [&]() {
          return sides.shifts_for_ranges(ranges,
                                         means,
                                         Eigen::VectorXd::Zero(means.size()),
                                         least_shifts[0]);
        };
        const MeanProblem problem =
          sides.mean_problem(ranges, means, shifts(), none);
        exclude_pieces(problem, upper, means, may_go_on, ranges);
        shrink_ranges(problem, upper, false, may_go_on, ranges);
        first_trials.push_back(shifts());
      }
    for (const double multiple : first_shifts)
      first_trials.push_back(sides.shifts_for_means(means, multiple));
    /// Whether saving what may be saved of what the sides lose would make the
    /// interval narrower.
    const auto losses_matter = [&]() {
      const double loss =
        std::accumulate(result.losses.begin(), result.losses.end(), 0.);
      return part_of_losses * loss >= least_gain * (upper - result.lower);
    };
    for (const std::vector<double> &D : first_trials)
      {
        if (const double lower = add_bound(D); !best || lower > best_lower)
          {
            best        = std::move(latest);
            best_values = latest_values;
            best_lower  = lower;
          }
        if (result.status == ProofStatus::proved &&
            (!is_known || !losses_matter()))
          break;
      }
    /// Makes the ranges narrower by the best problem. If it has all means since
    /// nothing was known, quickly and without trials of single sides: the next
    /// one has fewer.
    const auto look = [&](const bool is_quick) {
      shrink_ranges(*best, upper, is_quick, may_go_on, ranges);
      if (!is_quick)
        exclude_pieces(
          *best, upper, best_values.head(means.size()), may_go_on, ranges);
    };
    unsigned int n_idle = 0;
    for (unsigned int stage = 0; stage < n_stages && may_go_on(); ++stage)
      {
        look(stage == 0 && !is_known);
        const double before = upper - result.lower;
        add_bound(
          sides.shifts_for_ranges(ranges,
                                  best_values.head(means.size()),
                                  best_values.tail(means.size()),
                                  least_shifts[stage % least_shifts.size()]));
        best        = std::move(latest);
        best_values = latest_values;
        n_idle =
          upper - result.lower > (1. - least_gain) * before ? n_idle + 1 : 0;
        // The first one has only the ranges of a problem that knew nothing.
        if (n_idle == n_idle_stages || (stage > 0 && !losses_matter()))
          break;
      }
    if (may_go_on())
      look(false);

    if (with_deviations && may_go_on())
      {
        const std::vector<double> &D = best->shifts;
        shrink_ranges(sides.mean_problem(ranges,
                                         best_values.head(means.size()),
                                         D,
                                         sides.rests_for(upper - result.lower,
                                                         D)),
                      upper,
                      false,
                      may_go_on,
                      ranges);
      }

    for (CertifiedSide &side : ranges)
      side.piece = piece_of(side.linear(), law);
    result.sides = std::move(ranges);
    return result;
  }
} // namespace Debond
