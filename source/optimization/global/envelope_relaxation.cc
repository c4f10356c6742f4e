// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interruption.h>
#include <debond/base/tolerances.h>
#include <debond/optimization/global/envelope_relaxation.h>

#include <Eigen/Cholesky>

namespace Debond
{
  namespace
  {
    /// Where more would be needed the steps cycle; any point has a bound.
    constexpr unsigned int maximum_newton_steps = 12;

    /// Other places are numbers of parts of the envelope.
    enum Place
    {
      at_lower = -2,
      at_upper = -1
    };



    /// Where the minimum of weight/2 (s - z)^2 + e(s) is.
    int
    place_of_minimum(const ConvexEnvelope &e,
                     const double          weight,
                     const double          z)
    {
      // A minimum has z = s + e'(s) / weight, which grows with s: it is on the
      // first part whose end has an image beyond z.
      for (unsigned int p = 0; p < e.parts.size(); ++p)
        {
          const ConvexEnvelope::Part &part  = e.parts[p];
          const auto                  image = [&](const double s) {
            return s + (part.slope + part.curvature * s) / weight;
          };
          if (p == 0 && z <= image(part.lower))
            return at_lower;
          if (z < image(part.upper))
            return static_cast<int>(p);
        }
      return e.parts.empty() ? at_lower : at_upper;
    }



    /// The point that is stationary if each unknown stays where it is.
    void
    solve_for(const std::vector<int>            &places,
              const BoxProblem                  &problem,
              const std::vector<ConvexEnvelope> &envelopes,
              Eigen::VectorXd                   &s)
    {
      // With all places fixed the envelopes are parabolas or constants, and one
      // linear system gives the point.
      std::vector<int> free;
      for (unsigned int i = 0; i < places.size(); ++i)
        if (places[i] == at_lower)
          s(i) = problem.lower(i);
        else if (places[i] == at_upper)
          s(i) = problem.upper(i);
        else
          {
            s(i) = 0.;
            free.push_back(i);
          }
      if (free.empty())
        return;
      // The matrix is A, which is positive definite, with the curvatures of the
      // envelopes, which are not negative, so that there is a factor.
      const Eigen::VectorXd load = problem.g - problem.A * s;
      Eigen::MatrixXd       K(free.size(), free.size());
      Eigen::VectorXd       r(free.size());
      for (unsigned int k = 0; k < free.size(); ++k)
        {
          const int   i    = free[k];
          const auto &part = envelopes[i].parts[places[i]];
          for (unsigned int l = k; l < free.size(); ++l)
            K(l, k) = problem.A(free[l], i);
          K(k, k) += part.curvature;
          r(k) = load(i) - part.slope;
        }
      const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(K);
      factor.solveInPlace(r);
      for (unsigned int k = 0; k < free.size(); ++k)
        s(free[k]) = r(k);
    }
  } // namespace



  void
  minimise_relaxation(const BoxProblem                  &problem,
                      const std::vector<ConvexEnvelope> &envelopes,
                      Eigen::VectorXd                   &s)
  {
    // This is Newton's method for a convex function of parabolas and lines. As
    // long as the unknowns stay on their parts of the envelopes it is
    // quadratic, and one linear system gives the minimum. Nothing depends on it
    // being reached, as every point gives a bound.
    s = s.cwiseMax(problem.lower).cwiseMin(problem.upper);
    std::vector<int> places, old_places;
    for (unsigned int step = 0; step < maximum_newton_steps; ++step)
      {
        // Where each unknown would go by itself tells its place; if no place
        // changes the point is the minimum. By itself unknown i goes to the
        // least of A_ii/2 (s_i - z_i)^2 + e_i(s_i), with z_i = s_i - gradient_i
        // / A_ii; s is the minimum if and only if none moves.
        const Eigen::VectorXd gradient = problem.A * s - problem.g;
        old_places.swap(places);
        places.resize(s.size());
        for (unsigned int i = 0; i < s.size(); ++i)
          places[i] = place_of_minimum(envelopes[i],
                                       problem.A(i, i),
                                       s(i) - gradient(i) / problem.A(i, i));
        if (places == old_places || Interruption::noticed())
          return;
        solve_for(places, problem, envelopes, s);
      }
    s = s.cwiseMax(problem.lower).cwiseMin(problem.upper);
  }



