// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/trace_constant.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/global/growth.h>
#include <debond/optimization/global/node_bound.h>
#include <debond/optimization/global/rounded_branches.h>
#include <debond/solve/global_bound.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

namespace Debond
{
  namespace
  {
    using ContactSide = EquilibriumProblem::ContactSide;



    /// How far a proof goes, relative to J, which is much less than what meshes
    /// leave.
    constexpr double proof_tolerance = 1e-6;

    /// Shifts at the kinks, relative to the stiffness of the bonds. Large ones
    /// cost stiffness, small ones round the law: the finer the mesh, the larger
    /// the best one is.
    constexpr std::array<double, 2> first_shifts = {{2., 6.}};

    constexpr double least_shift = 0.005;

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

    /// Nodes that tell where minimisers are.
    constexpr unsigned int n_nodes_of_ranges = 32;



    /// Larger shifts round the law by little more than nothing.
    constexpr double largest_uncertain_shift = 40.;

    /// What the rounded law is below the law, at the most, as far from a mean
    /// as a tenth of the distance of the first kink.
    double
    largest_loss(const BranchMinimum   &law,
                 const RoundedBranches &rounded,
                 const double           mean)
    {
      const BranchMinimum own    = rounded.minimum();
      const double        margin = 0.1 * std::abs(law[0].lower);
      double              result = 0.;
      for (const double part : {-1., -0.5, 0., 0.5, 1.})
        {
          const double s = std::min(mean + part * margin, 0.);
          result         = std::max(result, law.value(s) - own.value(s));
        }
      return result;
    }



    /// Nothing if the element is none.
    std::optional<RectangleAboveSide>
    rectangle(const ContactSide &side, const EquilibriumElement &element)
    {
      const dealii::Tensor<1, 2> a = element.corners[1] - element.corners[0];
      const dealii::Tensor<1, 2> b = element.corners[2] - element.corners[1];
      if (element.corners.size() != 4 ||
          std::abs(a * b) > 1e-10 * a.norm() * b.norm())
        return {};
      return RectangleAboveSide{side.length, element.area / side.length};
    }



    /// Between the side and the opposite corner of its cell.
    TriangleAboveSide
    triangle(const ContactSide &side, const EquilibriumElement &element)
    {
      dealii::Point<2> apex = element.centre;
      if (element.corners.size() == 3)
        for (unsigned int i = 0; i < 3; ++i)
          if (element.corners[i].distance(side.ends[0]) > 1e-8 * side.length &&
              element.corners[i].distance(side.ends[1]) > 1e-8 * side.length)
            apex = element.corners[i];
      const dealii::Tensor<1, 2> along =
        (side.ends[1] - side.ends[0]) / side.length;
      const dealii::Tensor<1, 2> to_apex = apex - side.ends[0];
      const double               place   = to_apex * along;
      // Mirrored triangles have the same constant.
      return {side.length,
              (to_apex - place * along).norm(),
              std::min(place, side.length - place)};
    }



    /// The right side of theorem 2 for shifts D, as a function of the means m:
    ///     constant + 1/2 m'S m - g'm + phi(m),
    /// with the slopes k = offset + slopes m that belong to them. J is at least
    /// this and 1/2 the sum of the rests times the squared deviations.
    struct MeanProblem
    {
      double                             constant, rounding;
      Eigen::MatrixXd                    S;
      Eigen::VectorXd                    g;
      std::unique_ptr<SeparableBranches> phi;

      // Of the sides.
      std::vector<double>                      shifts;
      std::vector<double>                      rests;
      std::vector<std::optional<unsigned int>> pieces;

      Eigen::VectorXd offset;
      Eigen::MatrixXd slopes;
      Eigen::MatrixXd inverse_in_slopes;
    };



    class Sides
    {
    public:
      Sides(const EquilibriumProblem  &equilibrium,
            const std::vector<double> &trace_constants,
            const BranchMinimum       &law,
            const std::vector<double> &energies)
        : equilibrium(equilibrium)
        , trace_constants(trace_constants)
        , energies(energies)
        , law(law)
        , sides(equilibrium.contact_sides())
        , n(static_cast<unsigned int>(sides.size()))
        , sharers(equilibrium.elements().size(), 0)
      {
        for (const ContactSide &side : sides)
          ++sharers[side.element];
      }

      std::vector<double>
      shifts_for_means(const Eigen::VectorXd &means,
                       const double           multiple) const;

