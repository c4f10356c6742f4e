// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_unknowns_h
#define debond_elasticity_unknowns_h

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>

#include <debond/elasticity/constrained_dofs.h>
#include <debond/elasticity/contact_space.h>
#include <debond/elasticity/load_factors.h>

namespace Debond
{
  /**
   * The unknowns of elasticity on simplices of degree 1 or 2: the Cartesian
   * components of the displacement at each node (vertices, and of degree 2
   * middles of edges) except at the contact nodes. There they are the
   * components in the node's own frame: first u_nu (one degree of freedom, so
   * that the unilateral constraint is a simple bound), then the tangential
   * ones; at edges of contact faces they are those of a coefficient, see
   * edge_coefficients(). The degrees of freedom of node n are dim n, dim n + 1,
   * ... A vertex where contact sides of different normals
   * meet has one u_nu for each of them; if tangential displacements are fixed
   * there, it is clamped. Faces that make one side of a polygon that stands for
   * a smooth one (see VertexNormals) have one normal, their mean. What is said
   * of vertices below is true of edges, of degree 2: they are in their middles,
   * and as u_nu on a face is nowhere above its largest coefficient, u_nu <= 0
   * holds at every point.
   *
   * Where two bodies are glued to each other the unknowns of one node of each
   * pair are those of the jump, in the same way (see NodePairs). basis() takes
   * all of them to Cartesian components at nodes, and back.
   *
   * All vectors have n_dofs() entries; the constrained ones are zero. So they
   * are w in u = w + G, where G, the lifting, has the prescribed displacements
   * at constrained degrees of freedom and the gap g at contact normals: u_nu <=
   * g is w_nu <= 0, and nothing that minimises knows of G.
   */
  template <int dim>
  class ElasticUnknowns
  {
  public:
    /// Keeps a reference to the triangulation, a connected mesh of simplices.
    /// Throws std::invalid_argument if a boundary is both clamped and contact
    /// or is not in the mesh, if contact_frame() does, or if a rigid motion is
    /// left free that moves no contact node along its normal; the message names
    /// the motion ("translation in y", "rotation about z"). Throws SupportError
    /// if supports contradict each other or the foundation, are not finite
    /// somewhere, or if a roller is not flat, and EntryError if a body of
    /// revolution reaches beyond its axis. Nodes on the axis are held along x.
    ///
    /// All ranks that share the mesh have to call it. All know all of what
    /// supports and contact make of the unknowns.
    ElasticUnknowns(const dealii::Triangulation<dim> &triangulation,
                    const BoundaryConditions         &conditions,
                    const Supports<dim>              &supports = {},
                    const unsigned int                degree   = 1);

    ElasticUnknowns(const ElasticUnknowns &) = delete;

    const dealii::DoFHandler<dim> &
    dof_handler() const
    {
      return dofs;
    }

    const dealii::Mapping<dim> &
    mapping() const
    {
      return mapping_p1;
    }

    /// The ranks that share the mesh.
    MPI_Comm
    communicator() const
    {
      return dofs.get_communicator();
    }

    /// The degree of the displacement's polynomials.
    unsigned int
    degree() const
    {
      return fe.degree;
    }

    Symmetry
    symmetry() const
    {
      return contact_space.boundary().symmetry;
    }

    /// The nodes on the axis of a body of revolution.
    const std::set<unsigned int> &
    on_axis() const
    {
      return axis_nodes;
    }

    const ContactSpace<dim> &
    contact() const
    {
      return contact_space;
    }

    /// The change between Cartesian components at nodes and the unknowns.
    const ChangeOfBasis<dim> &
    basis() const
    {
      return change_of_basis;
    }

    /// The nodes of bodies that are glued to each other.
    const NodePairs<dim> &
    pairs() const
    {
      return node_pairs;
    }

    /// Returns whether bodies are glued to each other somewhere.
    bool
    has_interfaces() const
    {
      return !basis().rows(BasisStep::jumps).empty();
    }

    /// The number of bodies that have no nodes in common.
    unsigned int
    n_bodies() const
    {
      return bodies.empty() ?
               1 :
               1 + *std::max_element(bodies.begin(), bodies.end());
    }

    /// The number of the body that a node belongs to.
    unsigned int
    body_of(const unsigned int node) const
    {
      return bodies.empty() ? 0 : bodies[node];
    }

    /// The positions of the nodes, each of which has dim successive degrees of
    /// freedom. All ranks have to call it.
    std::vector<dealii::Point<dim>>
    node_positions() const;

    /// The numbers for files: for each degree of freedom that which it has on
    /// one rank. All ranks have to call it.
    std::vector<dealii::types::global_dof_index>
    serial_order() const;

