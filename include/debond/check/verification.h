// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_verification_h
#define debond_check_verification_h

#include <debond/check/bond_state.h>
#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>

namespace Debond
{
  /// The contact law checked at one contact node.
  struct ContactNodeState
  {
    double u_nu; ///< normal displacement, length

    /// u_nu minus the gap of the body at rest: minus the opening between body
    /// and foundation.
    double s;

    /// How far its bonds are opened: -s, and the displacement along the
    /// boundary with it if they shear and break in all directions at once.
    double opening;

    /// Total force of the foundation on the node along -nu, from A u - f:
    /// positive where the foundation pushes, negative where bonds pull.
    double normal_force;

    /// The traction at the node itself, of the same sign: by the law at the
    /// opening there. Where the law leaves it open, at contact and kinks, it
    /// is normal_force over the node's measure.
    double normal_traction = 0.;

    /// The forces that the law allows for s of all nodes: the Clarke interval
    /// of the adhesion, and unbounded above (infinity) where s = 0.
    Interval allowed_force;

    /// Distance to the law's graph, see Verification::law_violation.
    double violation;

    /// The stiffness of the bond at 0, without what it has left for good, and
    /// the displacement below which it is on its last branch, positive.
    double bond_stiffness;
    double bond_threshold;

    /// The part of its stiffness that the bond has lost, 0 to 1, and if bonds
    /// break separately that in shear.
    double damage;
    double shear_damage = 0.;

    /// The part of shear in what the bond has stored, if bonds shear.
    std::optional<double> mode_mixity = {};

    /// Whether it has moved along the boundary in this step, if there is
    /// friction.
    std::optional<bool> slides = {};

    BondState state;

    /// The state by the branch of the law that holds, whatever contact and kink
    /// (at a kink: the branch on the side of 0).
    BondState branch;
  };



  /// When the bonds of a node broke on a load path; no numbers if they hold.
  struct BondBreak
  {
    std::optional<double> factor; ///< of the first step after which they do not
    std::optional<double> mode;   ///< ContactNodeState::mode_mixity there
  };



  /// A solution checked against the problem from A u - f alone.
  template <int dim>
  struct Verification
  {
    /// The states in the order of ContactBoundary::nodes.
    std::vector<ContactNodeState> nodes;

    /// Of each node, of a state of a load path; verify() leaves it empty.
    std::vector<BondBreak> breaks;

    /// That of the prescribed displacements.
    double displacement_factor = 1.;

    std::vector<std::string> state_names; ///< see state_names()

    /**
     * Largest distance to the contact law over all contact nodes: the least
     * delta for which the node's force is within delta F_i of what the law
     * allows at displacements within delta L_i of s. Of bonds that shear the
     * same is asked of each component of the force.
     *
     * F_i is what a bond of the node can bear, a M (the largest of all
     * branches) times the node's measure, but not more than the largest contact
     * force on a node, so that a law with M far above all displacements is
     * checked as well; forces below a thousandth of the largest reaction do not
     * count as the largest one. L_i is the displacement at which bonds pull
     * with F_i, F_i / (a measure) <= M, M being the first one at which they
     * change their branch, but not more than the largest displacement of the
     * body. Without adhesion F_i is the largest contact force and L_i the
     * largest displacement.
     *
     * What bonds bear can be less than the rounding of A u - f, for which no
     * displacement in double precision is to blame. So F_i is at least 1e4
     * times ElasticFields::residual_rounding(): bonds weaker than that are
     * not resolved, and rounding alone is a violation of 1e-4. The same holds
     * of what rounding of w = u - gap makes, as long as that is below 1e-7 of
     * the largest force, or all that there is; and, where a change of
     * temperature is a load, of forces below 1e-7 of the largest nodal load.
     */
    double law_violation;

    /// The largest distance to the foundation, broken_zone() and
    /// zone_without_bonds().
    double largest_opening;
    double broken_zone;
    double without_bonds;

    /// Largest s > 0 (zero if there is none), in length.
    double penetration;

    /// Largest |A u - f| over the free degrees of freedom that are not normal
    /// contact displacements, relative to the largest |A u - f| of all, but not
    /// to less than 1e4 times its rounding: a body that is moved without any
    /// force has nothing else.
    double equilibrium_residual;

    dealii::Tensor<1, dim> applied_force;
    dealii::Tensor<1, dim> clamped_reaction; ///< of all supports

    /// The force of each of ElasticUnknowns::support_names() on the body.
    std::map<std::string, dealii::Tensor<1, dim>> reactions;

    /// The force of the foundation on the body, with the tangential part; of
    /// bodies that are glued to each other that on those on the high sides.
    dealii::Tensor<1, dim> contact_reaction;

    /// The tangential part of contact_reaction, zero if tangential
    /// displacements are free.
    dealii::Tensor<1, dim> tangential_reaction;

    /// The displacement of each contact node (of an edge its coefficient) and
    /// the tangential force of the foundation on the body there, in Cartesian
    /// components.
    std::vector<dealii::Tensor<1, dim>> displacements, tangential_forces;

    /// The displacements along the boundary that stretch bonds; none if bonds
    /// do not shear and there is no friction.
    std::vector<dealii::Tensor<1, dim>> slips;

    /// What bonds that shear exert along the boundary on the body at the nodes
    /// themselves, by the law at the slip there: forces per area. With friction
    /// that and bonds together, from A u - f.
    std::vector<dealii::Tensor<1, dim>> shear_tractions;

    /// | applied + clamped + contact | over the sum of all nodal forces' sizes,
    /// or that many times the rounding of one.
    double force_imbalance;

    /// The most that rounding of the displacements makes of A u - f, relative
    /// to the largest nodal force, applied or of the supports and the
    /// foundation; zero without loads.
    double force_rounding;

    /// The largest of equilibrium_residual, force_imbalance and
    /// law_violation: how far the result is from a solution. Infinite where
    /// force_rounding is above 0.1: there are no forces to verify then.
    double
    error() const;

    /// A message for a result whose error() is above the tolerance. @p
    /// is_iterative: a smaller tolerance takes the method further.
    std::string
    failure(const double tolerance, const bool is_iterative = false) const;

    unsigned int
    count(const BondState state) const;

    /// Whether the scene has it, although nothing may be pressed.
    bool has_friction = false;

    const std::string &
    name(const BondState state) const;
  };

  /// Verifies @p u, which belongs to @p factors of the problem's loads and to
  /// bonds that are as @p adhesion has them.
  ///
  /// @p tolerance: displacements within tolerance * M (and tolerance times the
  /// largest |s|, also that which bonds remember) of 0 and the kinks count
  /// as contact and kink for ContactNodeState::state (and for nothing else). So
  /// does a gap under pressure within the node's violation and 1e-3 L_i.
  ///
  /// @p least_force: that which is resolved wherever it acts, see
  /// Scene::least_force().
  ///
  /// All ranks that share the problem have to call it; all have the result.
  template <int dim>
  Verification<dim>
  verify(const ElasticProblem<dim>   &problem,
         const AdhesionIntegral<dim> &adhesion,
         const DofVector             &u,
         const LoadFactors            factors     = 1.,
         const double                 least_force = 0.,
         const double                 tolerance   = Tolerance::contact_law);
} // namespace Debond

#endif
