// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_mortar_h
#define debond_elasticity_mortar_h

#include <debond/elasticity/node_supports.h>
#include <debond/mesh/overlap.h>

namespace Debond
{
  /**
   * The jumps between two bodies whose meshes do not match, by dual mortar
   * multipliers. With the functions psi_i of the high side's nodes that are
   * biorthogonal to its basis phi_i, s_i = int psi_i [u] / w_i, w_i = int
   * psi_i, becomes an unknown of its own in
   *
   *     u_i = (w_i / D_i) [u]_i + sum of P_ij u_j of the low side,
   *
   * D_i = int psi_i phi_i, P_ij = int psi_i phi_j / D_i: what a constant
   * traction does is exact on any pair of meshes, and the forces of both sides
   * balance. See Wohlmuth, A mortar finite element method using dual spaces for
   * the Lagrange multiplier, 2000, and doc/reference/theory.md.
   *
   * A node that a support holds has no jump: its psi is added to that of the
   * nearest node without support, whose jump it has in the integrals of bonds.
   * Where nothing is asked of the displacement along the interface, and
   * supports hold nothing else, it keeps the normal jump.
   *
   * The distance between the sides in the mesh is a gap, int psi_i distance /
   * w_i, unless they touch each other but for what facets are off a curve.
   */
  template <int dim>
  class MortarInterface
  {
  public:
    /// @p name: for messages. Throws EntryError if the @p low side does not
    /// cover the
    /// @p high one, if that has a corner, or if all of it is held.
    MortarInterface(const std::string                    &name,
                    const std::vector<BoundaryFace<dim>> &high,
                    const std::vector<BoundaryFace<dim>> &low,
                    const NodeSupports<dim>              &supports,
                    const BoundaryConditions             &conditions);

    /// Those of a step of a ChangeOfBasis from displacements to jumps, of which
    /// each is of the low side's nodes first.
    const std::vector<BasisRow<dim>> &
    rows() const
    {
      return all_rows;
    }

    /// Gives a face of the high side the nodes whose jumps it has, and the
    /// gaps.
    void
    set_jumps(BoundaryFace<dim> &face) const;

  private:
    struct Node
    {
      dealii::Point<dim>                  position;
      std::vector<dealii::Tensor<1, dim>> normals; ///< of the faces around it
      std::vector<double>                 measures;

      /// The node whose jump it has.
      unsigned int jump;

      /// What a displacement has where only its part along the normal is that
      /// of the jump.
      dealii::Tensor<2, dim> jumps = dealii::unit_symmetric_tensor<dim>();

      /// Integrals of psi: alone, times phi, times the distance, and times the
      /// basis functions of other nodes, the low side's and the held ones.
      double                         weight = 0., diagonal = 0., gap = 0.;
      std::map<unsigned int, double> of_low = {}, of_held = {};
    };

    void
    find_nodes(const std::vector<BoundaryFace<dim>> &high,
               const NodeSupports<dim>              &supports,
               const BoundaryConditions             &conditions);

    /// Finds the nodes whose jumps those that are held have.
    void
    replace_held(const std::set<unsigned int> &held);

    /// Adds the integrals over a face, from its overlaps @p begin to @p end.
    using Overlaps = std::vector<Overlap<dim>>;
    void
    integrate(const BoundaryFace<dim>              &face,
              const std::vector<BoundaryFace<dim>> &low,
              const Symmetry                        symmetry,
              typename Overlaps::const_iterator     begin,
              typename Overlaps::const_iterator     end);

    void
    make_rows();

    std::map<unsigned int, Node> nodes;
    std::vector<BasisRow<dim>>   all_rows;
    bool                         touches = true;
  };
} // namespace Debond

#endif
