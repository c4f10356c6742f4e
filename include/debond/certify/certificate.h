// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_certificate_h
#define debond_certify_certificate_h

#include <debond/certify/certificate_file.h>
#include <debond/solve/scene/scene.h>

namespace Debond
{
  /// The minimum that is to be certified.
  enum class CertificateKind
  {
    none,
    fixed_state,
    global
  };



  /// The minimum that an interval is for.
  enum class CertifiedMinimum
  {
    global,     ///< the least J
    fixed_state ///< the least J with the bonds of each side as they are
  };



  /// The length of the contact sides whose bonds are in a state, at least and
  /// at most, of all displacements with J at most the upper number.
  struct CertifiedLength
  {
    std::string state;
    double      least, largest;
  };



  /**
   * An interval for the minimum of the continuous problem, in the body of the
   * mesh: `upper` is J of the displacement, with j_1 integrated exactly,
   * `lower` comes from equilibrated stresses (doc/reference/certificate.md).
   */
  struct Certificate
  {
    CertifiedMinimum minimum = CertifiedMinimum::global;
    double           lower   = 0.;
    double           upper   = 0.;

    /// Or for loads that are linear on each side and constant in each element.
    bool loads_are_exact = true;

    unsigned int n_unknowns = 0; ///< of the equilibrated stresses
    unsigned int n_sides    = 0; ///< of the contact boundary

    /// The proof of CertifiedMinimum::global, unless J is convex.
    ProofStatus  proof_status = ProofStatus::proved;
    unsigned int proof_nodes  = 0;

    /// The reserve for rounding in upper - lower.
    double reserve = 0.;

    /// The parts of upper - lower - reserve of each active cell with the
    /// contact sides below it, for the bonds' branches as they are, none of
    /// them below zero; if branches may change, with what the bound for that
    /// loses at the sides.
    std::vector<double> gaps;

    /// The means of the equilibrated stress in each active cell, for the bonds'
    /// branches as they are, if there are gaps; of plane bodies in their plane.
    std::vector<dealii::SymmetricTensor<2, 3>> stresses;

    /// Ranges on the contact boundary of all displacements with J at most
    /// `upper`; empty unless the bound is for bonds that may break anywhere.
    std::vector<CertifiedSide>   sides;
    std::vector<CertifiedLength> lengths;

    /// certificate_proof(); null without.
    nlohmann::ordered_json proof;

    /// (upper - lower) / |upper|
    double
    width() const
    {
      return upper == lower ? 0. : (upper - lower) / std::abs(upper);
    }

    /// Makes the interval so wide that it has J of the result in it, which
    /// quadrature of j_1 may have moved out: then the width says how far that J
    /// can be from the minimum, too.
    void
    include(const double functional);
  };



  /// All intervals for the least J of a scene hold for the same number, on
  /// whatever mesh they were found: a bound of the other one may be the better
  /// one, and becomes that of @p certificate. Intervals for fixed branches, or
  /// for loads that are not exact, are for other numbers and change nothing.
  void
  intersect(Certificate &certificate, const Certificate &other);



  /// Bonds whose branches as they are have no least J that is known: those of a
  /// body that only bonds hold, which others than these do not.
  class FixedStateError : public EquilibriumError
  {
  public:
    using EquilibriumError::EquilibriumError;
  };



  /// Throws EquilibriumError if there is no certificate for the data of the
  /// scene: with several supports of one boundary or supports of a contact
  /// boundary, bonds that vary along a side, a gap that is not linear there,
  /// contact boundaries whose corners are rounded by a mean normal. Throws
  /// EntryError where data have no value.
  template <int dim>
  void
  check_certifiable(const Scene<dim> &scene);



  /// Certificates of displacements of a scene, for its whole load. In 3D of
  /// bonds' branches as they are alone.
  template <int dim>
  class Certifier
  {
  public:
    /// Throws as check_certifiable() does.
    Certifier(const CertificateKind                    kind,
              const std::shared_ptr<const Scene<dim>> &scene);

    /// Makes that of the displacement @p u. @p proof: limits of branch and
    /// bound. @p earlier: of the same scene on another mesh, whose bounds are
    /// used if they are of the least J and of the loads as they are. Throws
    /// EquilibriumError if no bound was found.
    Certificate
    certify(const DofVector                &u,
            const BranchAndBoundParameters &proof,
            const Interruption             &interruption,
            const Certificate              *earlier = nullptr) const;

  private:
    /// Makes the bound for bonds that break.
    void
    certify_global(const DofVector                &u,
                   const DofVector                &displacement,
                   const BranchAndBoundParameters &proof,
                   const Interruption             &interruption,
                   const Certificate              *earlier,
                   Certificate                    &certificate) const;

    void
    add_load_rests(const DofVector &u,
                   const DofVector &displacement,
                   Certificate     &certificate) const;

    const std::shared_ptr<const Scene<dim>> scene;
    const CertifiedMinimum                  minimum;
    const EquilibriumProblem<dim>           equilibrium;

    /// The laws of the contact sides.
    std::vector<PiecewiseEnergy> laws;

    /// Their trace constants, if branches are not fixed.
    std::vector<double> trace_constants;
  };
} // namespace Debond

#endif
