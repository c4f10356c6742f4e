// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_check_plausibility_h
#define debond_check_plausibility_h

#include <debond/check/verification.h>

namespace Debond
{
  /// The numbers that tell whether a result can be that of linear elasticity.
  struct LargestValues
  {
    double displacement = 0.; ///< |u| at a vertex, length
    double gradient     = 0.; ///< |grad u| of a cell (Frobenius' norm)
    double von_mises    = 0.; ///< of a cell, force per area
  };

  /// Returns the largest values of the displacement @p u. The largest stress of
  /// a body with clamped corners grows with refinement.
  template <int dim>
  LargestValues
  largest_values(const ElasticProblem<dim> &problem,
                 const DofVector           &u,
                 const LoadFactors          factors = 1.);



  /// The least number of faces of the contact boundary in the length
  /// E' G / strength^2, over which bonds soften (Hillerborg, Modeer, Petersson,
  /// Cement Concr. Res. 6, 1976); infinite if they do not. E' = E, or E / (1 -
  /// nu^2) in plane strain and 3D, of the cell at the face, G what breaks
  /// bonds.
  template <int dim>
  double
  faces_in_softening_zone(const ElasticProblem<dim>   &problem,
                          const AdhesionIntegral<dim> &adhesion);



  /// Returns notes for the user on a result that is right as the solution of
  /// the discrete problem: that displacements are too large for linear
  /// elasticity, or that faces are too large for bonds that soften or, by the
  /// largest LoadPathState::cell_size_at_edge, that break at once.
  std::vector<std::string>
  plausibility_notes(const LargestValues &largest,
                     const double         faces_in_softening_zone,
                     const double         cell_size_at_edge);

  /// Returns notes on bodies that do not slide along their contact boundary as
  /// their bonds would let them: nodes of bodies that are glued to each other,
  /// if they are fixed along it, bear more than bonds could, or flat faces of a
  /// curved boundary press on each other where bonds are broken by slip.
  template <int dim>
  std::vector<std::string>
  sliding_notes(const AdhesionIntegral<dim> &adhesion,
                const Verification<dim>     &verification,
                const bool                   are_glued,
                const bool                   is_curved);

  /// Returns notes on bonds that are hardly meant: there are none, all are
  /// broken at rest, or none breaks before the body has moved by its size. All
  /// ranks have to call it.
  template <int dim>
  std::vector<std::string>
  bond_notes(const dealii::Triangulation<dim>    &body,
             const std::vector<ContactNodeState> &nodes);
} // namespace Debond

#endif
