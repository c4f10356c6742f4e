// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/contact/adhesion_integral.h>

#include <numeric>

namespace Debond
{
  template <int dim>
  AdhesionIntegral<dim>::AdhesionIntegral(
    const ContactBoundary<dim>   &contact_boundary,
    const AdhesiveLaw            &adhesive_law,
    const ContactQuadrature<dim> &quadrature_rule,
    const BondField<dim>         *bond_field)
    : contact_points(contact_boundary,
                     adhesive_law,
                     quadrature_rule,
                     bond_field)
    , law(adhesive_law)
  {
    update();
  }



  template <int dim>
  AdhesionIntegral<dim>
  AdhesionIntegral<dim>::at(const double factor) const
  {
    // Only the offsets of the points depend on the factor. The memory stays, as
    // the points are the same at each factor.
    AdhesionIntegral result(*this);
    result.contact_points.set_factor(factor);
    result.update();
    return result;
  }



  namespace
  {
    /// How far a point at @p jump is from the end of its piece along @p way, a
    /// jump for each unit of it: infinite if it does not come there.
    template <int dim>
    double
    way_to_end(const ContactPoint<dim> &point,
               const Jump<dim>         &jump,
               const double             scaled,
               const double             reached,
               const Jump<dim>         &way)
    {
      // Points without bonds have no kink.
      if (point.bonds.energy == 0.)
        return infinity;
      const PiecewiseEnergy::Piece piece =
        point.bonds.law->pieces().piece_at(scaled, reached);
      if (!point.shears())
        return piece.way_to_end(scaled, way.normal / point.bonds.length);
      // After the part x of the way the square of the opening is A x^2 + 2 B x
      // + C. The end of a piece, at an opening L, is where this is L^2.
      const double shear = point.bonds.shear;
      const double A     = way.product(way, shear);
      const double B     = way.product(jump, shear);
      const double C     = jump.product(jump, shear);
      double       first = infinity;
      // The lower end, farther from rest, is come to sooner or later; the upper
      // one only if jumps shrink at first (B < 0) and the least opening on the
      // line is below it. Of both forms of a root the one without a difference
      // of nearly equal numbers is taken.
      const auto square_at = [&](const double end) {
        return end * end * point.bonds.length * point.bonds.length;
      };
      if (std::isfinite(piece.lower) && A > 0.)
        {
          const double rest = std::max(0., square_at(piece.lower) - C);
          const double root = std::sqrt(B * B + A * rest);
          first             = B > 0. ? rest / (B + root) : (root - B) / A;
        }
      if (piece.upper < 0. && B < 0.)
        {
          const double rest = std::max(0., C - square_at(piece.upper));
          if (B * B >= A * rest)
            first = std::min(first, rest / (std::sqrt(B * B - A * rest) - B));
        }
      return first;
    }



    /// The energy that @p bonds of a point take for good from one memory to the
    /// next.
    template <int dim>
    double
    taken_between(const ContactPoint<dim> &point,
                  const BondScale         &bonds,
                  const double             reached,
                  const double             now)
    {
      return point.weight * bonds.energy *
             (bonds.law->value(0., now) - bonds.law->value(0., reached));
    }
  } // namespace