    unsigned int
    n_dofs() const
    {
      return dofs.n_dofs();
    }

    /// The number of unknowns of the discrete problem.
    unsigned int
    n_free_dofs() const
    {
      return n_dofs() - constraints().n_constraints();
    }

    /// Returns whether a degree of freedom is prescribed (by a support or
    /// tangential).
    bool
    is_constrained(const dealii::types::global_dof_index dof) const
    {
      return constraints().is_constrained(dof);
    }

    /// The fixed degrees of freedom.
    const dealii::AffineConstraints<double> &
    constraints() const
    {
      return constrained.constraints();
    }

    /// The pieces of the boundary that support the body, by name.
    const std::vector<std::string> &
    support_names() const
    {
      return names_of_supports;
    }

    /// The free rigid motions: what holds them, if anything does, are bonds
    /// and the foundation. A is singular if there are any.
    const FreeRigidMotions<dim> &
    held_by_contact() const
    {
      return free_motions;
    }

    /// Returns whether the supports alone hold the body, so that A is definite.
    bool
    is_held_by_supports() const
    {
      return free_motions.motions.empty();
    }

    const std::vector<SupportedDof> &
    supported() const
    {
      return constrained.supported();
    }

    /// Returns whether G is not zero.
    bool
    has_lifting() const
    {
      return has_prescribed_displacements() || has_gap();
    }

    bool
    has_prescribed_displacements() const
    {
      return constrained.displacements().size() > 0;
    }

    /// Returns whether a part of G does not grow with the load.
    bool
    has_gap() const
    {
      return constrained.gaps().size() > 0;
    }

    /// G, with @p factors times the prescribed displacements and the gap.
    DofVector
    lifting(const LoadFactors factors = 1.) const;

    /// w + G.
    DofVector
    lifted(DofVector w, const LoadFactors factors = 1.) const;

    /// The Cartesian components of the displacement u = w + G at every node:
    /// the vector of the finite element field.
    DofVector
    cartesian_displacement(const DofVector  &w,
                           const LoadFactors factors = 1.) const
    {
      return basis().to_nodal(lifted(w, factors));
    }

    /// The vector w of a displacement that is given by its Cartesian
    /// components; constrained degrees of freedom are zero.
    DofVector
    from_cartesian(const DofVector &cartesian_displacement) const;

    /// The forces on the unknowns (such as a residual) as Cartesian components;
    /// at edges of contact faces they remain those on coefficients, of which
    /// sums are the same.
    DofVector
    cartesian_forces(const DofVector &forces) const
    {
      return basis().forces_to_nodal(forces, BasisStep::jumps);
    }

    /// Returns the forces between bodies: those on the high side alone, in the
    /// place of the jump.
    DofVector
    contact_forces(const DofVector &forces) const
    {
      return basis().forces_to_nodal(forces, BasisStep::frames);
    }

    /// The Cartesian displacements at nodes under rigid motions, each of which
    /// is given for each body. All ranks have to call it.
    std::vector<DofVector>
    displacements_of(
      const std::vector<std::vector<RigidMotion<dim>>> &motions) const;

    /// Translations and rotations about the origin in the unknowns, zero where
    /// constrained: the near null space of A.
    std::vector<DofVector>
    rigid_body_modes() const;

  private:
    /// Glues bodies to each other with their supports; takes contact faces of
    /// interfaces to the nodes of the jumps. Throws as the constructor does.
    void
    make_jumps(const std::vector<BoundaryFace<dim>> &low,
               const BoundaryConditions             &conditions,
               NodeSupports<dim>                    &node_supports,
               std::vector<BoundaryFace<dim>>       &contact);

    /// Throws EntryError if bodies lie on each other that could go through each
    /// other, or if a contact boundary is next to another body.
    void
    check_neighbours(const BoundaryConditions &conditions) const;

    /// Finds what supports in these directions leave free. Throws as the
    /// constructor does.
    void
    find_free_motions(std::vector<Support<dim>> held);

    const dealii::MappingFE<dim> mapping_p1;
    const dealii::FESystem<dim>  fe;
    dealii::DoFHandler<dim>      dofs;

    /// Numbers the bodies that have no nodes in common. Returns where they are,
    /// for names; an empty text if there is one.
    std::vector<std::string>
    find_bodies();

    ChangeOfBasis<dim>        change_of_basis;
    NodePairs<dim>            node_pairs;
    std::vector<unsigned int> bodies; ///< by node, or empty
    std::set<unsigned int>    axis_nodes;
    std::vector<std::string>  names_of_supports;
    ConstrainedDofs<dim>      constrained; ///< with G
    ContactSpace<dim>         contact_space;
    FreeRigidMotions<dim>     free_motions;
  };
} // namespace Debond

#endif
