// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/interrupt.h>
#include <debond/optimization/global/envelope_relaxation.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  namespace
  {
    constexpr unsigned int maximum_newton_steps = 100;

    /// Full Newton steps; further ones must not rise, and have sweeps between
    /// them.
    constexpr unsigned int n_full_steps = 12;
    constexpr unsigned int n_sweeps     = 3;

    constexpr unsigned int maximum_halvings = 10;

    /// Covers the rounding of a diagonal entry of an inverse.
    constexpr double inverse_rounding = 1. + 1e-6;

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



    void
    sweep(const BoxProblem                  &problem,
          const std::vector<ConvexEnvelope> &envelopes,
          Eigen::VectorXd                   &s)
    {
      for (unsigned int i = 0; i < s.size(); ++i)
        {
          const double weight = problem.A(i, i);
          const double z =
            s(i) - (problem.A.col(i).dot(s) - problem.g(i)) / weight;
          const int place = place_of_minimum(envelopes[i], weight, z);
          if (place == at_lower)
            s(i) = problem.lower(i);
          else if (place == at_upper)
            s(i) = problem.upper(i);
          else
            {
              const auto &part = envelopes[i].parts[place];
              s(i) = (weight * z - part.slope) / (weight + part.curvature);
            }
        }
    }



    /// The point that is stationary if each unknown stays where it is.
    void
    solve_for(const std::vector<int>            &places,
              const BoxProblem                  &problem,
              const std::vector<ConvexEnvelope> &envelopes,
              Eigen::VectorXd                   &s)
    {
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



    double
    value(const BoxProblem                  &problem,
          const std::vector<ConvexEnvelope> &envelopes,
          const Eigen::VectorXd             &s)
    {
      double sum = s.dot(0.5 * (problem.A * s) - problem.g);
      for (unsigned int i = 0; i < s.size(); ++i)
        sum += envelopes[i].value(s(i));
      return sum;
    }



    /// Takes s into the box, and back towards old_s, which is in it, until the
    /// relaxation does not rise.
    void
    step_back(const BoxProblem                  &problem,
              const std::vector<ConvexEnvelope> &envelopes,
              Eigen::VectorXd                    old_s,
              Eigen::VectorXd                   &s)
    {
      old_s = old_s.cwiseMax(problem.lower).cwiseMin(problem.upper);
      s     = s.cwiseMax(problem.lower).cwiseMin(problem.upper);
      const double old_value = value(problem, envelopes, old_s);
      for (unsigned int k = 0;
           k < maximum_halvings && value(problem, envelopes, s) > old_value;
           ++k)
        s = 0.5 * (old_s + s);
    }
  } // namespace



  void
  minimise_relaxation(const BoxProblem                  &problem,
                      const std::vector<ConvexEnvelope> &envelopes,
                      Eigen::VectorXd                   &s)
  {
    s = s.cwiseMax(problem.lower).cwiseMin(problem.upper);
    std::vector<int> places, old_places;
    for (unsigned int step = 0; step < maximum_newton_steps; ++step)
      {
        const Eigen::VectorXd gradient = problem.A * s - problem.g;
        old_places.swap(places);
        places.resize(s.size());
        for (unsigned int i = 0; i < s.size(); ++i)
          places[i] = place_of_minimum(envelopes[i],
                                       problem.A(i, i),
                                       s(i) - gradient(i) / problem.A(i, i));
        // Any point has a bound.
        if (places == old_places || InterruptGuard::noticed())
          return;
        const Eigen::VectorXd old_s = s;
        solve_for(places, problem, envelopes, s);
        if (step < n_full_steps)
          continue;
        step_back(problem, envelopes, old_s, s);
        for (unsigned int k = 0; k < n_sweeps; ++k)
          sweep(problem, envelopes, s);
      }
  }



  LowerBound::LowerBound(const BoxProblem &problem, const Eigen::VectorXd &x)
    : problem(problem)
    , x(x)
    , r(x.size())
    , least(x.size())
  {
    // Sums of n terms lose at most n units of their absolute sum.
    const unsigned int n    = static_cast<unsigned int>(x.size());
    long double        sum  = 0.;
    long double        size = 0.; // of all terms, at the largest |s_i|
    for (unsigned int i = 0; i < n; ++i)
      {
        long double product = 0., terms = 0.;
        for (unsigned int j = 0; j < n; ++j)
          {
            const long double term =
              static_cast<long double>(problem.A(j, i)) * x(j);
            product += term;
            terms += std::abs(term);
          }
        const BranchEnergy &f = problem.f[i];
        r[i]                  = product - problem.g(i);
        least[i] = f.least(r[i], problem.lower(i), problem.upper(i));
        sum += least[i] - 0.5L * x(i) * product;

        const double s = largest(i);
        size += (terms + std::abs(problem.g(i))) * (std::abs(x(i)) + s) +
                (std::abs(r[i]) + f.convexity * s) * s + std::abs(least[i]);
      }
    sum -= (n + 16.L) * std::numeric_limits<long double>::epsilon() * size;
    value = static_cast<double>(sum);
    value -= std::numeric_limits<double>::epsilon() * std::abs(value);
  }



  Growth
  LowerBound::growth(const unsigned int i,
                     const unsigned int piece,
                     const double       inverse_diagonal) const
  {
    const BranchMinimum::Piece &p = problem.f[i].pieces[piece];
    const double quadratic        = 1. / (inverse_rounding * inverse_diagonal);
    const double c                = problem.f[i].convexity + p.curvature;
    const double r_i              = static_cast<double>(r[i]);
    const double least_i          = static_cast<double>(least[i]);
    const double constant         = static_cast<double>(p.constant);
    const double size             = std::abs(x(i));

    // A piece between kinks can be steep. It is written about s = 0, where its
    // terms are no larger than the energy of the kinks.
    const bool   is_bounded = std::isfinite(p.lower);
    const double s =
      is_bounded ? std::min(largest(i), std::abs(p.lower)) : largest(i) + size;
    const double offset = is_bounded ? 0.5 * quadratic * size * size : 0.;
    const double rounding =
      8. * std::numeric_limits<double>::epsilon() *
      (std::abs(value) + std::abs(least_i) + std::abs(constant) + offset +
       (std::abs(r_i) + std::abs(p.slope) +
        (is_bounded ? quadratic * size : 0.) + (c + quadratic) * s) *
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
