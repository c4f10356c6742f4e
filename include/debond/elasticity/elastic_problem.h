// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_elastic_problem_h
#define debond_elasticity_elastic_problem_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <debond/contact/boundary.h>
#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/material.h>
#include <debond/elasticity/rigid_motions.h>
#include <debond/mesh/body.h>

#include <array>
#include <memory>
#include <set>
#include <vector>

namespace Debond
{
  /// What is prescribed where.
  struct BoundaryConditions
  {
    std::set<dealii::types::boundary_id> clamped; ///< Gamma_D, u = 0
    std::set<dealii::types::boundary_id> contact; ///< Gamma_C

    /// The paper's simplification (7), u_tau = 0 on Gamma_C; otherwise
    /// sigma_tau = 0 there.
    bool tangential_displacement_fixed = true;

    /// For messages.
    BoundaryNames names = {};
  };



  /// Where A is kept: as direct factorisations and the bundle method read it,
  /// or as Trilinos' multigrid does.
  enum class MatrixStorage
  {
    serial,
    trilinos
  };



  /**
   * Linear elasticity on P1 simplices: the operator A and the load f.
   *
   * Unknowns: the Cartesian components of the displacement at each vertex,
   * except at the contact nodes, where they are the components in the node's
   * own frame: first u_nu (one degree of freedom, so that the unilateral
   * constraint is a simple bound), then the tangential ones. A vertex where
   * contact sides of different normals meet has one u_nu for each of them;
   * if tangential displacements are fixed there, it is clamped. Normals that
   * differ by less than 30 degrees count as one (their mean), as on a
   * polygonal approximation of a smooth side.
   *
   * All vectors have n_dofs() entries; the constrained ones are zero, and A
   * has only a diagonal entry there: a positive number of the size of the
   * cells' own diagonal entries, without a meaning.
   */
  template <int dim>
  class ElasticProblem
  {
  public:
    /// The unknowns of a vertex on the contact boundary: x = to_frame u, where
    /// u are the Cartesian components, and u = to_cartesian x.
    struct Frame
    {
      std::array<dealii::types::global_dof_index, dim> dofs;
      dealii::Tensor<2, dim>                           to_frame;
      dealii::Tensor<2, dim>                           to_cartesian;
    };

    /// Keeps a reference to the triangulation, a connected mesh of simplices.
    /// Throws std::invalid_argument if a boundary is both clamped and contact
    /// or is not in the mesh, if contact_frame() does, or if a rigid motion is
    /// left free; the message names the motion ("translation in y", "rotation
    /// about z"). The unilateral condition on u_nu does not count as a
    /// support.
    ElasticProblem(const dealii::Triangulation<dim> &triangulation,
                   const BoundaryConditions         &conditions);

    ElasticProblem(const ElasticProblem &) = delete;

    /// Computes A and f. Throws std::invalid_argument if the material is not
    /// valid or a load is not, see load_vector(). May be called again.
    void
    assemble(const Material     &material,
             const Loads<dim>   &loads,
             const MatrixStorage storage = MatrixStorage::serial);

    const dealii::DoFHandler<dim> &
    dof_handler() const;

    const dealii::Mapping<dim> &
    mapping() const;

    /// A, if its storage is serial.
    const dealii::SparseMatrix<double> &
    matrix() const;

    /// A, if its storage is Trilinos'.
    const dealii::TrilinosWrappers::SparseMatrix &
    trilinos_matrix() const;

    /// Of A, in either storage.
    double
    diagonal_entry(const unsigned int i) const;

    const dealii::Vector<double> &
    load() const;

    const ContactBoundary<dim> &
    contact_boundary() const;

    /// Of all vertices on the contact boundary that are not clamped.
    const std::vector<Frame> &
    contact_frames() const;

    unsigned int
    n_dofs() const;

    /// Unknowns of the discrete problem.
    unsigned int
    n_free_dofs() const;

    /// The paper's count, which includes the tangential displacements of the
    /// contact nodes although they are fixed: 710 on its mesh 40x4.
    unsigned int
    n_dofs_paper() const;

    /// The Cartesian components of a vector of unknowns, at every vertex.
    dealii::Vector<double>
    cartesian_displacement(const dealii::Vector<double> &u) const;

    /// The vector of unknowns of a displacement that is given by its Cartesian
    /// components; constrained degrees of freedom are zero.
    dealii::Vector<double>
    unknowns(const dealii::Vector<double> &cartesian_displacement) const;

