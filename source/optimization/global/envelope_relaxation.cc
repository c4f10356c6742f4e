// SPDX-License-Identifier: LGPL-2.1-or-later
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

    enum Place
    {
      at_lower,
      on_piece, ///< the first of three
      at_upper = on_piece + 3
    };



    /// Where the minimum of weight/2 (s - z)^2 + e(s) is.
    int
    place_of_minimum(const ConvexEnvelope &e,
                     const double          weight,
                     const double          z)
    {
      bool first = true;
      for (int p = 0; p < 3; ++p)
        {
          const ConvexEnvelope::Piece &piece = e.pieces[p];
          if (piece.lower >= piece.upper)
            continue;
          const auto image = [&](const double s) {
            return s + (piece.slope + piece.curvature * s) / weight;
          };
          if (first && z <= image(piece.lower))
            return at_lower;
          first = false;
          if (z < image(piece.upper))
            return on_piece + p;
        }
      return first ? at_lower : at_upper;
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
              const auto &piece = envelopes[i].pieces[place - on_piece];
              s(i) = (weight * z - piece.slope) / (weight + piece.curvature);
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
          const int   i     = free[k];
          const auto &piece = envelopes[i].pieces[places[i] - on_piece];
          for (unsigned int l = k; l < free.size(); ++l)
            K(l, k) = problem.A(free[l], i);
          K(k, k) += piece.curvature;
          r(k) = load(i) - piece.slope;
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



  unsigned int
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
        if (places == old_places)
          return step;
        const Eigen::VectorXd old_s = s;
        solve_for(places, problem, envelopes, s);
        if (step < n_full_steps)
          continue;
        step_back(problem, envelopes, old_s, s);
        for (unsigned int k = 0; k < n_sweeps; ++k)
          sweep(problem, envelopes, s);
      }
    return maximum_newton_steps;
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
        const BondEnergy &f = problem.f[i];
        r[i]                = product - problem.g(i);
        least[i]            = f.least(r[i], problem.lower(i), problem.upper(i));
        sum += least[i] - 0.5L * x(i) * product;

        const double s = largest(i);
        size += (terms + std::abs(problem.g(i))) * (std::abs(x(i)) + s) +
                (std::abs(r[i]) + f.convexity * s) * s + std::abs(least[i]);
      }
    sum -= (n + 16.L) * std::numeric_limits<long double>::epsilon() * size;
    value = static_cast<double>(sum);
    value -= std::numeric_limits<double>::epsilon() * std::abs(value);
  }



  double
  LowerBound::largest(const unsigned int i) const
  {
    return std::max(std::abs(problem.lower(i)), std::abs(problem.upper(i)));
  }



  // The parabola of the bonded half is steep, and is written about s = 0, where
  // its terms are no larger than the energies of a bond.
  Growth
  LowerBound::growth_if_bonded(const unsigned int i,
                               const double       inverse_diagonal) const
  {
    const double quadratic = 1. / (inverse_rounding * inverse_diagonal);
    const double c         = problem.f[i].convexity + problem.f[i].stiffness;
    const double r_i       = static_cast<double>(r[i]);
    const double least_i   = static_cast<double>(least[i]);
    const double offset    = 0.5 * quadratic * x(i) * x(i);
    const double s         = std::min(largest(i), problem.f[i].threshold);
    const double rounding =
      8. * std::numeric_limits<double>::epsilon() *
      (std::abs(value) + std::abs(least_i) + offset +
       (std::abs(r_i) + quadratic * std::abs(x(i)) + (c + quadratic) * s) * s);
    return {0.,
            value + (offset - least_i) - rounding,
            r_i - quadratic * x(i),
            c + quadratic};
  }



  Growth
  LowerBound::growth_if_broken(const unsigned int i,
                               const double       inverse_diagonal) const
  {
    const double quadratic = 1. / (inverse_rounding * inverse_diagonal);
    const double c         = problem.f[i].convexity;
    const double r_i       = static_cast<double>(r[i]);
    const double least_i   = static_cast<double>(least[i]);
    const double energy = static_cast<double>(problem.f[i].energy_if_broken());
    const double size   = std::abs(x(i));
    const double s      = largest(i) + size;
    const double rounding = 8. * std::numeric_limits<double>::epsilon() *
                            (std::abs(value) + std::abs(least_i) + energy +
                             (std::abs(r_i) + (c + quadratic) * s) * s);
    return {x(i),
            value + (r_i * x(i) + 0.5 * c * x(i) * x(i) + energy - least_i) -
              rounding,
            r_i + c * x(i),
            c + quadratic};
  }
} // namespace Debond
