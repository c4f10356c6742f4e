// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_equilibrium_problem_h
#define debond_elasticity_equilibrium_problem_h

#include <deal.II/grid/tria.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <debond/elasticity/cell_displacement.h>
#include <debond/elasticity/equilibrium_element.h>
#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/unknowns.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/mesh/by_region.h>

#include <memory>
#include <stdexcept>
#include <vector>

namespace Debond
{
  /// A body or a load for which there are no equilibrated stresses.
  class EquilibriumError : public std::invalid_argument
  {
  public:
    using std::invalid_argument::invalid_argument;
  };



  /**
   * The best equilibrated stress of a body for given normal displacements of
   * its contact boundary, by EquilibriumElement on all cells: where the four
   * triangles at a vertex are a parallelogram of one material they are one
   * element, all other cells are elements of their own. The tractions between
   * elements are made continuous by the displacements of the sides
   * (hybridisation), which are the unknowns: dim^2 numbers a side, see
   * EquilibriumElement, normal and tangential ones on the contact boundary and
   * on rollers. The matrix is symmetric and positive definite.
   *
   * Loads are represented by the linear tractions with the same moments on each
   * side and by the mean body force of each element.
   */
  template <int dim>
  class EquilibriumProblem
  {
  public:
    /// A side on the contact boundary.
    struct ContactSide
    {
      std::array<dealii::Point<dim>, dim> corners;
      std::array<unsigned int, dim>       vertices; ///< in this order
      dealii::Tensor<1, dim>              normal;   ///< outward unit normal
      double                              measure;  ///< length or area
      unsigned int                        element;  ///< above it
      unsigned int                        cell;     ///< above it, active
      dealii::types::material_id          material;

      /// The unknowns of the normal displacement. In 2D its mean and its slope,
      /// the coefficient of xi from -1 at the first to 1 at the second end; in
      /// 3D its means with the weights 3 lambda_k, lambda_k being 1 at the k-th
      /// corner.
      std::array<unsigned int, dim> unknowns;
    };

    /// @p thermal_stresses: of each active cell, see thermal_stresses(); none
    /// if empty. Keeps a reference to the mesh. Throws EquilibriumError for
    /// what is not done: displacements that are prescribed and not zero, gaps,
    /// and contact sides that are supported as well.
    EquilibriumProblem(const dealii::Triangulation<dim> &mesh,
                       const BoundaryConditions         &conditions,
                       const Supports<dim>              &supports,
                       const ByRegion<Material>         &materials,
                       const Loads<dim>                 &loads,
                       const std::vector<double>        &thermal_stresses = {});

    const std::vector<EquilibriumElement<dim>> &
    elements() const;

    const std::vector<ContactSide> &
    contact_sides() const;

    /// Of the mesh.
    const std::vector<dealii::Point<dim>> &
    vertices() const;

    /// Fixes an unknown.
    void
    fix(const unsigned int unknown);

    /// Unknowns that are not fixed.
    unsigned int
    n_unknowns() const;

    /// Whether tractions are linear on each side, and body forces and
    /// temperatures constant on each element, to rounding.
    bool
    loads_are_exact() const;

    /// The problem condensed onto the first unknowns of the contact sides in
    /// their order, the means in 2D, or then onto the second ones (and the
    /// third ones) as well:
    ///     max_sigma -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1)
    ///               + int_{Gamma_C} sigma_nu p
    ///         = c_0 + 1/2 s'S s - g's,
    /// p the linear normal displacement that these unknowns s are of, and in 2D
    /// without the slopes the best one.
    /// Each element is @p weights times as stiff (all as they are if empty);
    /// @p added has unknowns and what is added to their diagonal entries of the
    /// matrix.
    ///
    /// Throws std::runtime_error if the matrix is not positive definite.
    std::unique_ptr<Condensation>
    condense(
      const bool                                          keep_all,
      const std::vector<double>                          &weights = {},
      const std::vector<std::pair<unsigned int, double>> &added   = {}) const;

    /// 1/2 a(u,u) - L(u) of the displacement u, given in the order of the
    /// active cells, for the loads as represented here.
    double
    elastic_functional(const std::vector<CellDisplacement<dim>> &u) const;