  LowerBound::LowerBound(const BoxProblem &problem, const Eigen::VectorXd &x)
    : problem(problem)
    , x(x)
    , r(x.size())
    , least(x.size())
  {
    // Sums of n terms lose at most n units of their absolute sum.
    const unsigned int n = static_cast<unsigned int>(x.size());
    // The bound is J(s) of the theory page with its first term, which is not
    // negative, left out. It has to be true in spite of rounding, so each sum
    // is taken in extended precision, with the sum of the sizes of its terms
    // beside it.
    constexpr long double epsilon = std::numeric_limits<long double>::epsilon();
    long double           sum = 0., size = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        // A x in extended precision, and how large its terms are: what rounding
        // may have done to it.
        long double product = 0., terms = std::abs(problem.g(i));
        for (unsigned int j = 0; j < n; ++j)
          {
            const long double term =
              static_cast<long double>(problem.A(j, i)) * x(j);
            product += term;
            terms += std::abs(term);
          }
        // The sum of r_i s_i + f_i(s_i) over all i is least where each term is:
        // they are independent of each other.
        const ShiftedEnergy &f = problem.f[i];
        // As s_i <= 0, the largest r_i that it can be gives a bound.
        r[i]     = product - problem.g(i) + (n + 16.L) * epsilon * terms;
        least[i] = f.least(r[i], problem.lower(i), problem.upper(i));
        sum += least[i] - 0.5L * x(i) * product;
        size += std::abs(x(i)) * terms + std::abs(least[i]);
      }
    // From what rounding could have made of the sum to what is below it for
    // sure, and the same for the result as a double.
    sum -= (n + 16.L) * epsilon * size;
    value = static_cast<double>(sum);
    value -= Tolerance::epsilon * std::abs(value);
  }



  Growth
  LowerBound::growth(const unsigned int i,
                     const unsigned int piece,
                     const double       inverse_diagonal) const
  {
    // The bound without s_i's own term, which is least_i in it, and with that
    // term at s_i on the piece in its place:
    //
    //     value + (r_i s_i + f_i(s_i) - least_i) + quadratic/2 (s_i - x_i)^2.
    const PiecewiseEnergy::Piece &p = problem.f[i].pieces[piece];
    const double                  quadratic =
      1. / ((1. + Tolerance::outwards) * inverse_diagonal);
    // With all components but s_i where it is least, 1/2 (s - x)'A (s - x) is
    // 1/2 (s_i - x_i)^2 / (A^-1)_ii. The diagonal of the inverse is rounded up
    // first, so that rounding makes the growth smaller and not larger.
    const double c        = problem.f[i].convexity + p.curvature;
    const double r_i      = static_cast<double>(r[i]);
    const double least_i  = static_cast<double>(least[i]);
    const double constant = static_cast<double>(p.constant);
    const double size     = std::abs(x(i));

    // A piece between kinks can be steep. It is written about s = 0, where its
    // terms are no larger than the energy of the kinks.
    const bool   is_bounded = std::isfinite(p.lower);
    const double s =
      is_bounded ? std::min(largest(i), std::abs(p.lower)) : largest(i) + size;
    const double offset = is_bounded ? 0.5 * quadratic * size * size : 0.;
    const double rounding =
      8. * Tolerance::epsilon *
      (std::abs(value) + std::abs(least_i) + std::abs(constant) + offset +
       (std::abs(r_i) + std::abs(p.slope) +
        (is_bounded ? quadratic * size : 0.) + (std::abs(c) + quadratic) * s) *
         s);
    if (is_bounded)
      return {0.,
              value + (constant + offset - least_i) - rounding,
              r_i + p.slope - quadratic * x(i),
              c + quadratic};
    const double slope = r_i + p.slope;
    return {x(i),
            value +
              (slope * x(i) + 0.5 * c * x(i) * x(i) + constant - least_i) -
              rounding,
            slope + c * x(i),
            c + quadratic};
  }
} // namespace Debond
