// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_verification_h
#define debond_output_verification_h

#include <deal.II/base/tensor.h>
#include <deal.II/lac/vector.h>

#include <debond/contact/adhesion_integral.h>
#include <debond/elasticity/elastic_problem.h>

#include <array>
#include <string>
#include <vector>

namespace Debond
{
  /// What the bonds and the foundation do at a contact node.
  enum class BondState
  {
    contact, ///< u_nu = 0
    bonded,  ///< -M < u_nu < 0
    kink,    ///< u_nu = -M
    broken,  ///< u_nu < -M
    free     ///< u_nu < 0, if the law has no adhesion
  };

  /// All of them, in the order of their numbers in files.
  constexpr std::array<BondState, 5> bond_states = {{BondState::contact,
                                                     BondState::bonded,
                                                     BondState::kink,
                                                     BondState::broken,
                                                     BondState::free}};

  std::string
  to_string(const BondState state);



  /// The contact law checked at one contact node.
  struct ContactNodeState
  {
    double u_nu; ///< normal displacement, length

    /// Total force of the foundation on the node along -nu, from A u - f:
    /// positive where the foundation pushes, negative where bonds pull.
    double normal_force;

    /// What the law allows for u_nu of all nodes: the Clarke interval of the
    /// adhesion, and unbounded above (infinity) where u_nu = 0.
    Interval allowed_force;

    /// Distance to the law's graph, see Verification::law_violation.
    double violation;

    BondState state;
  };



  /// A solution checked against the problem from A u - f alone.
  template <int dim>
  struct Verification
  {
    /// In the order of ContactBoundary::nodes.
    std::vector<ContactNodeState> nodes;

    /**
     * Largest distance to the contact law over all contact nodes: the least
     * delta for which the node's force is within delta F_i of what the law
     * allows at displacements within delta M of u_nu. Here F_i = a M times
     * the measure of the node. Without adhesion M is the largest |u_nu| and
     * a M the largest force on a node (of a support or the foundation) over
     * the largest measure.
     */
    double law_violation;

    /// The part of the law violation that matters for the body: the violation
    /// times min(1, a M measure / largest reaction), with the largest measure
    /// of a node. Very weak bonds violate their law by rounding alone.
    double contact_residual;

    /// Largest u_nu > 0 (zero if there is none), in length.
    double penetration;

    /// Largest |A u - f| over the free degrees of freedom that are not normal
    /// contact displacements, relative to the largest |A u - f| of all.
    double equilibrium_residual;

    dealii::Tensor<1, dim> applied_force;
    dealii::Tensor<1, dim> clamped_reaction;

    /// Of the foundation on the body, with the tangential part.
    dealii::Tensor<1, dim> contact_reaction;

    /// | applied + clamped + contact | over the sum of all nodal forces' sizes.
    double force_imbalance;

    /// The largest of equilibrium_residual, force_imbalance and
    /// contact_residual: how far the result is from a solution, relative to the
    /// forces.
    double
    error() const;

    unsigned int
    count(const BondState state) const;
  };

  /// @p load_factor: the multiple of the problem's loads that @p u belongs to.
  ///
  /// @p tolerance: displacements within tolerance * M (and tolerance times the
  /// largest |u_nu|) of 0 and -M count as
  /// contact and kink for ContactNodeState::state (and for nothing else). So
  /// does a gap under pressure within the node's violation and 1e-3 M.
  template <int dim>
  Verification<dim>
  verify(const ElasticProblem<dim>    &problem,
         const AdhesionIntegral<dim>  &adhesion,
         const AdhesiveLaw            &law,
         const dealii::Vector<double> &u,
         const double                  load_factor = 1.,
         const double                  tolerance   = 1e-6);
} // namespace Debond

#endif