  template <int dim>
  BondMemory
  AdhesionIntegral<dim>::memory_with_modes() const
  {
    BondMemory        memory = broken;
    const std::size_t n      = contact_points.list().size();
    if (memory.taken.empty())
      {
        // Bonds that have never been stretched: all of their energy, in
        // opening.
        memory.reached.assign(n, 0.);
        memory.mode.assign(n, 0.);
        memory.mixity.assign(n, 0.);
        memory.taken.assign(n, 0.);
      }
    return memory;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::break_for_good(const VectorView &s)
  {
    // The memory of a point is the least displacement that it has ever had, so
    // it only falls, and a second call with the same s changes nothing. Where
    // there is no memory yet, reached is 0, which none at s <= 0 exceeds.
    const bool has_mode = contact_points.depends_on_mode();
    BondMemory memory   = has_mode ? memory_with_modes() : broken;
    memory.reached.clear();
    for_each_point(s, [&](const auto &point, double scaled, double reached) {
      const std::size_t q   = memory.reached.size();
      const double      now = std::min(reached, scaled);
      memory.reached.push_back(now);
      if (!has_mode)
        return;
      // What the bonds take in this step they take with the energy that they
      // have in it.
      memory.taken[q] += taken_between(point, point.bonds, reached, now);
      // The mode of the next step, unless that shows another one. Bonds that
      // bear nothing yet have none: it would be that of rounding.
      if (bears(scaled))
        memory.mixity[q] = point.jump(s).part_of_shear(point.bonds.shear);
    });
    set_memory(memory);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::adapt_mode(const AdhesionIntegral &last,
                                    const VectorView       &last_s,
                                    const VectorView       &s)
  {
    // An energy G(m) that depends on the part of shear m has a potential only
    // if m is fixed, so that each step of a load path has one m at each point,
    // that of the state before. Bonds that bore nothing then have no mode but
    // rounding; they get the m with which the straight way of their jump in
    // this step first comes to the end of the first piece, and the step is done
    // again if that matters.
    if (!contact_points.depends_on_mode())
      return 0.;
    BondMemory  memory     = memory_with_modes();
    const auto *last_point = last.points().list().data();
    double      lag = 0., without_mode = 0., all = 0.;
    for_each_point(s, [&](const auto &point, double scaled, double reached) {
      // Both lists have the same points in the same order.
      const std::size_t q     = last_point - last.points().list().data();
      const Jump<dim>   start = last_point++->jump(last_s);
      // What has a mode keeps it in this step. What has none has that of the
      // place on the straight way to here at which it begins to be damaged.
      const bool has_mode =
        memory.taken[q] > 0. || bears(point.scaled_displacement(start));
      const Jump<dim> way = point.jump(s).moved(start, -1.);
      const double    part =
        has_mode ? 1. :
                      std::min(1.,
                            way_to_end(point,
                                       start,
                                       point.scaled_displacement(start),
                                       reached,
                                       way));
      const double mixity =
        start.moved(way, part).part_of_shear(point.bonds.shear);
      if (point.bonds.energy == 0. || std::isnan(mixity))
        return;
      // What they take with the mode that they have, and with the other one,
      // with which the same jump is another multiple of their length.
      const BondScale after = contact_points.at_mode(q, mixity);
      const double    there = scaled * point.bonds.length / after.length;
      const double    reached_there =
        after.law->reached_as(*point.bonds.law, reached);
      const double taken =
        taken_between(point, point.bonds, reached, std::min(reached, scaled));
      const double other = taken_between(point,
                                         after,
                                         reached_there,
                                         std::min(reached_there, there));
      // What bonds take on the way, and by how much that depends on the mode
      // that they are given.
      all += std::max(taken, other);
      lag += std::abs(other - taken);
      if (has_mode || std::max(taken, other) == 0.)
        return;
      without_mode += std::abs(other - taken);
      memory.mixity[q] = mixity;
    });
    memory.lag = last.broken.lag + lag;
    set_memory(memory);
    return all > 0. ? without_mode / all : 0.;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::freeze_mode()
  {
    // From here to the next call the law of each point is that of the mode it
    // remembers, at the same stiffness: a potential, which the methods need.
    // Damage stays what it is.
    if (!contact_points.depends_on_mode() || broken.mixity.empty())
      return;
    BondMemory memory = broken;
    for (std::size_t q = 0; q < memory.mixity.size(); ++q)
      if (const BondScale &now = contact_points.list()[q].bonds;
          now.energy > 0. && memory.mode[q] != memory.mixity[q])
        {
          memory.mode[q]    = memory.mixity[q];
          memory.reached[q] = contact_points.at_mode(q, memory.mode[q])
                                .law->reached_as(*now.law, memory.reached[q]);
        }
    set_memory(memory);
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::set_friction(const Friction &friction)
  {
    rubs           = friction;
    friction_kinks = {rubs.bound,
                      Eigen::VectorXd::Zero(rubs.bound.size()),
                      rubs.partner};
    update();
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::slide_to(const VectorView &s)
  {
    if (rubs.empty())
      return;
    BondMemory memory = broken;
    memory.rubbed += friction_kinks.value(s);
    memory.slipped.assign(s.data(), s.data() + s.size());
    // Where friction depends on the pressure that of the last step is the first
    // guess for what slides. What sticks may need more than that as loads grow,
    // and would be taken for what slides.
    Eigen::VectorXd weight =
      rubs.depends_on_pressure() ? friction_kinks.weight : rubs.bound;
    for (Eigen::Index i = 0; i < weight.size(); ++i)
      if (rubs.coefficient(i) > 0. && friction_kinks.has(i) &&
          friction_kinks.way(i, s) == 0.)
        weight(i) = std::numeric_limits<double>::max();
    memory.pressed.assign(weight.data(), weight.data() + weight.size());
    // Bonds that hold do not rub: with the damage d of a bond, d of the
    // boundary around it is loose (Alfano and Sacco, Int. J. Numer. Meth. Engng
    // 68, 2006). The damage is that before the step.
    if (rubs.is_of_damage)
      {
        memory.loose.assign(n_unknowns(), 1.);
        for (unsigned int i = 0; i < n_unknowns(); ++i)
          if (const unsigned int node = rubs.node[i];
              node != dealii::numbers::invalid_unsigned_int)
            if (const BondScale bonds = contact_points.bonds_at(node);
                bonds.energy > 0.)
              memory.loose[i] = bonds.law->damage(reached(node));
      }
    set_memory(memory);
    if (!rubs.depends_on_pressure())
      set_weights(rubs.bound);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::press(const VectorView &forces)
  {
    Eigen::VectorXd weight = rubs.bound;
    for (Eigen::Index i = 0; i < weight.size(); ++i)
      if (rubs.coefficient(i) > 0.)
        weight(i) += rubs.coefficient(i) * std::max(0., forces(rubs.node[i]));
    const Eigen::VectorXd before = friction_kinks.weight;
    set_weights(weight);
    return (friction_kinks.weight - before).template lpNorm<Eigen::Infinity>();
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::stick(const std::vector<bool> &sticks)
  {
    Eigen::VectorXd weights = rubs.bound;
    for (Eigen::Index i = 0; i < weights.size(); ++i)
      if (rubs.coefficient(i) > 0. && sticks[i])
        weights(i) = std::numeric_limits<double>::max();
    set_weights(weights);
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::set_weights(Eigen::VectorXd weights)
  {
    for (std::size_t i = 0; i < broken.loose.size(); ++i)
      weights(i) *= broken.loose[i];
    BondMemory memory = broken;
    memory.pressed.assign(weights.data(), weights.data() + weights.size());
    set_memory(memory);
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::set_memory(const BondMemory &memory)
  {
    // The sums at s = 0 contain what bonds have dissipated, so they follow the
    // memory.
    broken = memory;
    contact_points.set_modes(broken.mode);
    const auto vector = [](const std::vector<double> &list) {
      return Eigen::Map<const Eigen::VectorXd>(list.data(),
                                               Eigen::Index(list.size()));
    };
    if (!broken.slipped.empty())
      friction_kinks = {vector(broken.pressed),
                        vector(broken.slipped),
                        rubs.partner};
    update();
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::update()
  {
    // The energy of bonds at s = 0 is not zero in two cases only. A vertex with
    // a prescribed displacement stretches the bonds beside it whatever s is,
    // and bonds with a memory have dissipated energy. Otherwise there is
    // nothing to be summed up, nor are there memories to be gathered.
    phi_at_zero = 0.;
    if (contact_boundary().held_vertices.empty() && broken.empty())
      return;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n_unknowns());
    phi_at_zero                = energy_of_bonds(zero);
    if (broken.reached.empty())
      return;
    // The largest memory that a node has by the points of the faces around it:
    // a node counts as broken where all of them say so that have bonds.
    constexpr double none = -std::numeric_limits<double>::max();
    Barycentric      middle;
    middle.fill(1. / dim);
    reached_of_nodes.assign(n_nodes(), none);
    for (const Face &face : contact_boundary().faces)
      {
        if (contact_points.list()[contact_points.nearest(face, middle)]
              .bonds.energy == 0.)
          continue;
        const auto memory = contact_points.coefficients(face, broken.reached);
        for (unsigned int k = 0; k < contact_boundary().n_face_nodes(); ++k)
          if (!face.is_held(k))
            {
              // Polynomials through the values at the points may be positive at
              // a vertex, which is no memory.
              double &reached = reached_of_nodes[face.node(k)];
              reached         = std::max(reached, std::min(memory[k], 0.));
            }
      }
    std::replace(reached_of_nodes.begin(), reached_of_nodes.end(), none, 0.);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::reached_at(const Face        &face,
                                    const unsigned int vertex) const
  {
    if (broken.reached.empty())
      return 0.;
    if (!face.is_held(vertex))
      return reached(face.nodes[vertex]);
    return std::min(contact_points.coefficients(face, broken.reached)[vertex],
                    0.);
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::energy_of_bonds(const VectorView &s) const
  {
    // This is the quadrature of the last term of J. Bonds that vary have the
    // energy times j_1(s / length).
    double sum = 0.;
    for_each_point(s, [&](const auto &point, double scaled, double reached) {
      sum += point.weight * point.bonds.energy *
             point.bonds.law->value(scaled, reached);
    });
    // What they have taken was with other energies than they have now.
    if (!broken.taken.empty())
      sum += std::accumulate(broken.taken.begin(), broken.taken.end(), 0.) -
             energy_at_rest();
    return sum + broken.rubbed;
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::dissipated_energy() const
  {
    return broken.rubbed +
           (broken.taken.empty() ?
              energy_at_rest() :
              std::accumulate(broken.taken.begin(), broken.taken.end(), 0.));
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::energy_at_rest() const
  {
    // The value of the law at 0 is what does not come back when bonds are
    // released: the constant j_1(p_m) - p_m tau(p_m) / 2 of the secant
    // parabola. The displacement is not used, so that the sum depends neither
    // on s nor on what is prescribed.
    double sum = 0.;
    for_each_point(Eigen::VectorXd::Zero(n_unknowns()),
                   [&](const auto &point, double, double reached) {
                     sum += point.weight * point.bonds.energy *
                            point.bonds.law->value(0., reached);
                   });
    return sum;
  }



  template <int dim>
  Eigen::VectorXd
  AdhesionIntegral<dim>::subgradient(const VectorView &s) const
  {
    // By the chain rule the derivative of j_1(s / length) has the factor 1 /
    // length, which is part of force_factor(). At a kink (9) allows an interval
    // of tractions; the bundle methods ask for one element only, and the law
    // takes the one on the side of 0.
    Eigen::VectorXd xi = Eigen::VectorXd::Zero(s.size());
    for_each_point(s, [&](const auto &point, double scaled, double reached) {
      if (point.shears())
        {
          // In the product of jumps dj_1(-l)/dl = tau, so that the derivative
          // along an unknown is tau/l times the product of the jump with what
          // the unknown makes of it.
          const double stiffness = point.force_factor() / point.bonds.length *
                                   point.bonds.law->secant(scaled, reached);
          const Jump<dim> jump = point.jump(s);
          point.for_each_unknown([&](const unsigned int i, const auto &by) {
            xi(i) += stiffness * by.product(jump, point.bonds.shear);
          });
          return;
        }
      const double force =
        point.force_factor() * point.bonds.law->derivative(scaled, reached);
      for (unsigned int k = 0; k < point.n_nodes; ++k)
        xi(point.index[k]) += point.shape[k] * force;
    });
    return xi;
  }



  template <int dim>
  void
  AdhesionIntegral<dim>::add_in_all_directions(
    const ContactPoint<dim>             &point,
    const Jump<dim>                     &jump,
    const double                         along,
    const double                         across,
    std::vector<Eigen::Triplet<double>> &entries)
  {
    // In the product of jumps the second derivative of a function of l is
    //
    //     across <a, b> + (along - across) <a, jump> <b, jump> / l^2
    //
    // for directions a and b. At the jump zero both are the same, and there is
    // no second term.
    const double shear  = point.bonds.shear;
    const double square = jump.product(jump, shear);
    const double more   = square > 0. ? (along - across) / square : 0.;
    point.for_each_unknown([&](const unsigned int i, const auto &by_i) {
      const double along_i = more * by_i.product(jump, shear);
      point.for_each_unknown([&](const unsigned int j, const auto &by_j) {
        // Tangents of a node are orthogonal but for rounding, and a matrix of
        // bonds at nodes is to be diagonal.
        const double product = by_i.product(by_j, shear);
        const bool   is_zero =
          std::abs(product) <=
          8. * Tolerance::epsilon *
            std::sqrt(by_i.product(by_i, shear) * by_j.product(by_j, shear));
        const double entry = (is_zero ? 0. : across * product) +
                             along_i * by_j.product(jump, shear);
        if (entry != 0.)
          entries.emplace_back(i, j, entry);
      });
    });
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::curvature(const VectorView &s) const
  {
    // This is the E of the majorant 1/2 s'E s - b's of Phi: the law of each
    // point is replaced by the flattest quadratic that touches it at s and is
    // nowhere below it. It is never negative, so S + E stays definite if S is.
    // In directions across the jump the flattest one has the secant stiffness,
    // and a quadratic of one curvature k lies above j_1(-l) if k is at least
    // both: of all jumps of one length the least value is at that along the
    // jump, where it is the one of the law itself.
    const auto of_law =
      [](const AdhesiveLaw &law, const double scaled, const double reached) {
        return law.curvature(scaled, reached);
      };
    const auto of_all =
      [](const AdhesiveLaw &law, const double scaled, const double reached) {
        return std::max(law.curvature(scaled, reached),
                        law.secant(scaled, reached));
      };
    return shears() ? matrix(s, of_all, of_all) : matrix(s, of_law, of_law);
  }



  template <int dim>
  Eigen::SparseMatrix<double>
  AdhesionIntegral<dim>::second_derivative(const VectorView &s) const
  {
    // Where bonds soften this is less than curvature(), and S + Phi'' may be
    // indefinite. That is what the search along lines and the test for a local
    // minimum have to see. Along the jump it is the law's own second
    // derivative, across it tau/l.
    return matrix(
      s,
      [](const AdhesiveLaw &law, const double scaled, const double reached) {
        return law.second_derivative(scaled, reached);
      },
      [](const AdhesiveLaw &law, const double scaled, const double reached) {
        return law.secant(scaled, reached);
      });
  }



  template <int dim>
  double
  AdhesionIntegral<dim>::first_change(const VectorView &s,
                                      const VectorView &ds,
                                      const double      limit) const
  {
    // Stretches are affine in s, so each point moves on a straight way to the
    // end of its piece. Up to the first arrival Phi is one smooth function.
    // Offsets are part of the displacements for ds, but they do not move, so
    // that they are taken off again.
    double first = limit;
    for_each_point(s, [&](const auto &point, double scaled, double reached) {
      const Jump<dim> way = {point.normal_displacement(ds) - point.offset,
                             point.jump(ds).tangential - point.slip_offset};
      first =
        std::min(first, way_to_end(point, point.jump(s), scaled, reached, way));
    });
    return first;
  }



  namespace
  {
    /// Adds the forces that bonds in shear may have at jumps that are by no
    /// more than delta[i] from the given one, each along its own unknown i.
    template <int dim>
    void
    add_allowed(const ContactPoint<dim>   &point,
                const Jump<dim>           &jump,
                const double               scaled,
                const double               reached,
                const std::vector<double> &delta,
                std::vector<Interval>     &forces)
    {
      // The force along an unknown is that of the law times the cosine of the
      // angle to the jump, and both change with the jump. By delta[i] along
      // unknown i the opening changes by at most the radius, and the cosine of
      // the angle by at most delta L / l, L the length of the unknown in the
      // product of jumps; from a radius of l on the jump may have any
      // direction. The displacement is negative, as tractions are, so that the
      // product of a traction with this cosine is the force.
      const double shear = point.bonds.shear;
      point.for_each_unknown([&](const unsigned int i, const auto &by) {
        const double   size   = std::sqrt(by.product(by, shear));
        const double   radius = delta[i] * size / point.bonds.length;
        const Interval traction =
          point.bonds.law->goldstein_interval(scaled, radius, reached);
        const double cosine =
          scaled == 0. || size == 0. ?
            0. :
            by.product(jump, shear) / (size * scaled * point.bonds.length);
        const double spread = radius == 0.      ? 0. :
                              radius >= -scaled ? 2. :
                                                  radius / -scaled;
        // Tractions are not positive.
        const double low  = std::max(-1., cosine - spread);
        const double high = std::min(1., cosine + spread);
        forces[i].lower +=
          point.force_factor() * size *
          std::min(traction.lower * high, traction.upper * high);
        forces[i].upper += point.force_factor() * size *
                           std::max(traction.lower * low, traction.upper * low);
      });
    }
  } // namespace



  template <int dim>
  std::vector<Interval>
  AdhesionIntegral<dim>::force_intervals(const VectorView          &s,
                                         const std::vector<double> &delta) const
  {
    AssertDimension(delta.size(), n_unknowns());

    // This is the discrete form of (9). An equilibrium may use any traction
    // that the law allows, at each point independently of the others, so that
    // the interval of a node is the sum of theirs. Values of the shape
    // functions are not negative, which keeps lower ends below upper ends.
    std::vector<Interval> forces(n_unknowns(), Interval{0., 0.});
    for_each_point(s, [&](const auto &point, double scaled, double reached) {
      if (point.shears())
        {
          add_allowed(point, point.jump(s), scaled, reached, delta, forces);
          return;
        }
      for (unsigned int k = 0; k < point.n_nodes; ++k)
        {
          const unsigned int node = point.index[k];
          // Each node's radius is that of its own force: how far s may be wrong
          // differs from node to node.
          const Interval traction = point.bonds.law->goldstein_interval(
            scaled, delta[node] / point.bonds.length, reached);
          forces[node].lower +=
            point.force_factor() * point.shape[k] * traction.lower;
          forces[node].upper +=
            point.force_factor() * point.shape[k] * traction.upper;
        }
    });
    // Friction: any force up to the bound where nothing slides, else the bound
    // against the way.
    const Kinks &kinks = friction_kinks;
    for (Eigen::Index i = 0; i < kinks.weight.size(); ++i)
      if (kinks.has(i))
        {
          const double way = s(i) - kinks.place(i);
          // Of the plane of a pair, in which it is the cosine that counts.
          const double across =
            kinks.is_paired(i) ?
              s(kinks.partner[i]) - kinks.place(kinks.partner[i]) :
              0.;
          const auto cosine = [&](const double along, const double at_rest) {
            const double length = std::hypot(along, across);
            return length == 0. ? at_rest : along / length;
          };
          forces[i].lower += kinks.weight(i) * cosine(way - delta[i], -1.);
          forces[i].upper += kinks.weight(i) * cosine(way + delta[i], 1.);
        }
    return forces;
  }



  DEBOND_INSTANTIATE_CLASS(AdhesionIntegral);
} // namespace Debond
