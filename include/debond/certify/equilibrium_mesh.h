// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_equilibrium_mesh_h
#define debond_certify_equilibrium_mesh_h

#include <deal.II/grid/tria.h>

#include <debond/certify/equilibrium_element.h>
#include <debond/elasticity/load_vector.h>
#include <debond/elasticity/unknowns.h>

#include <Eigen/Core>

#include <array>
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



  /// Stresses that rounding keeps from being found: no fault of the scene.
  class StressRoundingError : public EquilibriumError
  {
  public:
    using EquilibriumError::EquilibriumError;
  };



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
  class EquilibriumMesh
  {
  public:
    static constexpr unsigned int unknowns_of_a_side =
      EquilibriumElement<dim>::unknowns_of_a_side;

    using Cell = typename dealii::Triangulation<dim>::cell_iterator;
    using Load = typename EquilibriumElement<dim>::Load;

    /// A side on the contact boundary.
    struct ContactSide
    {
      std::array<dealii::Point<dim>, dim> corners;
      std::array<unsigned int, dim>       vertices; ///< in this order, rising
      dealii::Tensor<1, dim>              normal;   ///< outward unit normal
      double                              measure;  ///< length or area
      Cell                                cell;     ///< above it, active
      dealii::types::boundary_id          id;
      std::array<double, dim>             gap; ///< initial one, at the corners

      /// Of the normal displacement: its means with the weights dim lambda_k.
      std::array<unsigned int, dim> unknowns;
    };

    /// A side with a traction that is not linear.
    struct LoadRest
    {
      Cell   cell;   ///< above it
      double square; ///< the integral of the square of what is not linear
      double width, height;
    };

    /// @p thermal_stresses: of each active cell, as a pressure;
    /// none if empty. Keeps a reference to the mesh. Throws EquilibriumError
    /// for what is not done: contact sides that are supported as well, and
    /// sides with several supports.
    EquilibriumMesh(const dealii::Triangulation<dim> &mesh,
                    const BoundaryConditions         &conditions,
                    const Supports<dim>              &supports,
                    const Loads<dim>                 &loads,
                    const std::vector<double>        &thermal_stresses);

    const dealii::Triangulation<dim> &
    triangulation() const
    {
      return mesh;
    }

    /// Of an active cell, as of all others.
    const Load &
    load(const unsigned int cell) const
    {
      return loads_of_cells[cell];
    }

    const std::vector<ContactSide> &
    contact_sides() const
    {
      return sides_in_contact;
    }

    /// Those of a cell but one, in its order.
    static std::array<unsigned int, dim>
    vertices_of_side(const Cell &cell, const unsigned int corner);

    /// The first unknown of the side of a cell that is opposite to a corner.
    static unsigned int
    first_unknown(const Cell &cell, const unsigned int corner);

    /// Of its sides, one after the other.
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

    /// Fixes an unknown.
    void
    fix(const unsigned int unknown)
    {
      fixed[unknown] = 1;
    }

    bool
    is_fixed(const unsigned int unknown) const
    {
      return fixed[unknown] != 0;
    }

    unsigned int
    n_free_unknowns() const;

    /// The work-conjugates of all unknowns.
    const Eigen::VectorXd &
    loads_on_sides() const
    {
      return loads;
    }

    /// The gaps and the prescribed displacements by unknown, zero for all
    /// others: linear on each side, as they are at its corners.
    const Eigen::VectorXd &
    lifting() const
    {
      return prescribed;
    }

    /// Whether tractions, gaps and prescribed displacements are linear on each
    /// side, and body forces and temperatures constant on each cell, to
    /// rounding.
    bool
    loads_are_exact() const
    {
      return exact_loads;
    }

    const std::vector<LoadRest> &
    load_rests() const
    {
      return all_rests;
    }

  private:
    /// A side at the boundary.
    struct BoundarySide
    {
      Cell                                cell;
      unsigned int                        first_unknown;
      std::array<unsigned int, dim>       vertices; ///< rising
      std::array<dealii::Point<dim>, dim> corners;
      dealii::types::boundary_id          id;
      dealii::Tensor<1, dim>              normal;
      double                              measure;
      double                              diameter;
    };

    void
    find_loads_of_cells(const Loads<dim>          &given,
                        const std::vector<double> &thermal_stresses);

    /// Whether the change of temperature is the same everywhere on each cell.
    bool
    is_temperature_exact(const Loads<dim> &given) const;

    void
    set_supports(const BoundarySide       &side,
                 const BoundaryConditions &conditions,
                 const Supports<dim>      &supports);

    void
    set_contact(const BoundarySide       &side,
                const BoundaryConditions &conditions,
                const Supports<dim>      &supports);

    void
    set_traction(const BoundarySide &side, const Loads<dim> &given);

    /// The normal comes first.
    void
    use_normal(const BoundarySide &side);

    void
    fix(const BoundarySide &side, const unsigned int direction);

    /// The values of a function at the corners of a side become the
    /// displacement in a direction, and are returned.
    std::array<double, dim>
    prescribe(const BoundarySide          &side,
              const unsigned int           direction,
              const dealii::Function<dim> &function,
              const unsigned int           component);

    const dealii::Triangulation<dim> &mesh;
    std::vector<Load>                 loads_of_cells;

    std::vector<dealii::Tensor<2, dim>> all_directions; ///< of sides
    std::vector<ContactSide>            sides_in_contact;

    // By unknown.
    std::vector<char> fixed;
    Eigen::VectorXd   loads;
    Eigen::VectorXd   prescribed;

    bool                  exact_loads = true;
    std::vector<LoadRest> all_rests;
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