      std::vector<double>
      shifts_for_ranges(const std::vector<CertifiedSide> &ranges,
                        const Eigen::VectorXd            &means,
                        const Eigen::VectorXd            &slopes,
                        const double                      least_multiple) const;

      /// What the sides lose at the means @p m: by stiffness, and where no
      /// piece is certain by slopes and the rounded law.
      std::vector<double>
      losses(const MeanProblem &problem, const Eigen::VectorXd &m) const;

      /// What of a stiffness is left for deviations to be bounded with, beside
      /// the shifts @p D: so much that it makes the bound lower by about @p
      /// loss.
      std::vector<double>
      rests_for(const double loss, const std::vector<double> &D) const;

      /// At @p means it measures its rounding.
      MeanProblem
      mean_problem(const std::vector<CertifiedSide> &ranges,
                   const Eigen::VectorXd            &means,
                   std::vector<double>               D,
                   std::vector<double>               rests) const;

    private:
      std::optional<MeanProblem>
      try_mean_problem(const std::vector<CertifiedSide> &ranges,
                       const Eigen::VectorXd            &means,
                       const std::vector<double>        &D,
                       const std::vector<double>        &rests) const;

      /// The largest shift of a side: at least a tenth of an element's
      /// stiffness stays.
      double
      available(const unsigned int i) const
      {
        return 0.9 * trace_constants[i] / sharers[sides[i].element];
      }

      const EquilibriumProblem       &equilibrium;
      const std::vector<double>      &trace_constants;
      const std::vector<double>      &energies;
      const BranchMinimum            &law;
      const std::vector<ContactSide> &sides;
      const unsigned int              n;
      std::vector<unsigned int>       sharers; ///< of elements
    };



    /// Large enough for the law not to be rounded at the mean, if that can be
    /// with the given multiple of the bonds' stiffness.
    std::vector<double>
    Sides::shifts_for_means(const Eigen::VectorXd &means,
                            const double           multiple) const
    {
      const double        largest = multiple * law[0].curvature;
      std::vector<double> shifts;
      for (unsigned int i = 0; i < n; ++i)
        {
          double D = 0.02 * law[0].curvature;
          while (D < largest &&
                 RoundedBranches(law, D).is_rounded_near(means(i)))
            D *= 1.25;
          shifts.push_back(std::min({D, largest, available(i)}));
        }
      return shifts;
    }



    /// Those that lose least: large enough for the piece of the law to be
    /// certain, if that can be, or for means and slopes near the given ones to
    /// lose little by stiffness, slopes and rounding together, but at least the
    /// given multiple of the bonds' stiffness.
    std::vector<double>
    Sides::shifts_for_ranges(const std::vector<CertifiedSide> &ranges,
                             const Eigen::VectorXd            &means,
                             const Eigen::VectorXd            &slopes,
                             const double least_multiple) const
    {
      const double        a = law[0].curvature;
      std::vector<double> shifts;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double of_stiffness = 0.5 * energies[i] / trace_constants[i];
          const double of_slope = sides[i].length * slopes(i) * slopes(i) / 6.;
          double       best     = least_shift * a;
          double       least    = std::numeric_limits<double>::infinity();
          for (double D = best; D < available(i); D *= 1.2)
            {
              const RoundedBranches rounded(law, D);
              const bool            is_certain =
                rounded.exact_piece(ranges[i].linear()).has_value();
              if (!is_certain && D > largest_uncertain_shift * a)
                continue;
              double cost = D * of_stiffness;
              if (!is_certain)
                cost += D * of_slope +
                        sides[i].length * largest_loss(law, rounded, means(i));
              if (cost < least)
                {
                  least = cost;
                  best  = D;
                }
              if (is_certain)
                break;
            }
          if (!RoundedBranches(law, best).exact_piece(ranges[i].linear()))
            best = std::max(best, least_multiple * a);
          shifts.push_back(std::min(best, available(i)));
        }
      return shifts;
    }



