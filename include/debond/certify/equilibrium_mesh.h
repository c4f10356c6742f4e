// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_equilibrium_mesh_h
#define debond_certify_equilibrium_mesh_h

#include <debond/certify/equilibrium_element.h>
#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/unknowns.h>

namespace Debond
{
  /// A body or a load for which there are no equilibrated stresses.
  class EquilibriumError : public EntryError
  {
  public:
    explicit EquilibriumError(const std::string &message)
      : EntryError("Certificate/Kind", message)
    {}
  };



  /// Stresses that rounding keeps from being found: no fault of the scene.
  class StressRoundingError : public EquilibriumError
  {
  public:
    using EquilibriumError::EquilibriumError;
  };



  /// Throws EquilibriumError for what is not done: contact boundaries that are
  /// supported as well, and boundaries with several supports.
  template <int dim>
  void
  check_supports(const BoundaryConditions &conditions,
                 const Supports<dim>      &supports);



  /**
   * What EquilibriumProblem is of a body: its active cells, which are the
   * elements, the sides between them with their unknowns, which of these are
   * fixed, and the loads as linear stresses see them.
   *
   * A side has dim^2 unknowns, see EquilibriumElement, vector by vector in the
   * order of the numbers of its vertices, normal and tangential ones on the
   * contact boundary and on rollers. Loads are represented by the linear
   * tractions with the same moments on each side and by the mean body force of
   * each cell.
   */
  template <int dim>
  struct EquilibriumMesh
  {
    static constexpr unsigned int unknowns_of_a_side =
      EquilibriumElement<dim>::unknowns_of_a_side;

    using Cell = typename dealii::Triangulation<dim>::cell_iterator;
    using Load = typename EquilibriumElement<dim>::Load;

    /// A side at the boundary.
    struct Side
    {
      Cell                                cell; ///< above it, active
      unsigned int                        first_unknown;
      std::array<unsigned int, dim>       vertices; ///< rising
      std::array<dealii::Point<dim>, dim> corners;  ///< in this order
      dealii::types::boundary_id          id;
      dealii::Tensor<1, dim>              normal;  ///< outward unit normal
      double                              measure; ///< length or area
      double                              diameter;
      std::array<double, dim>             gap = {}; ///< initial, at the corners

      /// The unknown that is the mean of the displacement along the first
      /// direction, the normal one of contact sides, with the weight
      /// dim lambda_k.
      unsigned int
      unknown(const unsigned int k) const
      {
        return first_unknown + dim * k;
      }
    };

    /// A side with a traction that is not linear.
    struct LoadRest
    {
      Cell   cell;   ///< above it
      double square; ///< the integral of the square of what is not linear
      double width, height;
    };

    /// Takes supports that pass check_supports(). @p thermal_stresses: of each
    /// active cell, as a pressure; none if empty. Keeps a reference to the
    /// mesh. Throws EntryError where a load, a gap or a prescribed displacement
    /// has no value.
    EquilibriumMesh(const dealii::Triangulation<dim> &mesh,
                    const BoundaryConditions         &conditions,
                    const Supports<dim>              &supports,
                    const Loads<dim>                 &loads,
                    const std::vector<double>        &thermal_stresses);

    /// The vertices of a cell but one, in its order.
    static std::array<unsigned int, dim>
    vertices_of_side(const Cell &cell, const unsigned int corner);

    /// The first unknown of the side of a cell that is opposite to a corner.
    static unsigned int
    first_unknown(const Cell &cell, const unsigned int corner);

    /// The unknowns of the sides of a cell, one side after the other.
    static std::vector<unsigned int>
    unknowns_of(const Cell &cell);

    /// R with l = R x for x these unknowns and l of EquilibriumElement;
    /// orthogonal.
    Eigen::MatrixXd
    rotation(const Cell &cell) const;

    /// Unit directions of the unknowns of a side in the rows: the coordinates',
    /// or normal and tangential.
    const dealii::Tensor<2, dim> &
    directions(const unsigned int first_unknown) const
    {
      return all_directions[first_unknown / unknowns_of_a_side];
    }

    const dealii::Triangulation<dim> &triangulation;
    std::vector<Load>                 loads_of_cells; ///< of the active ones
    std::vector<Side>                 contact_sides;

    // By unknown: whether it is fixed, its work-conjugate, and the gaps and the
    // prescribed displacements, zero for all others: linear on each side, as
    // they are at its corners.
    std::vector<char> is_fixed;
    Eigen::VectorXd   loads_on_sides;
    Eigen::VectorXd   lifting;

    /// True if tractions, gaps and prescribed displacements are linear on each
    /// side, and body forces and temperatures constant on each cell, to
    /// rounding.
    bool loads_are_exact = true;

    std::vector<LoadRest> load_rests;

  private:
    void
    find_loads_of_cells(const Loads<dim>          &given,
                        const std::vector<double> &thermal_stresses);

    void
    set_supports(const Side               &side,
                 const BoundaryConditions &conditions,
                 const Supports<dim>      &supports);

    void
    set_contact(Side                     &side,
                const BoundaryConditions &conditions,
                const Supports<dim>      &supports);

    void
    set_traction(const Side &side, const Loads<dim> &given);

    /// Makes the normal the first direction of a side.
    void
    use_normal(const Side &side);

    void
    fix(const Side &side, const unsigned int direction);

    /// Makes the values of a function at the corners of a side the displacement
    /// in a direction, and returns them.
    std::array<double, dim>
    prescribe(const Side                  &side,
              const unsigned int           direction,
              const dealii::Function<dim> &function,
              const unsigned int           component);

    std::vector<dealii::Tensor<2, dim>> all_directions; ///< of sides
  };



  /// The corners of a cell.
  template <int dim>
  SimplexCorners<dim>
  corners_of(const typename dealii::Triangulation<dim>::cell_iterator &cell)
  {
    SimplexCorners<dim> corners;
    for (unsigned int v = 0; v <= dim; ++v)
      corners[v] = cell->vertex(v);
    return corners;
  }
} // namespace Debond

#endif
