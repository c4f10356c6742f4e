// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/infinity.h>
#include <debond/base/tolerances.h>
#include <debond/certify/mean_problem.h>
#include <debond/optimization/global/convex_envelope.h>
#include <debond/optimization/global/convexity_shift.h>

namespace Debond
{
  namespace
  {
    /// The least shift that is tried, relative to the stiffness of the bonds.
    constexpr double least_shift = 0.005;


    /// Larger shifts round the law by little more than nothing.
    constexpr double largest_uncertain_shift = 40.;

    /// Returns by how much the rounded law is below the law, at the most, as
    /// far from a mean as a tenth of the distance of the first kink.
    double
    largest_loss(const PiecewiseEnergy &law,
                 const RoundedEnergy   &rounded,
                 const double           mean)
    {
      // The mean at which the next bound is least is not known yet, so that
      // some places around the last one are asked.
      const PiecewiseEnergy own    = rounded.minimum();
      const double          margin = 0.1 * std::abs(law[0].lower);
      double                result = 0.;
      for (const double part : {-1., -0.5, 0., 0.5, 1.})
        {
          const double s = std::min(mean + part * margin, 0.);
          result         = std::max(result, law.value(s) - own.value(s));
        }
      return result;
    }



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
      PiecewiseEnergy          minimum;
      double                   constant = 0.;
      unsigned int             first, last; ///< of those that are left
    };



