// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_adhesion_integral_h
#define debond_contact_adhesion_integral_h

#include <debond/base/tolerances.h>
#include <debond/contact/contact_points.h>
#include <debond/contact/law.h>
#include <debond/optimization/piecewise_quadratic.h>

namespace Debond
{
  /// What a contact boundary remembers.
  struct BondMemory
  {
    /// Of bonds that do not return, for each of ContactPoints::list(), the
    /// least scaled displacement that they have been at: what is above it does
    /// not come back. Empty, as the next lists are, if bonds return.
    std::vector<double> reached = {};

    /// Where what they take depends on the mode, the part of shear that they
    /// have had it with, that of the next step, and the energy that they have
    /// taken.
    std::vector<double> mode = {}, mixity = {}, taken = {};

    /// By how much the energies that bonds have taken would differ with the
    /// modes at the ends of the steps, of those that bore nothing with those
    /// at which they began to.
    double lag = 0.;

    /// Of friction, for each unknown, where it was at the beginning of the step
    /// and the weight of its kink in it, and the energy that friction had taken
    /// until then. Empty before the first step.
    std::vector<double> slipped = {}, pressed = {};
    double              rubbed = 0.;

    /// Where bonds that hold do not rub, for each unknown the damage at the
    /// beginning of the step.
    std::vector<double> loose = {};

    bool
    empty() const
    {
      return reached.empty() && slipped.empty();
    }
  };



  /// Friction along unknowns of the contact boundary: with the force `bound`
  /// (Tresca) and with `coefficient` times what presses (Coulomb), both 0 along
  /// normals.
  struct Friction
  {
    Eigen::VectorXd bound       = {};
    Eigen::VectorXd coefficient = {};
    /// Whose force presses; none for those of vertices that supports hold.
    std::vector<unsigned int> node = {};

    /// Of both tangents at a vertex of a solid the other one, see Kinks.
    std::vector<Eigen::Index> partner = {};

    /// The vertices without friction, although it belongs there, since supports
    /// move them along the boundary.
    unsigned int n_moved = 0;

    /// It is multiplied by the damage that bonds had before the step.
    bool is_of_damage = false;

    bool
    empty() const
    {
      return bound.size() == 0;
    }

    bool
    depends_on_pressure() const
    {
      return coefficient.size() > 0 && coefficient.maxCoeff() > 0.;
    }
  };



  /**
   * Phi(s) = int_{Gamma_C} j_1(s) dGamma, the energy of the bonds: a sum of the
   * law over the ContactPoints, whose order s has. Where bonds shear it is a
   * function of s and of the displacements t along the boundary after it, and
   * the law is that of the opening l = sqrt(p^2 + r |t|^2), p = -s and r the
   * ratio of the stiffnesses in shear and along the normal: j_1(-l). Such an
   * effective opening is that of Camacho and Ortiz (Int. J. Solids Struct. 33,
   * 1996).
   *
   * Friction is a part of it, as one with a given bound: the work of the bound
   * along the way t - t_0 from where the last step has ended. With Coulomb's
   * law the bound is that of the pressures last given.
   *
   * Keeps references to its arguments.
   */
  template <int dim>
  class AdhesionIntegral : public PiecewiseQuadratic
  {
  public:
    using Face        = typename ContactPoints<dim>::Face;
    using Barycentric = typename ContactPoints<dim>::Barycentric;

    /// See ContactPoints.
    AdhesionIntegral(const ContactBoundary<dim>   &contact_boundary,
                     const AdhesiveLaw            &adhesive_law,
                     const ContactQuadrature<dim> &quadrature_rule,
                     const BondField<dim>         *bond_field = nullptr);

    /// The number of nodes, whose s are the first unknowns.
    unsigned int
    n_nodes() const
    {
      return static_cast<unsigned int>(contact_boundary().nodes.size());
    }

    unsigned int
    n_unknowns() const
    {
      return contact_boundary().n_unknowns();
    }

    const ContactBoundary<dim> &
    contact_boundary() const
    {
      return contact_points.boundary();
    }

