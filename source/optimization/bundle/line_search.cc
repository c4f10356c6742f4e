// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/bundle/line_search.h>

#include <cmath>

namespace Debond
{
  std::string
  to_string(const StepKind kind)
  {
    static const char *const words[] = {"long", "short", "null"};
    return words[static_cast<unsigned int>(kind)];
  }



  namespace
  {
    /// Bisections for t_R.
    constexpr unsigned int maximum_bisections = 60;



    /// t_L and J(x_k + t_L d_k) - J(x_k) by the given rule; zero if there is
    /// no descent.
    void
    find_descent(const Functional::Line         &line,
                 const double                    v,
                 const ProximalBundleParameters &parameters,
                 LineSearchResult               &result)
    {
      // (14).
      const auto descends = [&](const double t, const double change) {
        return change <= parameters.m_L * t * v;
      };

      // The first of 1, 1/2, 1/4, ... with (14).
      double t = 1., change = line.change(t), change_at_twice_t = change;
      while (!descends(t, change))
        {
          t *= 0.5;
          if (t < Tolerance::no_step)
            return;
          change_at_twice_t = change;
          change            = line.change(t);
        }

      // On along the sequence as long as J falls.
      if (parameters.line_search == DescentRule::minimum)
        for (double half = line.change(0.5 * t);
             half < change && descends(0.5 * t, half) && t > Tolerance::no_step;
             half = line.change(0.5 * t))
          {
            t *= 0.5;
            change_at_twice_t = change;
            change            = half;
          }
      result.t_L    = t;
      result.change = change;
      if (t == 1.)
        return;

      if (parameters.line_search == DescentRule::minimum)
        {
          // The parabola slope t + curvature / 2 t^2 through t = 0, t and 2 t
          // is the change of J itself as long as no bond changes its piece
          // (and the pieces are parabolas).
          const double curvature = (change_at_twice_t - 2. * change) / (t * t);
          const double slope     = (4. * change - change_at_twice_t) / (2. * t);
          if (curvature > 0. && slope < 0.)
            {
              const double t_minimum = std::min(1., -slope / curvature);
              const double minimum   = line.change(t_minimum);
              if (minimum < change && descends(t_minimum, minimum))
                {
                  result.t_L    = t_minimum;
                  result.change = minimum;
                }
            }
        }
      else if (parameters.line_search == DescentRule::largest)
        {
          // The paper's words: between t, which has (14), and 2 t, which has
          // not.
          double upper = 2. * t;
          for (unsigned int i = 0; i < maximum_bisections; ++i)
            {
              const double middle           = 0.5 * (result.t_L + upper);
              const double change_at_middle = line.change(middle);
              if (descends(middle, change_at_middle))
                {
                  result.t_L    = middle;
                  result.change = change_at_middle;
                }
              else
                upper = middle;
            }
        }
    }
  } // namespace



  LineSearchResult
  line_search(const Functional::Line         &line,
              const DofVector                &d,
              const double                    d_norm,
              const double                    v,
              const ProximalBundleParameters &parameters,
              DofVector                      &eta)
  {
    // Two parameters on the line x_k + t d_k: t_L, up to which J falls enough
    // (14), and t_R, at which a subgradient is taken that the model does not
    // know yet (15). If t_L >= t_bar they are the same. Values of J are
    // differences from J(x_k), since all conditions compare with v_k, which
    // becomes far smaller than J.
    LineSearchResult result;
    find_descent(line, v, parameters, result);

    // The new subgradient at y_{k+1} with its alpha and beta as seen from
    // x_{k+1}.
    const auto evaluate = [&](const double t_R, const double change) {
      result.t_R = t_R;
      line.subgradient(t_R, eta);
      result.slope          = eta * d;
      const double t_beyond = t_R - result.t_L;
      const double distance = t_beyond * d_norm;
      // This is the linearisation error alpha_j^k of the paper for y_{k+1},
      // with differences from J(x_k) in place of both values of J.
      result.alpha = result.change - change + t_beyond * result.slope;
      result.beta  = std::max(std::abs(result.alpha),
                             parameters.gamma * distance * distance);
    };

    // A long step takes y_{k+1} = x_{k+1}.
    if (result.t_L >= parameters.t_bar)
      {
        result.kind = StepKind::long_step;
        evaluate(result.t_L, result.change);
        result.success = true;
        return result;
      }

    // A short step or a null step needs a t_R > t_L with (15).
    result.kind = result.t_L > 0. ? StepKind::short_step : StepKind::null_step;
    // Near t_L there may be only subgradients that predict the descent; beyond
    // the discontinuity of the gradient that ended it there are steep ones.
    // Bisection goes between both.
    double lower = result.t_L;
    double upper = result.t_L > 0. ? 2. * result.t_L : 1.;
    for (unsigned int i = 0; i < maximum_bisections; ++i)
      {
        const double middle = 0.5 * (lower + upper);
        evaluate(middle, line.change(middle));
        // (15): the cut of this subgradient exceeds the predicted descent at
        // d_k by (1 - m_R) |v_k|, so that the next direction is another one.
        if (-result.beta + result.slope >= parameters.m_R * v)
          {
            result.success = true;
            return result;
          }
        // Steep enough but too far away, or not yet there?
        if (result.slope >= parameters.m_R * v)
          upper = middle;
        else
          lower = middle;
      }

    // After a descent the subgradient at the new point is good enough to go
    // on; without one, nothing would change.
    if (result.t_L > 0.)
      {
        evaluate(result.t_L, result.change);
        result.success = true;
      }
    return result;
  }

} // namespace Debond