    /// @p factor times the law.
    LawInRange
    law_in_range(const PiecewiseEnergy &whole,
                 const Interval        &range,
                 const double           factor)
    {
      // Branches outside of the range of m cannot be reached by the minima that
      // are asked for, and without them fewer bonds are left to branch on. A
      // single piece is a quadratic, with its constant; of several the minimum
      // is a PiecewiseEnergy again, which is 0 at 0, so that the constant of
      // the first one is taken out and returned. All are multiplied by the
      // length of the side.
      unsigned int first = whole.index(range.upper);
      unsigned int last  = std::max(whole.index(range.lower), first);
      while (first < last && range.upper <= whole[first].lower)
        ++first;
      const PiecewiseEnergy::Piece &nearest  = whole[first];
      const auto                    in_whole = [&]() -> LawInRange {
        return {{}, whole.scaled(factor), 0., 0, whole.size() - 1};
      };
      if (first == last)
        return {Quadratic{factor * nearest.curvature,
                          factor * nearest.slope,
                          factor * static_cast<double>(nearest.constant)},
                PiecewiseEnergy::zero(),
                0.,
                first,
                last};
      // Nothing is outside of the range.
      if (first == 0 && last + 1 == whole.size())
        return in_whole();
      std::vector<EnergyPiece> pieces;
      for (unsigned int k = first; k <= last; ++k)
        pieces.push_back({factor * whole[k].curvature,
                          factor * whole[k].slope,
                          k < last ? whole[k].lower : no_end,
                          ""});
      try
        {
          return {{},
                  PiecewiseEnergy(pieces),
                  factor * static_cast<double>(nearest.constant),
                  first,
                  last};
        }
      catch (const std::invalid_argument &)
        {
          // Some piece falls below its value at 0.
          return in_whole();
        }
    }
  } // namespace



  MeanProblems::MeanProblems(const EquilibriumProblem<2> &equilibrium,
                             const std::vector<double>   &trace_constants,
                             const std::vector<PiecewiseEnergy> &laws,
                             const std::vector<double>          &energies)
    : equilibrium(equilibrium)
    , trace_constants(trace_constants)
    , energies(energies)
    , laws(laws)
    , sides(equilibrium.mesh.contact_sides)
    , n(static_cast<unsigned int>(sides.size()))
    , sharers(equilibrium.mesh.triangulation.n_active_cells(), 0)
  {
    // Sides of one triangle share its stiffness, since the sum of their theta
    // has to be less than 1.
    for (const EquilibriumMesh<2>::Side &side : sides)
      ++sharers[side.cell->active_cell_index()];
  }



  std::vector<double>
  MeanProblems::shifts_for_means(const Eigen::VectorXd &means,
                                 const double           multiple) const
  {
    std::vector<double> shifts;
    for (unsigned int i = 0; i < n; ++i)
      {
        const PiecewiseEnergy &law     = laws[i];
        const double           largest = multiple * law[0].curvature;
        double                 D       = 0.02 * law[0].curvature;
        // D is just so large that the result's mean is not where the envelope
        // differs from the law: then nothing is lost there.
        while (D < largest && RoundedEnergy(law, D).is_rounded_near(means(i)))
          D *= 1.25;
        shifts.push_back(std::min({D, largest, available(i)}));
      }
    return shifts;
  }



  std::vector<double>
  MeanProblems::shifts_for_ranges(const std::vector<CertifiedSide> &ranges,
                                  const Eigen::VectorXd            &means,
                                  const Eigen::VectorXd            &slopes,
                                  const double least_multiple) const
  {
    std::vector<double> shifts;
    for (unsigned int i = 0; i < n; ++i)
      {
        const PiecewiseEnergy &law = laws[i];
        const double           a   = law[0].curvature;
        // What D costs at the last m and k: theta = D/Lambda of the energy of
        // the triangle, D k^2/6 |I| for the slope, and what the rounded law is
        // below the law. A D for which the whole range is on one piece loses
        // only the first of them.
        const double of_stiffness = 0.5 * energies[i] / trace_constants[i];
        const double of_slope = sides[i].measure * slopes(i) * slopes(i) / 6.;
        double       best     = least_shift * a;
        double       least    = infinity;
        // D grows by factors, up to what the triangle has. It ends once the
        // piece is certain, as more would only cost stiffness.
        for (double D = best; D < available(i); D *= 1.2)
          {
            const RoundedEnergy rounded(law, D);
            const bool          is_certain =
              rounded.exact_piece(ranges[i].linear()).has_value();
            // Beyond this a shift rounds the law by so little that only one
            // that makes the piece certain is worth the stiffness that it
            // takes.
            if (!is_certain && D > largest_uncertain_shift * a)
              continue;
            double cost = D * of_stiffness;
            if (!is_certain)
              cost += D * of_slope +
                      sides[i].measure * largest_loss(law, rounded, means(i));
            if (cost < least)
              {
                least = cost;
                best  = D;
              }
            if (is_certain)
              break;
          }
        if (!RoundedEnergy(law, best).exact_piece(ranges[i].linear()))
          best = std::max(best, least_multiple * a);
        shifts.push_back(std::min(best, available(i)));
      }
    return shifts;
  }



  std::vector<double>
  MeanProblems::losses(const MeanProblem     &problem,
                       const Eigen::VectorXd &means_and_slopes) const
  {
    std::vector<double> result;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double D = problem.shifts[i];
        // The parts by which the bound at these m and k misses J: 1/2 theta
        // a_Q(u,u), and where the piece is not certain the rounded law and the
        // slope.
        result.push_back(0.5 * D / trace_constants[i] * energies[i]);
        if (problem.pieces[i])
          continue;
        const PiecewiseEnergy &law = laws[i];
        const double           s   = std::min(means_and_slopes(i), 0.);
        const double           k   = means_and_slopes(n + i);
        const double rounded       = RoundedEnergy(law, D).minimum().value(s);
        const double c             = law[law.index(s)].curvature;
        result.back() +=
          sides[i].measure * (law.value(s) - rounded + (c + D) * k * k / 6.);
      }
    return result;
  }



  namespace
  {
    /// Eliminates from 1/2 x'A x - b'x what the problem does not keep; false if
    /// the others are not safely determined.
    bool
    eliminate(const Eigen::MatrixXd &A,
              const Eigen::VectorXd &b,
              MeanProblem           &result)
    {
      const unsigned int        n      = result.n_sides();
      std::vector<unsigned int> others = result.eliminated;
      for (unsigned int i = 0; i < n; ++i)
        others.push_back(n + i);
      // The existence of the inverse is the proof that the problem is convex in
      // the others. The others lower the energy by 1/2 r'A_oo^{-1} r for forces
      // r on them, and safe_inverse() is not below the true inverse: with it
      // what remains is a lower bound for all s.
      auto inverse = safe_inverse(A(others, others));
      if (!inverse)
        return false;
      result.inverse_in_others       = std::move(*inverse);
      const Eigen::VectorXd b_others = b(others);
      const Eigen::MatrixXd mixed    = A(others, result.kept);
      result.offset                  = result.inverse_in_others * b_others;
      result.to_others               = -result.inverse_in_others * mixed;
      // With y = A_oo^{-1} (b_o - A_ok s), the others at their best, what
      // remains is - 1/2 b_o'A_oo^{-1} b_o + 1/2 s'(A_kk - A_ko A_oo^{-1} A_ok)
      // s - (b_k - A_ko A_oo^{-1} b_o)'s.
      result.constant -= 0.5 * b_others.dot(result.offset);
      const Eigen::MatrixXd S =
        A(result.kept, result.kept) + mixed.transpose() * result.to_others;
      result.S = 0.5 * (S + S.transpose());
      // Shifts may take more than the bonds of stiff laws leave.
      if (!is_safely_positive_definite(result.S))
        return false;
      result.g = b(result.kept) + result.to_others.transpose() * b_others;
      return true;
    }
  } // namespace



  std::optional<MeanProblem>
  MeanProblems::try_mean_problem(const std::vector<CertifiedSide> &ranges,
                                 const Eigen::VectorXd            &means,
                                 const std::vector<double>        &D) const
  {
    // G_theta of Theorem 1: the triangles above the sides are 1 - theta_I times
    // as stiff. Too much taken from them may leave a matrix that is indefinite
    // to rounding; then there is no problem with these D, and smaller ones are
    // tried. theta_I = D_I / Lambda_I, since D_I = theta_I Lambda_I is what
    // Theorem 1 may take for the part of v_nu that is not linear.
    std::vector<double> weights(sharers.size(), 1.);
    for (unsigned int i = 0; i < n; ++i)
      weights[sides[i].cell->active_cell_index()] -= D[i] / trace_constants[i];
    std::unique_ptr<const Condensation> condensed;
    try
      {
        condensed = equilibrium.condense(weights);
      }
    catch (const StressRoundingError &)
      {
        return {};
      }
    auto [A, b] = MeansAndSlopes(*condensed);

    MeanProblem result;
    result.shifts   = D;
    result.constant = condensed->energy_at_zero();
    std::vector<PiecewiseEnergy> kept_laws;
    const PiecewiseEnergy        zero = PiecewiseEnergy::zero();
    for (unsigned int i = 0; i < n; ++i)
      {
        const double             length = sides[i].measure;
        const PiecewiseEnergy   &law    = laws[i];
        const RoundedEnergy      rounded(law, D[i]);
        std::optional<Quadratic> quadratic;
        // Theorem 2 asks for the range of p, the law of Theorem 1 for that of
        // its mean.
        result.pieces.push_back(rounded.exact_piece(ranges[i].linear()));
        // By Theorem 2 a side whose range is on one piece has a quadratic term
        // in m and k, and its mean is eliminated if it is not in contact; by
        // Theorem 1 the others have the rounded law of m and lose D k^2/6.
        if (result.pieces.back())
          {
            const PiecewiseEnergy::Piece &piece = law[*result.pieces.back()];
            quadratic = Quadratic{length * piece.curvature,
                                  length * piece.slope,
                                  length * static_cast<double>(piece.constant)};
            result.laws.push_back({piece});
            // c/2 (m^2 + k^2/3) |I|; the part of m^2 follows below.
            A(n + i, n + i) += length * piece.curvature / 3.;
          }
        else
          {
            // -|I| D k^2/6. If the rounded law has one piece in the range of m,
            // that is quadratic, too.
            A(n + i, n + i) -= length * D[i] / 3.;
            const PiecewiseEnergy whole = rounded.minimum();
            const LawInRange own = law_in_range(whole, ranges[i].mean, length);
            result.laws.emplace_back();
            for (unsigned int k = own.first; k <= own.last; ++k)
              result.laws.back().push_back(whole[k]);
            quadratic = own.quadratic;
            if (!quadratic)
              {
                kept_laws.push_back(own.minimum);
                result.constant += own.constant;
              }
          }
        if (quadratic)
          {
            A(i, i) += quadratic->curvature;
            b(i) -= quadratic->slope;
            result.constant += quadratic->constant;
            // If the range excludes contact, m <= 0 says nothing, and m is
            // eliminated like a slope. Otherwise it is kept, with the law zero
            // beside its quadratic term.
            if (ranges[i].mean.upper < 0.)
              {
                result.eliminated.push_back(i);
                continue;
              }
            kept_laws.push_back(zero);
          }
        result.kept.push_back(i);
      }
    // Branch and bound needs an unknown, so that one is kept even if all could
    // be eliminated.
    if (result.kept.empty())
      {
        result.kept.push_back(result.eliminated.back());
        result.eliminated.pop_back();
        kept_laws.push_back(zero);
      }

    if (!eliminate(A, b, result))
      return {};
    result.phi = std::make_unique<SeparableEnergy>(kept_laws);

    // The reserve for rounding is measured at the result, where the bound is to
    // be tight.
    const Eigen::VectorXd at = result.all(means(result.kept));
    result.rounding          = equilibrium.rounding_of(*condensed,
                                              MeansAndSlopes::unknowns(at),
                                              weights);
    return result;
  }



  MeanProblem
  MeanProblems::mean_problem(const std::vector<CertifiedSide> &ranges,
                             const Eigen::VectorXd            &means,
                             std::vector<double>               D) const
  {
    constexpr unsigned int trials = 12;
    // Shifts that take too much stiffness leave a problem that is not convex in
    // what is eliminated. Half of them is a valid choice as well.
    for (unsigned int trial = 0; trial < trials; ++trial)
      {
        if (auto problem = try_mean_problem(ranges, means, D))
          return std::move(*problem);
        for (double &shift : D)
          shift *= 0.5;
      }
    throw EquilibriumError("the equilibrated stresses are not determined by "
                           "the mean displacements of the contact sides");
  }
} // namespace Debond
