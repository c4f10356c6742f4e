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



  /**
   * What EquilibriumProblem is of a body: where its elements are, the sides
   * between them with their unknowns, which of these are fixed, and the loads
   * as linear stresses see them.
   *
   * Where the four triangles at a vertex are a parallelogram of one material
   * they are one element, all other cells are elements of their own. A side
   * has dim^2 unknowns, see EquilibriumElement, normal and tangential ones on
   * the contact boundary and on rollers. Loads are represented by the linear
   * tractions with the same moments on each side and by the mean body force of
   * each element.
   */
  template <int dim>
  class EquilibriumMesh
  {
  public:
    static constexpr unsigned int unknowns_of_a_side =
      EquilibriumElement<dim>::unknowns_of_a_side;

    using Cell = typename dealii::Triangulation<dim>::cell_iterator;

    struct Side
    {
      std::array<unsigned int, dim> vertices; ///< sorted

      /// Unit directions of its unknowns in the rows: the coordinates', or
      /// normal and tangential.
      dealii::Tensor<2, dim> directions;
    };



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



    /// A side on the contact boundary.
    struct ContactSide
    {
      std::array<dealii::Point<dim>, dim> corners;
      std::array<unsigned int, dim>       vertices; ///< in this order
      dealii::Tensor<1, dim>              normal;   ///< outward unit normal
      double                              measure;  ///< length or area
      unsigned int                        element;  ///< above it
      Cell                                cell;     ///< above it, active
      dealii::types::material_id          material;
      dealii::types::boundary_id          id;
      std::array<double, dim>             gap; ///< initial one, at the corners

      /// The unknowns of the normal displacement. In 2D its mean and its slope,
      /// the coefficient of xi from -1 at the first to 1 at the second end; in
      /// 3D its means with the weights 3 lambda_k, lambda_k being 1 at the k-th
      /// corner.
      std::array<unsigned int, dim> unknowns;
    };

    /// A side with a traction that is not linear.
    struct LoadRest
    {
      Cell   cell;   ///< above it
      double square; ///< the integral of the square of what is not linear
      double width, height;
    };

    /// @p thermal_stresses: of each active cell, see thermal_stresses();
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

    const std::vector<Place> &
    places() const
    {
      return all_places;
    }

    const std::vector<Side> &
    sides() const
    {
      return all_sides;
    }

    const std::vector<ContactSide> &
    contact_sides() const
    {
      return sides_in_contact;
    }

    double
    thermal_stress(const Cell &cell) const
    {
      return thermal_stresses.empty() ?
               0. :
               thermal_stresses[cell->active_cell_index()];
    }

    /// Of its sides, one after the other.
    std::vector<unsigned int>
    unknowns_of(const Place &place) const;

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

    /// The work-conjugates of all unknowns, those of a side after those of the
    /// one before.
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
    /// side, and body forces and temperatures constant on each element, to
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
    void
    find_elements();

    /// Parallelograms of four triangles.
    void
    find_parallelograms(std::vector<char> &is_taken);

    void
    find_body_forces(const Loads<dim> &given);

    /// Whether the change of temperature is the same everywhere on each cell.
    bool
    is_temperature_exact(const Loads<dim> &given) const;

    void
    make_sides();

    void
    fix_sides(const BoundaryConditions &conditions,
              const Supports<dim>      &supports,
              const Loads<dim>         &given);

    /// The values of a function at the corners of a side.
    std::array<double, dim>
    linear_values(const dealii::Function<dim>         &function,
                  const unsigned int                   component,
                  const std::array<unsigned int, dim> &side_vertices);

    std::array<dealii::Point<dim>, dim>
    corners(const std::array<unsigned int, dim> &side_vertices) const;

    const dealii::Triangulation<dim> &mesh;
    const std::vector<double>         thermal_stresses;

    std::vector<Place>       all_places;
    std::vector<Side>        all_sides;
    std::vector<ContactSide> sides_in_contact;

    // By unknown.
    std::vector<char> fixed;
    Eigen::VectorXd   loads;
    Eigen::VectorXd   prescribed;

    bool                  exact_loads = true;
    std::vector<LoadRest> all_rests;
  };
} // namespace Debond

#endif
