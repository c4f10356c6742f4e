// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/optimization/stationary_path.h>

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
        // The state of a minimum: contact at 0, else the piece that s_i is on,
        // of those that its bonds have not left for good. What has no bonds is
        // on one piece, whichever.
        if (bonds[i].energy == 0.)
          this->bonds[i].least = f.size() - 1;
        segments.push_back(s(i) < 0. ?
                             2 * std::max(this->bonds[i].least,
                                          f.index(s(i) / bonds[i].length)) +
                               1 :
                             0);
      }
  }



  double
  StationaryPath::derivative(const unsigned int i, const unsigned int k) const
  {
    // At the end of the piece towards 0 for contact, at the kink else.
    const double at = segments[i] == 0 ? 0. : f[(segments[i] - 1) / 2].lower;
    return bonds[i].energy / bonds[i].length * f[k].derivative(at);
  }



  double
  StationaryPath::distance(const unsigned int i, const bool opens) const
  {
    // In contact the force says when s_i leaves: once the pull on it is more
    // than that of the bonds at 0; on a piece s_i itself says when it comes to
    // an end; at a kink it is the force again, from the derivative of one piece
    // to that of the next.
    const Bond &bond = bonds[i];
    if (segments[i] == 0)
      return opens ? r(i) - derivative(i, bond.least) : infinity;
    const unsigned int k = (segments[i] - 1) / 2;
    if (is_free(i))
      return opens ? s(i) - bond.length * f[k].lower :
                     (k == bond.least ? 0. : bond.length * f[k].upper) - s(i);
    return opens ? derivative(i, k + 1) - r(i) : r(i) - derivative(i, k);
  }



  void
  StationaryPath::hold(const unsigned int i)
  {
    // So that rounding in s_i does not grow from segment to segment.
    if (segments[i] == 0)
      s(i) = 0.;
    else if (!is_free(i))
      s(i) = bonds[i].length * f[(segments[i] - 1) / 2].lower;
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
    // Segments follow each other as s_i opens; bonds that do not return go back
    // to contact from the piece they are on.
    go_on();
    // Where the derivative does not jump nothing stays at a kink.
    if (here > 0 && !is_free(i) && !f.has_drop((here - 1) / 2))
      go_on();
    hold(i);
    // What has opened to this piece stays on it or goes further.
    if (is_free(i) && !returns && change.opens)
      bonds[i].least = (here - 1) / 2;
  }



  double
  StationaryPath::stiffness(const unsigned int i) const
  {
    const Bond &bond = bonds[i];
    return S(i, i) + bond.energy / (bond.length * bond.length) *
                       f[(segments[i] - 1) / 2].curvature;
  }



  bool
  StationaryPath::factorise()
  {
    // A segment that changes changes one row of the matrix. Where the free part
    // is not positive definite a factor with pivots takes over until it is
    // again.
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
    // The components whose row in the factor is missing, superfluous or
    // another.
    std::vector<unsigned int> others;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (in_factor[i] != (is_free(i) ? segments[i] : 0))
        others.push_back(i);
    // A change takes about as long as three rows of a new factor.
    if (3 * others.size() >= free.size())
      return false;
    for (const unsigned int i : others)
      {
        // On another piece its diagonal entry is another: out, and in again.
        if (in_factor[i] != 0)
          {
            const auto place = std::find(free.begin(), free.end(), i);
            factor.remove(static_cast<unsigned int>(place - free.begin()));
            free.erase(place);
            in_factor[i] = 0;
          }
        if (!is_free(i))
          continue;
        // A pivot that is not clearly positive ends what a Cholesky factor can
        // say.
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
    // Positive definite wherever the path consists of minima, and so on most of
    // it.
    Eigen::MatrixXd M = S(free, free);
    for (unsigned int k = 0; k < free.size(); ++k)
      M(k, k) = stiffness(free[k]);
    if (factor.compute(M))
      return;
    // The half-made factor is of no use for updates.
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
    // Free components are on pieces, where r_i = w_i/l_i f'(s_i/l_i) is affine
    // in s_i; the others have their s_i from hold(). So the free ones solve a
    // linear system, with the stiffness of their pieces on its diagonal. At t
    // it is S s + r = load + (t - first_t) slope.
    Eigen::VectorXd rest = load + (parameter - first_t) * slope;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (!is_free(i) && s(i) != 0.)
        rest -= s(i) * S.col(i);
    // Two systems with one factor: where the point is at this t, which takes
    // back what rounding has gathered since the start, and how it moves with t.
    Eigen::VectorXd speeds = slope(free), point = rest(free);
    for (unsigned int k = 0; k < free.size(); ++k)
      {
        // Of the force r_i of a piece, w_i/l_i (c s_i/l_i + slope), the part
        // with s_i is in the matrix, and the constant part is moved to the
        // right side.
        const Bond &bond = bonds[free[k]];
        point(k) -=
          bond.energy / bond.length * f[(segments[free[k]] - 1) / 2].slope;
      }
    solve_free(speeds);
    solve_free(point);
    ds.setZero();
    ds(free) = speeds;
    s(free)  = point;
    dr       = slope - S * ds;
    r        = load + (parameter - first_t) * slope - S * s;
    // What opening() compares speeds with. The terms of dr cancel, so that
    // their size counts.
    largest_ds = ds.lpNorm<Eigen::Infinity>();
    largest_dr = (slope.cwiseAbs() + S.cwiseAbs() * ds.cwiseAbs()).maxCoeff();
  }



  StationaryPath::Event
  StationaryPath::advance(const double lower, const double upper)
  {
    // One straight part of the curve, from the point where it is to the next
    // breakpoint. On it the free s_i and the forces of all others are affine in
    // t, with speeds from one linear system. The part ends at the first s_i or
    // force that comes to an end of its segment, which then changes; whether t
    // rises or falls on the next part, the speeds there say.
    if (!factorise())
      return Event::no_stiffness;
    solve();
    // All go on to their next segments, or if t had to rise for some of them
    // and to fall for others, the first one does.
    const auto sense = [this](const Change &change) {
      const double speed = opening(change.i);
      return speed == 0. ? 0. : (speed > 0.) == change.opens ? 1. : -1.;
    };
    // After a breakpoint the path goes on into the new segment: t rises or
    // falls as the component that has changed asks for.
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

    // Components that come to their ends together, as on symmetric bodies, do
    // so at breakpoints that rounding sets apart.
    const double        tied = Tolerance::same_breakpoint * (upper - lower);
    const double        end  = direction > 0. ? upper : lower;
    double              step = std::max(0., direction * (end - parameter));
    std::vector<double> steps(s.size(), infinity);
    // How far the path goes: to the first end of a segment, or to the end of
    // the interval. Changes that are as far as the end come after it.
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

    // Points between breakpoints are minima if the free part is positive
    // definite and nothing rests at a kink, where f is concave.
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
    // To the breakpoint, and there each change puts its component on the next
    // segment.
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
    for (const Change &one : changes)
      change(one);
    return Event::change;
  }



  Eigen::VectorXd
  StationaryPath::point_before_kinks() const
  {
    Eigen::VectorXd result = s;
    for (unsigned int i = 0; i < s.size(); ++i)
      if (segments[i] > 0 && !is_free(i))
        result(i) = bonds[i].length * f.point_inside((segments[i] - 1) / 2);
    return result;
  }
} // namespace Debond