    const AdhesiveLaw &
    adhesive_law() const
    {
      return law;
    }

    const ContactPoints<dim> &
    points() const
    {
      return contact_points;
    }

    /// These bonds where the prescribed displacements are @p factor times those
    /// for the whole load.
    AdhesionIntegral
    at(const double factor) const;

    /// From now on bonds do not return to pieces of the law that they have left
    /// at @p s or before.
    void
    break_for_good(const VectorView &s);

    void
    set_friction(const Friction &friction);

    const Friction &
    friction() const
    {
      return rubs;
    }

    /// A step of a path begins at @p s, to which friction has taken the work of
    /// the way. A given bound is that of the damage until then. Where friction
    /// depends on the pressure, what has stuck before sticks.
    void
    slide_to(const VectorView &s);

    /// From now on friction is that of these normal @p forces of all nodes,
    /// positive ones press. Returns by how much its largest forces change.
    double
    press(const VectorView &forces);

    /// From now on these unknowns do not slide where friction depends on the
    /// pressure, and others have what does not depend on it.
    void
    stick(const std::vector<bool> &sticks);

    const Kinks &
    kinks() const override
    {
      return friction_kinks;
    }

    const BondMemory &
    memory() const
    {
      return broken;
    }

    /// The memory() of these bonds at an earlier time.
    void
    set_memory(const BondMemory &memory);

    /// Gives bonds whose fracture energy depends on the mode that of the mode
    /// they remember, with which they have a potential.
    void
    freeze_mode();

    /// From now on bonds that bore nothing at @p last_s, the state before with
    /// its bonds @p last, and that are damaged on the straight way to @p s, or
    /// would be with the energy of their mode, remember the mode at which that
    /// begins. Returns the part of what all bonds take on the way that would
    /// differ with the energies of these modes. Adds to BondMemory::lag.
    double
    adapt_mode(const AdhesionIntegral &last,
               const VectorView       &last_s,
               const VectorView       &s);

    /// The memory of the bonds of a node; where points are not nodes the
    /// largest of the points around it.
    double
    reached(const unsigned int node) const
    {
      return broken.reached.empty() ? 0. : reached_of_nodes[node];
    }

    /// Returns the least s that the bonds at a vertex of a face have reached;
    /// the vertex may be held.
    double
    reached_at(const Face &face, const unsigned int vertex) const;

    /// The memory of the point of the rule next to a place on a face.
    double
    reached_at(const Face &face, const Barycentric &place) const
    {
      return broken.reached.empty() ?
               0. :
               broken.reached[contact_points.nearest(face, place)];
    }

    /// The piece of the law that the bonds of a node have not left for good.
    unsigned int
    least_piece(const unsigned int node) const
    {
      return contact_points.bonds_at(node).law->pieces().index(reached(node));
    }

    /// Calls @p visit(point, scaled, reached) for all points: sums over them
    /// are made of it.
    template <typename Visit>
    void
    for_each_point(const VectorView &s, const Visit &visit) const
    {
      for (unsigned int q = 0; q < contact_points.list().size(); ++q)
        {
          const ContactPoint<dim> &point = contact_points.list()[q];
          visit(point,
                point.scaled_displacement(s),
                broken.reached.empty() ? 0. : broken.reached[q]);
        }
    }

    /// The second derivative of Phi at @p s if that of the law is @p of_law
    /// (law, scaled, reached), and where bonds shear @p across (law, scaled,
    /// reached) in directions in which they open no further: a matrix that
    /// couples the nodes of a face, and for nodal quadrature no nodes.
    template <typename Curvature, typename Across>
    Eigen::SparseMatrix<double>
    matrix(const VectorView &s,
           const Curvature  &of_law,
           const Across     &across) const
    {
      std::vector<Eigen::Triplet<double>> entries;
      for_each_point(s, [&](const auto &point, double scaled, double reached) {
        const double curvature = point.force_factor() / point.bonds.length *
                                 of_law(*point.bonds.law, scaled, reached);
        if (point.shears())
          {
            add_in_all_directions(point,
                                  point.jump(s),
                                  curvature,
                                  point.force_factor() / point.bonds.length *
                                    across(*point.bonds.law, scaled, reached),
                                  entries);
            return;
          }
        if (curvature != 0.)
          for (unsigned int k = 0; k < point.n_nodes; ++k)
            for (unsigned int l = 0; l < point.n_nodes; ++l)
              entries.emplace_back(point.index[k],
                                   point.index[l],
                                   curvature * point.shape[k] * point.shape[l]);
      });
      Eigen::SparseMatrix<double> result(s.size(), s.size());
      result.setFromTriplets(entries.begin(), entries.end());
      return result;
    }

