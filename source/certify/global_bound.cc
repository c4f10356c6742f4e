// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/base/tolerances.h>
#include <debond/certify/global_bound.h>
#include <debond/certify/side_ranges.h>
#include <debond/certify/trace_constant.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    using ContactSide = EquilibriumMesh<2>::Side;



    /// The gap at which branch and bound ends, relative to J, which is much
    /// less than what meshes leave, and relative to the interval as it is. The
    /// first interval is taken for this wide, relative to J.
    constexpr double proof_tolerance      = 1e-6;
    constexpr double part_of_the_interval = 0.002;
    constexpr double first_interval       = 1e-2;

    /// The nodes of each bound after the first one: what is then not decided is
    /// left to the ranges.
    constexpr unsigned int n_later_nodes = 400;

    /// Shifts at the kinks, relative to the stiffness of the bonds. Large ones
    /// cost stiffness, small ones round the law: the finer the mesh, the larger
    /// the best one is.
    constexpr std::array<double, 2> first_shifts = {{2., 6.}};

    /// Problems in which what is certain is used, as long as each makes the
    /// interval narrower by a known.
    constexpr unsigned int n_stages = 18;

    /// Shifts where no piece is certain are at least so many times the
    /// stiffness of the bonds, in turn: what makes ranges narrower and what
    /// makes the bound higher differ from scene to scene.
    constexpr std::array<double, 3> least_shifts = {{1., 3., 0.3}};

    /// The number of stages without such a gain after which it ends.
    constexpr unsigned int n_idle_stages = 3;

    constexpr double least_gain = 0.05;

    /// By how much displacements with recorded ranges may be above the upper
    /// number, relative to the interval.
    constexpr double margin_of_record = 1e-3;

    /// The part that another one may save of what the sides lose.
    constexpr double part_of_losses = 0.5;



    /// The cell above a side, scaled to a side of length 1.
    TriangleAboveSide
    triangle(const ContactSide &side)
    {
      // Similar triangles have the same constant but for their size, so height
      // and place of the apex in terms of the side are all that matters.
      dealii::Tensor<1, 2> to_apex;
      for (const unsigned int v : side.cell->vertex_indices())
        if (side.cell->vertex_index(v) != side.vertices[0] &&
            side.cell->vertex_index(v) != side.vertices[1])
          to_apex = side.cell->vertex(v) - side.corners[0];
      const dealii::Tensor<1, 2> along =
        (side.corners[1] - side.corners[0]) / side.measure;
      const double place = to_apex * along;
      // Mirrored triangles have the same constant.
      return {(to_apex - place * along).norm() / side.measure,
              std::min(place / side.measure, 1. - place / side.measure)};
    }



    /// The material of the cell above the side as triangle() sees it.
    Material
    material_above(const ContactSide &side, const Material &material)
    {
      Material result = material;
      if (!material.orthotropy)
        return result;
      const dealii::Tensor<1, 2> along =
        (side.corners[1] - side.corners[0]) / side.measure;
      const dealii::Tensor<1, 2> to_centre =
        side.cell->center() - side.corners[0];
      // Turned so that the side is the x axis, the cell may be below it, and
      // its apex may have been mirrored by triangle(). Each of the two mirrors
      // the axes of the material; both together only turn them by 180 degrees.
      const bool is_below = along[0] * to_centre[1] < along[1] * to_centre[0];
      // The apex is nearer to the second corner if the centre is.
      const bool is_turned = to_centre * along > 0.5 * side.measure;
      // An orthotropic material turns with the triangle, and is mirrored where
      // the triangle is.
      result.axis_angle -=
        std::atan2(along[1], along[0]) * 180. / dealii::numbers::PI;
      if (is_below != is_turned)
        result.axis_angle = -result.axis_angle;
      return result;
    }



    /// Raises the bound and makes the ranges narrower, in turn.
    class StagedBounds
    {
    public:
      StagedBounds(const MeanProblems             &problems,
                   const Eigen::VectorXd          &means,
                   const double                    upper,
                   const BranchAndBoundParameters &proof,
                   const Interruption             &interruption)
        : problems(problems)
        , given_means(means)
        , upper(upper)
        , proof(proof)
        , interruption(interruption)
      {
        for (const ContactSide &side : problems.contact_sides())
          {
            // At first nothing is known but u_nu <= 0 for the mean.
            known.sides.emplace_back();
            known.sides.back().ends = side.corners;
          }
      }

      GlobalBound
      run();

    private:
      const MeanProblems             &problems;
      const Eigen::VectorXd          &given_means;
      const double                    upper;
      const BranchAndBoundParameters &proof;
      const Interruption             &interruption;

      /// The bound and the ranges of the displacements with J at most the upper
      /// number, as they are known by now.
      GlobalBound known;

      /// The latest one, and its means and slopes where it is least.
      std::shared_ptr<const MeanProblem> problem;
      Eigen::VectorXd                    values;

      /// Returns the bound.
      double
      add_bound(const std::vector<double> &D, const bool is_first);

      void
      begin();

      /// Makes the ranges narrower by the latest problem. If nothing was known
      /// it has all means: then quickly, as the next one has fewer.
      void
      look(const bool is_quick);

      /// Says whether saving what may be saved of what the sides lose would
      /// make the interval narrower.
      bool
      losses_matter() const;
    };



    double
    StagedBounds::add_bound(const std::vector<double> &D, const bool is_first)
    {
      // Any bound of the tree is valid, so that it need not be better than what
      // the mesh allows: the tolerance grows with the interval that is known.
      const double             interval   = std::isfinite(known.lower) ?
                                              upper - known.lower :
                                              first_interval * std::abs(upper);
      BranchAndBoundParameters parameters = proof;
      parameters.tolerance = std::max(proof_tolerance * std::abs(upper),
                                      part_of_the_interval * interval);
      if (!is_first)
        parameters.maximum_nodes =
          std::min(parameters.maximum_nodes, n_later_nodes);
      problem = std::make_shared<const MeanProblem>(
        problems.mean_problem(known.sides, given_means, D));
      const BranchAndBoundResult bound =
        branch_and_bound(parameters,
                         {problem->S,
                          problem->g,
                          Eigen::VectorXd::Zero(problem->g.size()),
                          *problem->phi,
                          interruption},
                         given_means(problem->kept));
      // The bound is of the finite problem: its constant belongs to it, and
      // what elimination may have lost is taken off. Without a bound of the
      // tree there is none of J.
      known.nodes += bound.nodes;
      if (proof.keeps_record)
        known.stages.push_back({problem, bound.record, {}});
      const double lower =
        bound.status == ProofStatus::no_bound ?
          -infinity :
          problem->constant + bound.lower - problem->rounding;
      // Where the finite problem is least, the eliminated means and slopes
      // follow from the kept means.
      values = problem->all(bound.s);
      // Each D gives a bound for the same number, and the best one counts.
      if (lower > known.lower)
        {
          known.lower    = lower;
          known.rounding = problem->rounding;
          known.status   = bound.status;
          known.losses   = problems.losses(*problem, values);
        }
      return lower;
    }



    void
    StagedBounds::look(const bool is_quick)
    {
      ProofRecord *record = nullptr;
      for (BoundStage &stage : known.stages)
        if (stage.problem == problem)
          record = &stage.ranges.emplace_back();
      // Those who check a record have to find no more than what was found here,
      // with other rounding.
      const double margin =
        record == nullptr ?
          0. :
          margin_of_record *
            std::min(upper - known.lower, first_interval * std::abs(upper));
      shrink_ranges(
        *problem, upper + margin, is_quick, interruption, known.sides, record);
    }



    void
    StagedBounds::begin()
    {
      // What comes next needs the problem of the best bound, with the place
      // where it is least.
      std::shared_ptr<const MeanProblem> best;
      Eigen::VectorXd                    best_values;
      double                             best_lower = -infinity;
      // D is at most 2 a at first. If that proof does not end, larger ones are
      // tried, which round the law less but make the triangles softer, and the
      // better bound is taken. As long as there is none, a proof may take all
      // the nodes that the user allows.
      for (const double multiple : first_shifts)
        {
          if (const double lower =
                add_bound(problems.shifts_for_means(given_means, multiple),
                          !std::isfinite(known.lower));
              !best || lower > best_lower)
            {
              best        = problem;
              best_values = values;
              best_lower  = lower;
            }
          if (known.status == ProofStatus::proved)
            break;
        }
      problem = best;
      values  = best_values;
    }



    bool
    StagedBounds::losses_matter() const
    {
      // An interval whose width does not come from the sides, but from the
      // stresses elsewhere, is not made narrower by other shifts.
      const double loss =
        std::accumulate(known.losses.begin(), known.losses.end(), 0.);
      return part_of_losses * loss >= least_gain * (upper - known.lower);
    }



    GlobalBound
    StagedBounds::run()
    {
      const std::size_t n = known.sides.size();
      begin();
      unsigned int n_idle = 0;
      for (unsigned int stage = 0;
           stage < n_stages && !interruption.requested();
           ++stage)
        {
          // In turn: what is known of the bound makes the ranges of p = m + k
          // xi narrower (Theorem 2), and on narrower ranges the law loses less,
          // which raises the bound. Each of both holds whatever comes after it,
          // so that the best bound and the intersection of all ranges are kept.
          look(stage == 0);
          const double before = upper - known.lower;
          add_bound(problems.shifts_for_ranges(
                      known.sides,
                      values.head(n),
                      values.tail(n),
                      least_shifts[stage % least_shifts.size()]),
                    false);
          n_idle =
            upper - known.lower > (1. - least_gain) * before ? n_idle + 1 : 0;
          // The first one has only the ranges of a problem that knew nothing.
          if (n_idle == n_idle_stages || (stage > 0 && !losses_matter()))
            break;
        }
      // The last bound has something to say of the ranges, too.
      if (!interruption.requested())
        look(false);

      // J is not above the upper number somewhere, so that a bound above that
      // could only come from rounding.
      known.lower = std::min(known.lower, upper);
      // The piece of the law on which all of the range is, if it is one.
      for (std::size_t i = 0; i < n; ++i)
        {
          const PiecewiseEnergy &law    = problems.laws_of_sides()[i];
          const Interval         linear = known.sides[i].linear();
          // An interval with a kink inside has ends on different pieces.
          if (const unsigned int piece = law.index(linear.upper);
              law.index(linear.lower) == piece)
            known.sides[i].piece = piece;
        }
      return std::move(known);
    }
  } // namespace



  std::vector<double>
  side_constants(const EquilibriumProblem<2> &equilibrium,
                 const ByRegion<Material>    &materials,
                 const BoundaryConditions    &conditions)
  {
    struct Known
    {
      TriangleAboveSide shape;
      Material          material;
      bool              is_tangential_fixed;
      double            constant;
    };
    std::vector<Known>  known;
    std::vector<double> constants;
    for (const ContactSide &side : equilibrium.mesh.contact_sides)
      {
        // Lambda_I depends on shape, material and scale, and sides of one shape
        // share it: each takes a few eigenvalue problems. It is taken a little
        // lower for what rounding may have done to it. For a side that is |I|
        // times as long it is 1/|I| times as large.
        const TriangleAboveSide own = triangle(side);
        const Material          material =
          material_above(side, materials(side.cell->material_id()));
        const bool is_fixed = conditions.fixes_tangential(side.id);
        auto       same =
          std::find_if(known.begin(), known.end(), [&](const Known &other) {
            return std::abs(other.shape.height - own.height) +
                       std::abs(other.shape.apex - own.apex) <=
                     Tolerance::certificate * own.height &&
                   other.material == material &&
                   other.is_tangential_fixed == is_fixed;
          });
        if (same == known.end())
          same = known.insert(
            known.end(),
            {own, material, is_fixed, trace_constant(own, material, is_fixed)});
        constants.push_back((1. - 100. * Tolerance::certificate) *
                            same->constant / side.measure);
      }
    return constants;
  }



  GlobalBound
  bound_global(const MeanProblems             &problems,
               const Eigen::VectorXd          &means,
               const double                    upper,
               const BranchAndBoundParameters &proof,
               const Interruption             &interruption)
  {
    return StagedBounds(problems, means, upper, proof, interruption).run();
  }
} // namespace Debond
