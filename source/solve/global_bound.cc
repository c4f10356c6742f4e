// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/elasticity/trace_constant.h>
#include <debond/optimization/global/convexity_shift.h>
#include <debond/optimization/global/growth.h>
#include <debond/optimization/global/node_bound.h>
#include <debond/optimization/global/rounded_branches.h>
#include <debond/solve/global_bound.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    using ContactSide = EquilibriumProblem::ContactSide;



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

    /// Nodes to exclude one piece of the law on one side, and how often in a
    /// row they may be too few before no more are tried.
    constexpr unsigned int n_nodes_of_trial = 7;
    constexpr unsigned int n_failed_trials  = 6;



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



    /// The right side of theorem 2 for shifts D. What the terms that are not
    /// quadratic or m <= 0 are for is a function of some means s,
    ///     constant + 1/2 s'S s - g's + phi(s);
    /// the others, and after them the slopes k of all sides, are eliminated:
    /// offset + to_others s are those that belong to s. J is at least this, and
    /// 1/2 the sum of the rests times the squared deviations.
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

      std::vector<unsigned int> kept; ///< sides of s
      std::vector<unsigned int> eliminated;

      Eigen::VectorXd offset;
      Eigen::MatrixXd to_others;
      Eigen::MatrixXd inverse_in_others;

      unsigned int
      n_sides() const
      {
        return static_cast<unsigned int>(pieces.size());
      }

      /// The means of all sides, then the slopes.
      Eigen::VectorXd
      all(const Eigen::VectorXd &s) const
      {
        const Eigen::VectorXd others = offset + to_others * s;
        Eigen::VectorXd       result(2 * n_sides());
        for (unsigned int i = 0; i < kept.size(); ++i)
          result(kept[i]) = s(i);
        for (unsigned int i = 0; i < eliminated.size(); ++i)
          result(eliminated[i]) = others(i);
        result.tail(n_sides()) = others.tail(n_sides());
        return result;
      }

      Eigen::VectorXd
      kept_of(const Eigen::VectorXd &means) const
      {
        Eigen::VectorXd result(kept.size());
        for (unsigned int i = 0; i < kept.size(); ++i)
          result(i) = means(kept[i]);
        return result;
      }
    };



    /// A quadratic term, of a mean.
    struct Quadratic
    {
      double curvature, slope, constant;
    };

    /// A law without the branches that it has nowhere in an interval: with one
    /// left that one, with several their minimum, and what was taken from it to
    /// be 0 at 0.
    struct LawInRange
    {
      std::optional<Quadratic> quadratic;
      BranchMinimum            minimum;
      double                   constant = 0.;
    };



    /// @p factor times the law.
    LawInRange
    law_in_range(const BranchMinimum &whole,
                 const Interval      &range,
                 const double         factor)
    {
      unsigned int first = whole.index(range.upper);
      unsigned int last  = std::max(whole.index(range.lower), first);
      while (first < last && range.upper <= whole[first].lower)
        ++first;
      const BranchMinimum::Piece &nearest  = whole[first];
      const auto                  in_whole = [&]() -> LawInRange {
        return {{},
                whole.with_first_curvature(factor * whole[0].curvature),
                0.};
      };
      if (first == last)
        return {Quadratic{factor * nearest.curvature,
                          factor * nearest.slope,
                          factor * static_cast<double>(nearest.constant)},
                BranchMinimum({{0., 0., 0.L, ""}}),
                0.};
      if (first == 0 && last + 1 == whole.size())
        return in_whole();
      std::vector<ConvexBranch> branches;
      for (unsigned int k = first; k <= last; ++k)
        {
          long double constant = whole[k].constant - nearest.constant;
          // Branches without slopes have the constant of a near one.
          if (std::abs(constant) < 1e-12L * whole[last].constant)
            constant = 0.L;
          branches.push_back({factor * whole[k].curvature,
                              factor * whole[k].slope,
                              factor * constant,
                              ""});
        }
      try
        {
          return {{},
                  BranchMinimum(branches),
                  factor * static_cast<double>(nearest.constant)};
        }
      catch (const std::invalid_argument &)
        {
          // Some branch falls below its value at 0.
          return in_whole();
        }
    }



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

      /// What the sides lose at these means and slopes: by stiffness, and where
      /// no piece is certain by slopes and the rounded law.
      std::vector<double>
      losses(const MeanProblem     &problem,
             const Eigen::VectorXd &means_and_slopes) const;

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
    Sides::losses(const MeanProblem     &problem,
                  const Eigen::VectorXd &means_and_slopes) const
    {
      std::vector<double> result;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double D = problem.shifts[i];
          result.push_back(0.5 * (D + problem.rests[i]) / trace_constants[i] *
                           energies[i]);
          if (problem.pieces[i])
            continue;
          const double s       = std::min(means_and_slopes(i), 0.);
          const double k       = means_and_slopes(n + i);
          const double rounded = RoundedBranches(law, D).minimum().value(s);
          const double c       = law[law.index(s)].curvature;
          result.back() +=
            sides[i].length * (law.value(s) - rounded + (c + D) * k * k / 6.);
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
      const BranchMinimum        zero({{0., 0., 0.L, ""}});
      for (unsigned int i = 0; i < n; ++i)
        {
          const double             length = sides[i].length;
          const RoundedBranches    rounded(law, D[i]);
          std::optional<Quadratic> quadratic;
          result.pieces.push_back(rounded.exact_piece(ranges[i].linear()));
          if (result.pieces.back())
            {
              const BranchMinimum::Piece &piece = law[*result.pieces.back()];
              quadratic =
                Quadratic{length * piece.curvature,
                          length * piece.slope,
                          length * static_cast<double>(piece.constant)};
              A(n + i, n + i) += length * piece.curvature / 3.;
            }
          else
            {
              A(n + i, n + i) -= length * D[i] / 3.;
              const LawInRange own =
                law_in_range(rounded.minimum(), ranges[i].mean, length);
              quadratic = own.quadratic;
              if (!quadratic)
                {
                  laws.push_back(own.minimum);
                  result.constant += own.constant;
                }
            }
          if (quadratic)
            {
              A(i, i) += quadratic->curvature;
              b(i) -= quadratic->slope;
              result.constant += quadratic->constant;
              // m <= 0 says nothing.
              if (ranges[i].mean.upper < 0.)
                {
                  result.eliminated.push_back(i);
                  continue;
                }
              laws.push_back(zero);
            }
          result.kept.push_back(i);
        }
      // There is a problem without any, too.
      if (result.kept.empty())
        {
          result.kept.push_back(result.eliminated.back());
          result.eliminated.pop_back();
          laws.push_back(zero);
        }

      std::vector<unsigned int> others = result.eliminated;
      for (unsigned int i = 0; i < n; ++i)
        others.push_back(n + i);
      // That there is an inverse proves that it is convex in the others.
      auto inverse = safe_inverse(A(others, others));
      if (!inverse)
        return {};
      result.inverse_in_others       = std::move(*inverse);
      const Eigen::VectorXd b_others = b(others);
      const Eigen::MatrixXd mixed    = A(others, result.kept);
      result.offset                  = result.inverse_in_others * b_others;
      result.to_others               = -result.inverse_in_others * mixed;
      result.constant -= 0.5 * b_others.dot(result.offset);
      const Eigen::MatrixXd S =
        A(result.kept, result.kept) + mixed.transpose() * result.to_others;
      result.S = 0.5 * (S + S.transpose());
      // What shifts take may be more than what the bonds of stiff laws leave.
      if (!is_safely_positive_definite(result.S))
        return {};
      result.g   = b(result.kept) + result.to_others.transpose() * b_others;
      result.phi = std::make_unique<SeparableBranches>(laws);

      result.rounding =
        equilibrium.rounding_of(*condensed,
                                result.all(result.kept_of(means)),
                                weights);
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
      const unsigned int n = problem.n_sides();
      const unsigned int n_kept =
        static_cast<unsigned int>(problem.kept.size());
      const unsigned int n_eliminated =
        static_cast<unsigned int>(problem.eliminated.size());
      // Means and slopes as functions of s, and what of their variance is that
      // of what is eliminated.
      Eigen::MatrixXd means  = Eigen::MatrixXd::Zero(n, n_kept);
      Eigen::MatrixXd slopes = problem.to_others.bottomRows(n);
      Eigen::VectorXd of_mean(Eigen::VectorXd::Zero(n));
      Eigen::VectorXd mixed(Eigen::VectorXd::Zero(n));
      Eigen::VectorXd of_slope = problem.inverse_in_others.diagonal().tail(n);
      std::vector<CertifiedSide> ranges(n);
      for (unsigned int i = 0; i < n_kept; ++i)
        {
          const unsigned int side = problem.kept[i];
          means(side, i)          = 1.;
          ranges[side].mean       = {node.lower(i), node.upper(i)};
        }
      for (unsigned int i = 0; i < n_eliminated; ++i)
        {
          const unsigned int side = problem.eliminated[i];
          means.row(side)         = problem.to_others.row(i);
          of_mean(side)           = problem.inverse_in_others(i, i);
          mixed(side) = problem.inverse_in_others(i, n_eliminated + side);
        }
      for (const NodeBall &ball : bound.balls(node))
        {
          if (ball.value > upper)
            return {};
          const double radius =
            std::sqrt(2. * (upper - ball.value)) * (1. + 1e-6);
          const Eigen::VectorXd x         = problem.all(ball.x);
          const Eigen::MatrixXd of_means  = means * ball.inverse;
          const Eigen::MatrixXd of_slopes = slopes * ball.inverse;
          for (unsigned int i = 0; i < n; ++i)
            {
              const double mean_variance =
                of_mean(i) + of_means.row(i).dot(means.row(i));
              const double slope_variance =
                of_slope(i) + of_slopes.row(i).dot(slopes.row(i));
              const double covariance =
                mixed(i) + of_means.row(i).dot(slopes.row(i));
              /// Of the mean + xi times the slope.
              const auto range_at = [&](const double xi) -> Interval {
                const double variance = mean_variance + 2. * xi * covariance +
                                        xi * xi * slope_variance;
                const double centre = x(i) + xi * x(n + i);
                const double distance =
                  radius * std::sqrt(std::max(variance, 0.));
                return {centre - distance, centre + distance};
              };
              ranges[i].mean = intersection(ranges[i].mean, range_at(0.));
              for (const unsigned int end : {0, 1})
                ranges[i].at_ends[end] =
                  intersection(ranges[i].at_ends[end],
                               range_at(end == 0 ? -1. : 1.));
              if (problem.rests[i] > 0.)
                ranges[i].deviation =
                  std::min(ranges[i].deviation,
                           radius / std::sqrt(problem.rests[i]));
            }
        }
      return ranges;
    }



    /// Takes from the box of a node what is not in the ranges.
    void
    cut(ProofNode                        &node,
        const MeanProblem                &problem,
        const std::vector<CertifiedSide> &ranges)
    {
      for (unsigned int i = 0; i < problem.kept.size(); ++i)
        {
          const Interval &mean = ranges[problem.kept[i]].mean;
          node.lower(i)        = std::max(node.lower(i), mean.lower);
          node.upper(i)        = std::min(node.upper(i), mean.upper);
        }
    }



    /// The two parts of a node on both sides of a kink.
    std::array<ProofNode, 2>
    halves(const ProofNode         &node,
           const NodeResult        &result,
           const SeparableBranches &phi)
    {
      const unsigned int       i     = *result.unknown;
      const double             kink  = phi.f[i][result.piece].upper;
      std::array<ProofNode, 2> parts = {{node, node}};
      parts[0].lower(i)              = kink;
      parts[0].number                = 2 * node.number + 1;
      parts[1].upper(i)              = kink;
      parts[1].number                = 2 * node.number + 2;
      return parts;
    }



    /// Whether a few nodes prove that no point of the node is below @p best.
    bool
    is_excluded(const NodeBound         &bound,
                const SeparableBranches &phi,
                const double             best,
                ProofNode                node)
    {
      std::vector<ProofNode> open = {std::move(node)};
      for (unsigned int nodes = 0; nodes < n_nodes_of_trial; ++nodes)
        {
          ProofNode own = std::move(open.back());
          open.pop_back();
          const NodeResult result = bound.bound(own, best, 0.);
          if (result.unknown)
            for (ProofNode &half : halves(own, result, phi))
              open.push_back(std::move(half));
          else if (result.least < best)
            return false;
          if (open.empty())
            return true;
        }
      return false;
    }



    /// Tries, for one side after the other, whether it can be beyond the kinks
    /// that are nearest to where it is at @p means, and takes what it cannot be
    /// from its range. Those that are farthest from their kinks come first.
    void
    exclude_pieces(const MeanProblem           &problem,
                   const double                 upper,
                   const Eigen::VectorXd       &means,
                   const std::function<bool()> &may_go_on,
                   std::vector<CertifiedSide>  &ranges)
    {
      struct Trial
      {
        unsigned int i;
        bool         is_above; ///< the kink
        double       kink, distance;
      };
      const double       best = upper - problem.constant + problem.rounding;
      const NodeBound    bound(problem.S, problem.g, *problem.phi);
      std::vector<Trial> trials;
      for (unsigned int i = 0; i < problem.kept.size(); ++i)
        {
          const BranchMinimum &f     = problem.phi->f[i];
          const Interval      &range = ranges[problem.kept[i]].mean;
          const double         s     = means(problem.kept[i]);
          const auto          &piece = f[f.index(s)];
          for (const bool is_above : {false, true})
            {
              const double kink = is_above ? piece.upper : piece.lower;
              if (kink < range.upper && kink > range.lower)
                trials.push_back({i, is_above, kink, std::abs(s / kink - 1.)});
            }
        }
      std::sort(trials.begin(),
                trials.end(),
                [](const Trial &a, const Trial &b) {
                  return a.distance != b.distance ? a.distance > b.distance :
                                                    a.i < b.i;
                });
      auto root = bound.root(best);
      if (!root)
        return;
      // With as few relaxations as later nodes.
      root->number            = 1;
      unsigned int n_failures = 0;
      for (const Trial &trial : trials)
        {
          if (!may_go_on() || n_failures == n_failed_trials)
            return;
          ProofNode node = *root;
          cut(node, problem, ranges);
          (trial.is_above ? node.lower : node.upper)(trial.i) = trial.kink;
          Interval &range = ranges[problem.kept[trial.i]].mean;
          if (node.lower(trial.i) <= node.upper(trial.i) &&
              !is_excluded(bound, *problem.phi, best, std::move(node)))
            {
              ++n_failures;
              continue;
            }
          n_failures                                   = 0;
          (trial.is_above ? range.upper : range.lower) = trial.kink;
        }
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
          cut(*root, problem, ranges);
          open.push_back(std::move(*root));
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
          for (ProofNode &half : halves(node, result, *problem.phi))
            open.push_back(std::move(half));
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
        shrink(problem, upper, may_go_on, ranges);
        first_trials.push_back(shifts());
      }
    for (const double multiple : first_shifts)
      first_trials.push_back(sides.shifts_for_means(means, multiple));
    for (const std::vector<double> &D : first_trials)
      if (const double lower = add_bound(D); !best || lower > best_lower)
        {
          best        = std::move(latest);
          best_values = latest_values;
          best_lower  = lower;
        }
    unsigned int n_idle = 0;
    for (unsigned int stage = 0; stage < n_stages && may_go_on(); ++stage)
      {
        shrink(*best, upper, may_go_on, ranges);
        exclude_pieces(
          *best, upper, best_values.head(means.size()), may_go_on, ranges);
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
        if (n_idle == n_idle_stages)
          break;
      }

    if (with_deviations && may_go_on())
      {
        const std::vector<double> &D = best->shifts;
        shrink(sides.mean_problem(ranges,
                                  best_values.head(means.size()),
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