    /// Phi(s), an energy.
    double
    value(const VectorView &s) const
    {
      return energy_of_bonds(s) + friction_kinks.value(s);
    }

    /// The energy that bonds which do not return, and friction, have taken for
    /// good.
    double
    dissipated_energy() const;

    /// Phi(0) without friction, which is zero if nothing is prescribed and
    /// bonds return.
    double
    value_at_zero() const
    {
      return phi_at_zero;
    }

    double
    change(const VectorView &s) const override
    {
      return energy_of_bonds(s) - phi_at_zero + friction_kinks.value(s);
    }

    /// One element of the Clarke subdifferential of Phi at s (at a kink the
    /// derivative of the piece on the side of 0), a force for each node.
    Eigen::VectorXd
    subgradient(const VectorView &s) const override;

    Eigen::SparseMatrix<double>
    curvature(const VectorView &s) const override;

    Eigen::SparseMatrix<double>
    second_derivative(const VectorView &s) const override;

    bool
    softens() const override
    {
      return law.softens();
    }

    /// Returns whether bonds bear shear, or could.
    bool
    shears() const
    {
      return n_unknowns() > n_nodes() ||
             std::any_of(contact_points.list().begin(),
                         contact_points.list().end(),
                         [](const auto &point) { return point.shears(); });
    }

    /// Prescribed displacements stay as they are on the way.
    double
    first_change(const VectorView &s,
                 const VectorView &ds,
                 const double      limit) const override;

    /// For each unknown the forces that the law allows: the quadrature of the
    /// Goldstein intervals of j_1 over s +- delta. With delta = 0 this is
    /// the Clarke interval of Phi.
    std::vector<Interval>
    force_intervals(const VectorView &s, const double delta) const
    {
      return force_intervals(s, std::vector<double>(n_unknowns(), delta));
    }

    /// Returns these intervals with a radius of its own for each unknown,
    /// delta[i] for the force along it.
    std::vector<Interval>
    force_intervals(const VectorView          &s,
                    const std::vector<double> &delta) const;

  private:
    /// Phi(s) but for the friction of this step.
    double
    energy_of_bonds(const VectorView &s) const;

    /// memory() with the lists of modes.
    BondMemory
    memory_with_modes() const;

    /// Returns whether bonds at @p scaled bear enough to have a mode.
    bool
    bears(const double scaled) const
    {
      return scaled < Tolerance::bears_nothing * law.pieces()[0].lower;
    }

    /// Adds the second derivative of a function of the opening of @p point at
    /// a @p jump: @p along the jump and @p across it, in the product of jumps.
    static void
    add_in_all_directions(const ContactPoint<dim>             &point,
                          const Jump<dim>                     &jump,
                          const double                         along,
                          const double                         across,
                          std::vector<Eigen::Triplet<double>> &entries);

    /// The weights of the kinks in this step, which bonds that held when it
    /// began may lessen.
    void
    set_weights(Eigen::VectorXd weights);

    /// Adapts what follows from the points and their memory.
    void
    update();

    /// The sum of the law at 0, with the energy that bonds have now.
    double
    energy_at_rest() const;

    ContactPoints<dim>  contact_points;
    const AdhesiveLaw  &law;
    BondMemory          broken;
    Friction            rubs;
    Kinks               friction_kinks;   ///< empty without friction
    std::vector<double> reached_of_nodes; ///< empty as broken.reached is
    double              phi_at_zero = 0.; ///< value_at_zero()
  };
} // namespace Debond

#endif