    /// Of each active cell int epsilon(u) : C epsilon(u).
    std::vector<double>
    strain_energies(const std::vector<CellDisplacement<dim>> &u) const;

    /// The same of each element.
    std::vector<double>
    element_energies(const std::vector<CellDisplacement<dim>> &u) const;

    /// Of each active cell
    ///     1/2 int |C^{1/2} epsilon(u) - C^{-1/2} (sigma + p 1)|^2
    /// of u as above and of the stress for @p unknowns, which are those of a
    /// condensation without weights.
    std::vector<double>
    constitutive_gaps(const std::vector<CellDisplacement<dim>> &u,
                      const DofVector                          &unknowns) const;

    /// What elimination may have lost of
    ///     c_0 - 1/2 s'S s = -1/2 int (sigma + p 1) : C^{-1} (sigma + p 1)
    /// of a condensation with @p weights to rounding: four times by how much
    /// this fails at @p kept for the stress that belongs to it.
    double
    rounding_of(const Condensation        &condensed,
                const Eigen::VectorXd     &kept,
                const std::vector<double> &weights = {}) const;

    /// Of each active cell the mean of the same stress without p.
    std::vector<dealii::SymmetricTensor<2, dim>>
    mean_stresses(const DofVector &unknowns) const;

  private:
    struct Side
    {
      std::array<unsigned int, dim> vertices; ///< sorted

      /// Unit directions of its unknowns in the rows: the coordinates', or
      /// normal and tangential.
      dealii::Tensor<2, dim> directions;
    };

    using Cell = typename dealii::Triangulation<dim>::cell_iterator;

    /// An element in the mesh: its corners in their order, the active cell
    /// above each of its sides (always the same one but in parallelograms), its
    /// sides, and where in their vertices the corners of each are, see
    /// corners_of_side().
    struct Place
    {
      std::vector<unsigned int>                  vertices;
      std::vector<Cell>                          cells;
      std::vector<unsigned int>                  sides;
      std::vector<std::array<unsigned int, dim>> positions;
      dealii::Tensor<1, dim>                     body_force;

      /// In how many parts its sides and its centre divide a cell.
      double
      parts_of_a_cell() const
      {
        return vertices.size() == dim + 1 ? dim + 1. : 1.;
      }

      /// Of a side, in the order of corners_of_side().
      std::array<unsigned int, dim>
      side(const unsigned int number) const
      {
        std::array<unsigned int, dim> result =
          corners_of_side<dim>(static_cast<unsigned int>(vertices.size()),
                               number);
        for (unsigned int &corner : result)
          corner = vertices[corner];
        return result;
      }
    };

    void
    find_elements();

    /// Parallelograms of four triangles.
    void
    find_parallelograms(std::vector<char> &is_taken);

    void
    make_elements(const Loads<dim> &loads);

    /// Whether the change of temperature is the same everywhere on each cell.
    bool
    is_temperature_exact(const Loads<dim> &loads) const;

    void
    make_sides();

    void
    fix_sides(const BoundaryConditions &conditions,
              const Supports<dim>      &supports,
              const Loads<dim>         &loads);

    void
    add_tractions(const unsigned int           side,
                  const dealii::Function<dim> &traction);

    std::array<dealii::Point<dim>, dim>
    corners(const std::array<unsigned int, dim> &side_vertices) const;

    /// EquilibriumElement::stress() for all unknowns.
    Eigen::VectorXd
    stress_of(const unsigned int element,
              const DofVector   &unknowns,
              const double       weight = 1.) const;

    double
    thermal_stress(const Cell &cell) const;

    std::vector<unsigned int>
    unknowns_of(const unsigned int element) const;

    /// l of EquilibriumElement as this matrix times the element's unknowns.
    Eigen::MatrixXd
    to_element(const unsigned int element) const;

    const dealii::Triangulation<dim> &mesh;
    const ByRegion<Material>          materials;
    const std::vector<double>         thermal_stresses;

    std::vector<Place>                   places;
    std::vector<EquilibriumElement<dim>> all_elements;
    std::vector<Side>                    sides;
    std::vector<ContactSide>             sides_in_contact;

    // By unknown, those of a side after those of the one before.
    std::vector<char> is_fixed;
    Eigen::VectorXd   loads_on_sides;

    bool exact_loads = true;
  };
} // namespace Debond

#endif
