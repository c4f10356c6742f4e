// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/optimization/majorise/bound_qp.h>
#include <debond/solve/path/bond_change.h>

namespace Debond
{
  namespace
  {
    using Event = StationaryPath::Event;



    /// The factor that changes, at a part of the way between two steps: that of
    /// the loads, or that of prescribed displacements if the loads stay.
    double
    factor_between(const LoadFactors first,
                   const LoadFactors last,
                   const double      part)
    {
      return first.loads != last.loads ?
               first.loads + part * (last.loads - first.loads) :
               first.displacements +
                 part * (last.displacements - first.displacements);
    }



    /// The factor of the first change if displacements are proportional to the
    /// factor and bonds are at nodes. Then each bond comes to an end of its
    /// piece at a multiple of the present factor, and no path has to be
    /// followed.
    template <int dim>
    std::optional<double>
    proportional_change(const PiecewiseEnergy       &branches,
                        const AdhesionIntegral<dim> &bonds,
                        const PathPoint             &last,
                        const double                 factor)
    {
      // All factors are multiples of the present one. A change counts if it
      // comes before the end of the step, whether the load grows or falls; each
      // bond can only leave its piece by the end that lies ahead, and bonds
      // that do not heal do not return.
      double     first     = factor / last.factors.loads;
      const bool increases = first > 1.;
      bool       changes   = false;
      // A node in contact stays there while the factor only scales the state.
      for (unsigned int i = 0; i < last.s.size(); ++i)
        if (last.s(i) < 0.)
          {
            const double       length = bonds.points().bonds_at(i).length;
            const unsigned int k = std::max(branches.index(last.s(i) / length),
                                            bonds.least_piece(i));
            if (increases ? k + 1 == branches.size() :
                            k <= bonds.least_piece(i))
              continue;
            const double reached =
              length * (increases ? branches[k].lower : branches[k].upper) /
              last.s(i);
            if (increases ? reached < first : reached > first)
              {
                changes = true;
                first   = reached;
              }
          }
      return changes ? std::optional<double>(first * last.factors.loads) :
                       std::nullopt;
    }



    /// The first change on the way from rest, where all nodes are about to
    /// leave contact or to press on it. The state grows in proportion to the
    /// load until bonds change, and one problem with s <= 0 and the initial
    /// stiffness of the bonds decides which nodes leave.
    template <int dim>
    std::optional<double>
    change_from_rest(const CondensedScene<dim>   &scene,
                     const AdhesionIntegral<dim> &bonds,
                     const PathPoint             &last,
                     const LoadFactors            next)
    {
      // As long as bonds stay on their first pieces, the responses of S + E
      // with s <= 0 to all smaller loads are parts of the response to the next
      // one, and on the way there a bond may come to the end of its piece.
      const Eigen::VectorXd zero      = Eigen::VectorXd::Zero(last.s.size());
      Eigen::MatrixXd       stiffness = scene.condensed.schur_complement();
      stiffness += bonds.curvature(zero);
      ActiveSet active(last.s.size(), 0);
      std::fill_n(active.begin(), bonds.n_nodes(), 1);
      const BoundQPResult at_next =
        solve_bound_qp(stiffness,
                       scene.load(next),
                       bonds.contact_boundary().upper_bounds(),
                       active);
      if (at_next.status != SolverStatus::success)
        return {};
      const double part = bonds.first_change(zero, at_next.x, 1.);
      return part == 1. ?
               std::nullopt :
               std::make_optional(factor_between(last.factors, next, part));
    }