    /// Translations and rotations about the origin in the unknowns, zero where
    /// constrained: the near null space of A.
    std::vector<dealii::Vector<double>>
    rigid_body_modes() const;

    /**
     * A u - f, f being @p load_factor times the load of the last assemble(), at
     * every degree of freedom, the constrained ones included, by a
     * loop over the cells that uses neither matrix() nor load(): internal
     * forces, from the cells' stresses, minus the applied nodal forces, kept
     * from the last assemble(), in the unknowns' frames. At constrained degrees
     * of freedom this is the reaction of the support, at u_nu of a contact
     * node minus the normal force of the foundation.
     */
    dealii::Vector<double>
    residual(const dealii::Vector<double> &u,
             const double                  load_factor = 1.) const;

    /**
     * What the rounding of u to double precision can make of residual(u,
     * load_factor) at each degree of freedom: epsilon (|A| |u| + |f|), with
     * norms of each cell's entries. No u can be expected to have a smaller
     * residual.
     */
    dealii::Vector<double>
    residual_rounding(const dealii::Vector<double> &u,
                      const double                  load_factor = 1.) const;

    /// The forces in the unknowns' frames (such as a residual) as Cartesian
    /// components.
    dealii::Vector<double>
    cartesian_forces(const dealii::Vector<double> &forces) const;

    /// Whether a degree of freedom is fixed to zero (clamped or tangential).
    bool
    is_constrained(const dealii::types::global_dof_index dof) const;

    /// The Cartesian nodal forces of all loads, at every degree of freedom, the
    /// constrained ones included.
    const dealii::Vector<double> &
    applied_nodal_forces() const;

    /// The resultant of all applied loads, in Cartesian components.
    dealii::Tensor<1, dim>
    total_load() const;

    /// Strain-energy density, stress and displacement gradient are constant
    /// on each cell: the stress of the active cell, in the units of E.
    dealii::SymmetricTensor<2, dim>
    stress(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
           const dealii::Vector<double> &cartesian_displacement) const;

    /// The displacement gradient of the cell, its row d that of component d.
    dealii::Tensor<2, dim>
    displacement_gradient(
      const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
      const dealii::Vector<double> &cartesian_displacement) const;

    /**
     * 1/2 <A u, u> - load_factor <f, u> from the strains of the cells, with
     * compensated sums: in a product with A, whose rows nearly cancel, rounding
     * grows with the condition of A, in the strains it does not.
     */
    double
    elastic_functional(const dealii::Vector<double> &u,
                       const double                  load_factor = 1.) const;

    const Material &
    material() const;

  private:
    void
    clamp(const BoundaryConditions  &conditions,
          std::vector<Support<dim>> &supports);

    void
    clamp_vertex(
      const std::array<dealii::types::global_dof_index, dim> &vertex_dofs,
      const dealii::Point<dim>                               &position,
      std::vector<Support<dim>>                              &supports);

    void
    make_contact_boundary(const BoundaryConditions  &conditions,
                          const double               diameter,
                          std::vector<Support<dim>> &supports);

    template <typename MatrixType>
    void
    add_cell_matrices(MatrixType &matrix) const;

    /// Cartesian forces as forces in the unknowns' frames.
    dealii::Vector<double>
    in_frames(const dealii::Vector<double> &forces) const;

    const dealii::MappingFE<dim> mapping_p1;
    const dealii::FESystem<dim>  fe;
    dealii::DoFHandler<dim>      dofs;

    /// By vertex index, invalid_unsigned_int where the unknowns are Cartesian.
    std::vector<unsigned int> frame_of_vertex;
    std::vector<Frame>        frames;

    dealii::AffineConstraints<double> constraints;
    unsigned int                      n_fixed_tangential_dofs = 0;
    ContactBoundary<dim>              contact;

    Material                        elastic_material;
    dealii::SymmetricTensor<4, dim> stiffness;

    MatrixStorage                storage = MatrixStorage::serial;
    dealii::SparsityPattern      sparsity;
    dealii::SparseMatrix<double> system_matrix;
    // An empty one would need MPI already.
    std::unique_ptr<dealii::TrilinosWrappers::SparseMatrix> distributed_matrix;
    dealii::Vector<double>                                  system_load;

    dealii::Vector<double> applied_forces; ///< see applied_nodal_forces()
  };
} // namespace Debond

#endif