    std::vector<double>
    Sides::losses(const MeanProblem &problem, const Eigen::VectorXd &m) const
    {
      const Eigen::VectorXd k = problem.offset + problem.slopes * m;
      std::vector<double>   result;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double D = problem.shifts[i];
          result.push_back(0.5 * (D + problem.rests[i]) / trace_constants[i] *
                           energies[i]);
          if (problem.pieces[i])
            continue;
          const double s       = std::min(m(i), 0.);
          const double rounded = RoundedBranches(law, D).minimum().value(s);
          const double c       = law[law.index(s)].curvature;
          result.back() += sides[i].length * (law.value(s) - rounded +
                                              (c + D) * k(i) * k(i) / 6.);
        }
      return result;
    }



    std::vector<double>
    Sides::rests_for(const double loss, const std::vector<double> &D) const
    {
      // Half of an element's stiffness at the most: what is taken has to be
      // small beside it for the energy to be that of the displacement.
      constexpr double    largest = 0.5;
      std::vector<double> rests;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double allowed = std::max(largest * available(i) - D[i], 0.);
          const double of_stiffness = 0.5 * energies[i] / trace_constants[i];
          rests.push_back(allowed * of_stiffness * n > loss ?
                            loss / (of_stiffness * n) :
                            allowed);
        }
      return rests;
    }



    /// Nothing if it is not convex in the slopes, or the means do not determine
    /// the stresses.
    std::optional<MeanProblem>
    Sides::try_mean_problem(const std::vector<CertifiedSide> &ranges,
                            const Eigen::VectorXd            &means,
                            const std::vector<double>        &D,
                            const std::vector<double>        &rests) const
    {
      std::vector<double> weights(equilibrium.elements().size(), 1.);
      for (unsigned int i = 0; i < n; ++i)
        weights[sides[i].element] -= (D[i] + rests[i]) / trace_constants[i];
      std::unique_ptr<const Condensation> condensed;
      try
        {
          condensed = equilibrium.condense(true, weights);
        }
      catch (const std::runtime_error &)
        {
          return {};
        }
      Eigen::MatrixXd A = condensed->schur_complement();
      Eigen::VectorXd b = condensed->load();

      MeanProblem result;
      result.shifts   = D;
      result.rests    = rests;
      result.constant = condensed->energy_at_zero();
      std::vector<BranchMinimum> laws;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double          length = sides[i].length;
          const RoundedBranches rounded(law, D[i]);
          result.pieces.push_back(rounded.exact_piece(ranges[i].linear()));
          if (!result.pieces.back())
            {
              A(n + i, n + i) -= length * D[i] / 3.;
              laws.push_back(rounded.minimum().with_first_curvature(
                length * law[0].curvature));
              continue;
            }
          const BranchMinimum::Piece &piece = law[*result.pieces.back()];
          A(i, i) += length * piece.curvature;
          A(n + i, n + i) += length * piece.curvature / 3.;
          b(i) -= length * piece.slope;
          result.constant += length * static_cast<double>(piece.constant);
          laws.push_back(BranchMinimum({{0., 0., 0.L, ""}}));
        }

      // That there is an inverse proves that it is convex in the slopes.
      auto inverse = safe_inverse(A.bottomRightCorner(n, n));
      if (!inverse)
        return {};
      result.inverse_in_slopes = std::move(*inverse);
      result.offset            = result.inverse_in_slopes * b.tail(n);
      result.slopes = -result.inverse_in_slopes * A.bottomLeftCorner(n, n);
      result.constant -= 0.5 * b.tail(n).dot(result.offset);
      const Eigen::MatrixXd S =
        A.topLeftCorner(n, n) + A.topRightCorner(n, n) * result.slopes;
      result.S = 0.5 * (S + S.transpose());
      // What shifts take may be more than what the bonds of stiff laws leave.
      if (!is_safely_positive_definite(result.S))
        return {};
      result.g   = b.head(n) + result.slopes.transpose() * b.tail(n);
      result.phi = std::make_unique<SeparableBranches>(laws);

      Eigen::VectorXd kept(2 * n);
      kept << means, result.offset + result.slopes * means;
      result.rounding = equilibrium.rounding_of(*condensed, kept, weights);
      return result;
    }



    /// D and the rests are made smaller until there is one. Throws
    /// EquilibriumError if that does not help.
    MeanProblem
    Sides::mean_problem(const std::vector<CertifiedSide> &ranges,
                        const Eigen::VectorXd            &means,
                        std::vector<double>               D,
                        std::vector<double>               rests) const
    {
      constexpr unsigned int trials = 12;
      for (unsigned int trial = 0; trial < trials; ++trial)
        {
          if (auto problem = try_mean_problem(ranges, means, D, rests))
            return std::move(*problem);
          for (std::vector<double> *shifts : {&D, &rests})
            for (double &shift : *shifts)
              shift *= 0.5;
        }
      throw EquilibriumError("the equilibrated stresses are not determined by "
                             "the mean displacements of the contact sides");
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



    /// Where displacements of a node can be if the functional of the means is
    /// at most @p upper; nothing if they cannot.
    std::optional<std::vector<CertifiedSide>>
    ranges_of_node(const MeanProblem &problem,
                   const NodeBound   &bound,
                   const ProofNode   &node,
                   const double       upper)
    {
      const unsigned int n = static_cast<unsigned int>(problem.pieces.size());
      std::vector<CertifiedSide> ranges(n);
      for (unsigned int i = 0; i < n; ++i)
        ranges[i].mean = {node.lower(i), node.upper(i)};
      for (const NodeBall &ball : bound.balls(node))
        {
          if (ball.value > upper)
            return {};
          const double radius =
            std::sqrt(2. * (upper - ball.value)) * (1. + 1e-6);
          const auto around = [&](const double centre,
                                  const double variance) -> Interval {
            const double distance = radius * std::sqrt(std::max(variance, 0.));
            return {centre - distance, centre + distance};
          };
          const Eigen::VectorXd k = problem.offset + problem.slopes * ball.x;
          const Eigen::MatrixXd product = problem.slopes * ball.inverse;
          for (unsigned int i = 0; i < n; ++i)
            {
              const double m       = ball.x(i);
              const double of_mean = ball.inverse(i, i);
              const double of_slope =
                product.row(i).dot(problem.slopes.row(i)) +
                problem.inverse_in_slopes(i, i);
              const double mixed = 2. * product(i, i);
              ranges[i].mean = intersection(ranges[i].mean, around(m, of_mean));
              for (const double xi : {-1., 1.})
                {
                  Interval &at_end = ranges[i].at_ends[xi > 0.];
                  at_end =
                    intersection(at_end,
                                 around(m + xi * k(i),
                                        of_mean + xi * mixed + of_slope));
                }
              if (problem.rests[i] > 0.)
                ranges[i].deviation =
                  std::min(ranges[i].deviation,
                           radius / std::sqrt(problem.rests[i]));
            }
        }
      return ranges;
    }



    /// Shrinks the ranges to where displacements with J at most @p upper are.
    void
    shrink(const MeanProblem           &problem,
           const double                 upper,
           const std::function<bool()> &may_go_on,
           std::vector<CertifiedSide>  &ranges)
    {
      const double           best = upper - problem.constant + problem.rounding;
      const NodeBound        bound(problem.S, problem.g, *problem.phi);
      std::vector<ProofNode> open;
      if (auto root = bound.root(best))
        {
          for (unsigned int i = 0; i < ranges.size(); ++i)
            {
              root->lower(i) = std::max(root->lower(i), ranges[i].mean.lower);
              root->upper(i) = std::min(root->upper(i), ranges[i].mean.upper);
            }
          open.push_back(*root);
        }
      else
        return;
      const Interval empty    = {1., -1.};
      CertifiedSide  no_range = {};
      no_range.mean           = empty;
      no_range.at_ends        = {{empty, empty}};
      no_range.deviation      = 0.;
      std::vector<CertifiedSide> hulls(ranges.size(), no_range);
      for (unsigned int nodes = 0; !open.empty(); ++nodes)
        {
          if (!may_go_on())
            return;
          ProofNode node = std::move(open.back());
          open.pop_back();
          NodeResult result;
          if (nodes < n_nodes_of_ranges)
            {
              result = bound.bound(node, best, 0.);
              if (!result.unknown && result.least >= best)
                continue;
            }
          if (!result.unknown)
            {
              if (const auto own = ranges_of_node(problem, bound, node, best))
                for (unsigned int i = 0; i < ranges.size(); ++i)
                  {
                    hulls[i].mean = hull(hulls[i].mean, (*own)[i].mean);
                    for (unsigned int k = 0; k < 2; ++k)
                      hulls[i].at_ends[k] =
                        hull(hulls[i].at_ends[k], (*own)[i].at_ends[k]);
                    hulls[i].deviation =
                      std::max(hulls[i].deviation, (*own)[i].deviation);
                  }
              continue;
            }
          const unsigned int i    = *result.unknown;
          const double       kink = problem.phi->f[i][result.piece].upper;
          ProofNode          near = node;
          near.lower(i)           = kink;
          near.number             = 2 * nodes + 1;
          node.upper(i)           = kink;
          node.number             = 2 * nodes + 2;
          open.push_back(std::move(near));
          open.push_back(std::move(node));
        }
      for (unsigned int i = 0; i < ranges.size(); ++i)
        // No displacement at all would be one of rounding.
        if (!hulls[i].mean.is_empty())
          {
            hulls[i].ends = ranges[i].ends;
            ranges[i]     = intersection(ranges[i], hulls[i]);
          }
    }
  } // namespace



  std::vector<double>
  side_constants(const EquilibriumProblem &equilibrium,
                 const ByRegion<Material> &materials,
                 const bool                tangential_fixed)
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
        const EquilibriumElement &element =
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
        constants.push_back((1. - rounding) * same->constant / side.length);
      }
    return constants;
  }



  GlobalBound
  bound_global(const EquilibriumProblem       &equilibrium,
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
    const Sides sides(equilibrium, trace_constants, law, energies);

    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<CertifiedSide> &ranges = known;

    BranchAndBoundParameters parameters = proof_parameters;
    parameters.tolerance                = proof_tolerance * std::abs(upper);
    GlobalBound                result;
    std::optional<MeanProblem> best, latest;
    Eigen::VectorXd            latest_means;
    /// Returns the bound.
    const std::vector<double> none(ranges.size(), 0.);
    const auto                add_bound = [&](const std::vector<double> &D) {
      MeanProblem problem = sides.mean_problem(ranges, means, D, none);
      const BranchAndBoundResult proof =
        BranchAndBound(parameters)
          .minimize(problem.S,
                    problem.g,
                    *problem.phi,
                    means,
                    [&](const ProofProgress &) { return may_go_on(); });
      result.nodes += proof.nodes;
      const double lower = proof.status == ProofStatus::no_bound ?
                                            -infinity :
                                            problem.constant + proof.lower - problem.rounding;
      latest_means       = proof.s;
      latest             = std::move(problem);
      if (lower > result.lower)
        {
          result.lower    = lower;
          result.rounding = latest->rounding;
          result.status   = proof.status;
          result.losses   = sides.losses(*latest, proof.s);
        }
      return lower;
    };

    double          best_lower = -infinity;
    Eigen::VectorXd best_means = means;
    for (const double multiple : first_shifts)
      if (const double lower =
            add_bound(sides.shifts_for_means(means, multiple));
          !best || lower > best_lower)
        {
          best       = std::move(latest);
          best_means = latest_means;
          best_lower = lower;
        }
    unsigned int n_idle = 0;
    for (unsigned int stage = 0; stage < n_stages && may_go_on(); ++stage)
      {
        shrink(*best, upper, may_go_on, ranges);
        const double before = upper - result.lower;
        add_bound(
          sides.shifts_for_ranges(ranges,
                                  best_means,
                                  best->offset + best->slopes * best_means,
                                  least_shifts[stage % least_shifts.size()]));
        best       = std::move(latest);
        best_means = latest_means;
        if (std::getenv("CERT"))
          {
            double certain = 0., whole = 0.;
            for (unsigned int i = 0; i < ranges.size(); ++i)
              {
                const double l = equilibrium.contact_sides()[i].length;
                whole += l;
                certain += piece_of(ranges[i].linear(), law) ? l : 0.;
              }
            std::cerr << "  stage " << stage << " lower " << result.lower
                      << " width " << (upper - result.lower) / std::abs(upper)
                      << " nodes " << result.nodes << " uncertain "
                      << whole - certain << " of " << whole << " sides "
                      << ranges.size() << '\n';
          }
        n_idle =
          upper - result.lower > (1. - least_gain) * before ? n_idle + 1 : 0;
        if (n_idle == n_idle_stages)
          break;
      }

    if (with_deviations && may_go_on())
      {
        const std::vector<double> &D = best->shifts;
        shrink(sides.mean_problem(ranges,
                                  best_means,
                                  D,
                                  sides.rests_for(upper - result.lower, D)),
               upper,
               may_go_on,
               ranges);
      }

    for (CertifiedSide &side : ranges)
      side.piece = piece_of(side.linear(), law);
    result.sides = std::move(ranges);
    return result;
  }
} // namespace Debond