    /// The first change if bonds are at quadrature points between nodes, or
    /// shear. On the way to it all bonds are linear springs, which S + E
    /// contains; nodes come into contact and leave it, and each straight piece
    /// of the way is searched for a point that reaches a kink.
    template <int dim>
    std::optional<double>
    change_between_nodes(const CondensedScene<dim>   &scene,
                         const AdhesionIntegral<dim> &bonds,
                         const PathPoint             &last,
                         const LoadFactors            next,
                         const Interruption          &interruption)
    {
      StationaryPath::Problem problem =
        scene.between(last.factors, next, 1., bonds);
      const AdhesionIntegral<dim> here = bonds.at(last.factors.displacements);
      const Eigen::SparseMatrix<double> springs   = here.curvature(last.s);
      Eigen::MatrixXd                   stiffness = problem.S;
      stiffness += springs;
      // The bonds on their pieces are part of stiffness and load, so that the
      // path itself has no law and only contact makes its breakpoints.
      const PiecewiseEnergy no_law = PiecewiseEnergy::zero();
      problem.load += springs * last.s - here.subgradient(last.s);
      // Displacements along tangents have no bound, so that they are
      // eliminated: with the stiffness K of body and springs they follow from s
      // and the load by K_tt u_t = g_t - K_tn s. S is then the Schur
      // complement, and its load is reduced in the same way.
      const Eigen::Index    n = bonds.n_nodes(), m = last.s.size() - n;
      const Eigen::MatrixXd to_tangents = stiffness.topRightCorner(n, m);
      const Eigen::LLT<Eigen::MatrixXd> of_tangents(
        stiffness.bottomRightCorner(m, m));
      const Eigen::MatrixXd by_normals =
        of_tangents.solve(to_tangents.transpose());
      const Eigen::VectorXd by_load  = of_tangents.solve(problem.load.tail(m));
      const Eigen::VectorXd by_slope = of_tangents.solve(problem.slope.tail(m));
      const Eigen::MatrixXd S =
        stiffness.topLeftCorner(n, n) - to_tangents * by_normals;
      // Displacements that supports prescribe move with the factor, and the
      // bonds of vertices that they hold with them.
      const auto at = [&](const double passed) {
        return bonds.at(last.factors.displacements +
                        passed *
                          (next.displacements - last.factors.displacements));
      };
      // The first change on a straight part of the way, between the parts
      // `from` and `to` of the whole: a point of the rule that comes to the end
      // of its piece there. If none does the part is 1, and there is no change.
      const auto change = [&](const double           from,
                              const Eigen::VectorXd &s,
                              const double           to,
                              const Eigen::VectorXd &next_s) {
        const double part = at(from).first_change_to(at(to), s, next_s);
        return part == 1. ?
                 std::nullopt :
                 std::make_optional(factor_between(last.factors,
                                                   next,
                                                   from + part * (to - from)));
      };
      if (n == 0)
        return change(0., last.s, 1., by_load + by_slope);
      StationaryPath path({S,
                           problem.load.head(n) - to_tangents * by_load,
                           problem.slope.head(n) - to_tangents * by_slope,
                           no_law,
                           {static_cast<std::size_t>(n), {0., 1., 0}},
                           true},
                          last.s.head(n),
                          0.);
      // All unknowns at the present t: the normal displacements of the path,
      // and the tangential ones that follow from them.
      const auto point = [&]() {
        Eigen::VectorXd s(last.s.size());
        s << path.point(),
          by_load + path.t() * by_slope - by_normals * path.point();
        return s;
      };
      Event event = Event::contact;
      // Contact that comes and goes more than twice a node goes round in a
      // circle by rounding; then nothing is known.
      for (unsigned int k = 0;
           event == Event::contact && k < 2 * last.s.size() &&
           !interruption.requested();
           ++k)
        {
          const Eigen::VectorXd before = point();
          const double          t      = path.t();
          event                        = path.advance(0., 1.);
          if (event != Event::contact && event != Event::end)
            return {};
          if (const auto factor = change(t, before, path.t(), point()))
            return factor;
        }
      return {};
    }
  } // namespace



  template <int dim>
  std::optional<double>
  first_bond_change(const CondensedScene<dim>   &scene,
                    const AdhesionIntegral<dim> &bonds,
                    const PathPoint             &last,
                    const LoadFactors            next,
                    const Interruption          &interruption)
  {
    const PiecewiseEnergy &branches = scene.scene.law().pieces();
    // A law of one piece has no change, and bonds that soften change by and by.
    if (branches.size() == 1 || branches.softens())
      return {};
    bool has_slope = false;
    for (unsigned int k = 0; k < branches.size(); ++k)
      has_slope = has_slope || branches[k].slope != 0.;
    // The cheapest way that is right is taken. Without gaps, slopes of the law
    // and other factors all displacements are proportional to the factor, and
    // the change is a quotient. At rest one problem with bounds gives the
    // direction of the whole way. Otherwise the way is straight between changes
    // of contact, and the path of stationary points is followed over them.
    const LoadPathParameters   &load_path = scene.scene.parameters().load_path;
    const ElasticUnknowns<dim> &unknowns  = scene.scene.problem().unknowns();
    const bool                  is_proportional =
      last.factors.loads != 0. && !has_slope && !unknowns.has_gap() &&
      load_path.displacement_factors.empty() && load_path.dead_loads.empty();
    const bool is_at_rest =
      !has_slope && last.s.isZero(0.) && scene.load(last.factors).isZero(0.);
    if (!bonds.points().is_nodal() || bonds.shears())
      {
        // Displacements that are prescribed on the contact boundary change the
        // springs' forces between nodes with the factor, so that the change is
        // not known.
        const bool has_held =
          !unknowns.contact().boundary().held_vertices.empty();
        if (has_held && !bonds.points().is_nodal())
          return {};
        if (is_at_rest && !has_held)
          return change_from_rest(scene, bonds, last, next);
        if (!is_proportional || has_held)
          return change_between_nodes(scene, bonds, last, next, interruption);
        // Displacements are proportional to the factor, so that the whole way
        // is straight, and its first change is that of any point of the rule.
        const double          whole = next.loads / last.factors.loads - 1.;
        const Eigen::VectorXd way   = whole * last.s;
        const double          part  = bonds.first_change(last.s, way, 1.);
        return part == 1. ?
                 std::nullopt :
                 std::make_optional(factor_between(last.factors, next, part));
      }
    if (is_at_rest)
      return change_from_rest(scene, bonds, last, next);
    if (is_proportional)
      return proportional_change(branches, bonds, last, next.loads);

    StationaryPath path(scene.between(last.factors, next, 1., bonds),
                        last.s,
                        0.);
    // Changes of contact are passed until a bond changes, and one at the very
    // end of the step counts. More than two changes of contact for each node
    // would be rounding.
    Event event = Event::contact;
    for (unsigned int k = 0; event == Event::contact && k < 2 * last.s.size() &&
                             !interruption.requested();
         ++k)
      event = path.advance(0., 1. + Tolerance::end_of_path);
    if (event != Event::bond)
      return {};
    return factor_between(last.factors, next, std::min(1., path.t()));
  }



  DEBOND_INSTANTIATE(first_bond_change);
} // namespace Debond
