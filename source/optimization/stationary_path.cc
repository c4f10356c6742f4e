// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/tolerances.h>
#include <debond/optimization/stationary_path.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Debond
{
  StationaryPath::StationaryPath(const Problem    &problem,
                                 const VectorView &s,
                                 const double      t)
    : S(problem.S)
    , load(problem.load)
    , slope(problem.slope)
    , first_t(t)
    , f(problem.f)
    , bonds(problem.bonds)
    , returns(problem.returns)
    , parameter(t)
    , s(s)
    , r(load - S * s)
    , ds(Eigen::VectorXd::Zero(s.size()))
    , dr(Eigen::VectorXd::Zero(s.size()))
    , in_factor(s.size(), 0)
  {
    factor.reserve(static_cast<unsigned int>(s.size()));
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        // What has no bonds is on one piece, whichever.
        if (bonds[i].energy == 0.)
          this->bonds[i].least = f.size() - 1;
        segments.push_back(s(i) < 0. ?
                             2 * std::max(this->bonds[i].least,
                                          f.index(s(i) / bonds[i].stretch)) +
                               1 :
                             0);
      }
  }



  double
  StationaryPath::derivative(const unsigned int i, const unsigned int k) const
  {
    // At the end of the piece towards 0 for contact, at the kink else.
    const double at = segments[i] == 0 ? 0. : f[(segments[i] - 1) / 2].lower;
    return bonds[i].energy / bonds[i].stretch * f[k].derivative(at);
  }



  double
  StationaryPath::distance(const unsigned int i, const bool opens) const
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Bond      &bond     = bonds[i];
    if (segments[i] == 0)
      return opens ? r(i) - derivative(i, bond.least) : infinity;
    const unsigned int k = (segments[i] - 1) / 2;
    if (is_free(i))
      return opens ? s(i) - bond.stretch * f[k].lower :
                     (k == bond.least ? 0. : bond.stretch * f[k].upper) - s(i);
    return opens ? derivative(i, k + 1) - r(i) : r(i) - derivative(i, k);
  }



  void
  StationaryPath::hold(const unsigned int i)
  {
    if (segments[i] == 0)
      s(i) = 0.;
    else if (!is_free(i))
      s(i) = bonds[i].stretch * f[(segments[i] - 1) / 2].lower;
  }



  void
  StationaryPath::change(const Change &change)
  {
    const unsigned int i     = change.i;
    const Segment      first = 2 * bonds[i].least + 1;
    Segment           &here  = segments[i];
    const auto         go_on = [&]() {
      if (change.opens)
        here = here == 0 ? first : here + 1;
      else
        here = here == first ? 0 : here - 1;
    };
    go_on();
    // Where the derivative does not jump nothing stays at a kink.
    if (here > 0 && !is_free(i) && !f.has_drop((here - 1) / 2))
      go_on();
    hold(i);
    if (is_free(i) && !returns && change.opens)
      bonds[i].least = (here - 1) / 2;
  }



  double
  StationaryPath::stiffness(const unsigned int i) const
  {
    const Bond &bond = bonds[i];
    return S(i, i) + bond.energy / (bond.stretch * bond.stretch) *
                       f[(segments[i] - 1) / 2].curvature;
  }



  bool
  StationaryPath::factorise()
  {
    const bool has_factor = !indefinite;
    indefinite.reset();
    if (!has_factor || !update_factor())
      make_factor();
    return (indefinite ? indefinite->rcond() : factor.condition_bound()) >=
           Tolerance::condition_on_path;
  }



  bool
  StationaryPath::update_factor()
  {
    std::vector<unsigned int> others;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (in_factor[i] != (is_free(i) ? segments[i] : 0))
        others.push_back(i);
    // A change takes about as long as three rows of a new factor.
    if (3 * others.size() >= free.size())
      return false;
    for (const unsigned int i : others)
      {
        if (in_factor[i] != 0)
          {
            const auto place = std::find(free.begin(), free.end(), i);
            factor.remove(static_cast<unsigned int>(place - free.begin()));
            free.erase(place);
            in_factor[i] = 0;
          }
        if (!is_free(i))
          continue;
        const double diagonal = stiffness(i);
        if (!(diagonal > 0.) || !(factor.append(S.col(i)(free),
                                                diagonal,
                                                Tolerance::condition_on_path) >
                                  Tolerance::condition_on_path))
          return false;
        free.push_back(i);
        in_factor[i] = segments[i];
      }
    return true;
  }



  void
  StationaryPath::make_factor()
  {
    free.clear();
    for (unsigned int i = 0; i < s.size(); ++i)
      {
        in_factor[i] = is_free(i) ? segments[i] : 0;
        if (is_free(i))
          free.push_back(i);
      }
    Eigen::MatrixXd M = S(free, free);
    for (unsigned int k = 0; k < free.size(); ++k)
      M(k, k) = stiffness(free[k]);
    if (factor.compute(M))
      return;
    std::fill(in_factor.begin(), in_factor.end(), 0);
    indefinite.emplace(M);
  }



  void
  StationaryPath::solve_free(Eigen::VectorXd &b) const
  {
    if (indefinite)
      b = indefinite->solve(b).eval();
    else
      factor.solve_in_place(b);
  }



  void
  StationaryPath::solve()
  {
    // Of s at t: S s + r = load + (t - first_t) slope, r known by s_i on
    // pieces.
    Eigen::VectorXd rest = load + (parameter - first_t) * slope;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (!is_free(i) && s(i) != 0.)
        rest -= s(i) * S.col(i);
    Eigen::VectorXd speeds = slope(free), point = rest(free);
    for (unsigned int k = 0; k < free.size(); ++k)
      {
        const Bond &bond = bonds[free[k]];
        point(k) -=
          bond.energy / bond.stretch * f[(segments[free[k]] - 1) / 2].slope;
      }
    solve_free(speeds);
    solve_free(point);
    ds.setZero();
    ds(free)   = speeds;
    s(free)    = point;
    dr         = slope - S * ds;
    r          = load + (parameter - first_t) * slope - S * s;
    largest_ds = ds.lpNorm<Eigen::Infinity>();
    largest_dr = (slope.cwiseAbs() + S.cwiseAbs() * ds.cwiseAbs()).maxCoeff();
  }



  StationaryPath::Event
  StationaryPath::advance(const double lower, const double upper)
  {
    if (!factorise())
      return Event::no_stiffness;
    solve();
    // All go on to their next segments, or if t had to rise for some of them
    // and to fall for others, the first one does.
    const auto sense = [this](const Change &change) {
      const double speed = opening(change.i);
      return speed == 0. ? 0. : (speed > 0.) == change.opens ? 1. : -1.;
    };
    if (!changes.empty())
      {
        const auto first = sense(changes[0]);
        if (std::any_of(changes.begin(), changes.end(), [&](const Change &c) {
              return sense(c) != first;
            }))
          {
            for (unsigned int k = 1; k < changes.size(); ++k)
              {
                segments[changes[k].i]    = changes[k].from;
                bonds[changes[k].i].least = changes[k].least;
                hold(changes[k].i);
              }
            changes.resize(1);
            if (!factorise())
              return Event::no_stiffness;
            solve();
          }
        direction = sense(changes[0]);
        if (direction == 0.)
          return Event::degenerate;
      }

    const double        tied = Tolerance::same_breakpoint * (upper - lower);
    const double        end  = direction > 0. ? upper : lower;
    double              step = std::max(0., direction * (end - parameter));
    std::vector<double> steps(s.size(),
                              std::numeric_limits<double>::infinity());
    // Changes that are as far as the end come after it.
    const double before_end  = step - tied;
    bool         reaches_end = true;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (const double speed = direction * opening(i); speed != 0.)
        {
          steps[i] = std::max(0., distance(i, speed > 0.)) / std::abs(speed);
          if (steps[i] < before_end && steps[i] <= step)
            {
              step        = steps[i];
              reaches_end = false;
            }
        }

    const double tie = step + tied;
    is_unstable      = indefinite.has_value();
    for (unsigned int i = 0; i < s.size(); ++i)
      is_unstable = is_unstable || (segments[i] > 0 && !is_free(i));
    changes.clear();
    if (!reaches_end)
      for (unsigned int i = 0; i < s.size(); ++i)
        if (steps[i] <= tie)
          changes.push_back(
            {i, direction * opening(i) > 0., segments[i], bonds[i].least});
    s += direction * step * ds;
    r += direction * step * dr;
    parameter = reaches_end ? end : parameter + direction * step;
    if (reaches_end)
      {
        // What changes there has come to its change.
        for (unsigned int i = 0; i < s.size(); ++i)
          if (is_free(i) && steps[i] <= tie)
            s(i) += direction * opening(i) > 0. ? -distance(i, true) :
                                                  distance(i, false);
        return Event::end;
      }
    bool has_bonds = false;
    for (const Change &one : changes)
      {
        change(one);
        has_bonds = has_bonds || (one.from > 0 && segments[one.i] > 0);
      }
    return has_bonds ? Event::bond : Event::contact;
  }



  Eigen::VectorXd
  StationaryPath::point_before_kinks() const
  {
    Eigen::VectorXd result = s;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (segments[i] > 0 && !is_free(i))
        result(i) = bonds[i].stretch * f.point_inside((segments[i] - 1) / 2);
    return result;
  }
} // namespace Debond
