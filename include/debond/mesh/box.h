// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_box_h
#define debond_mesh_box_h

#include <debond/mesh/body.h>
#include <debond/mesh/crossed_mesh.h>

namespace Debond
{
  /// The body (0, L_1) x (0, L_2) [x (0, L_3)], turned about the origin.
  struct BoxParameters
  {
    std::array<double, 3>       lengths  = {{0.4, 0.04, 0.04}};
    std::array<unsigned int, 3> cells    = {{40, 4, 4}};
    double                      rotation = 0.; ///< degrees, in the x-y plane
  };



  /**
   * The sides of the (unturned) box by name: left and right are the smallest
   * and largest x, bottom and top y, back and front z (3D only).
   */
  template <int dim>
  const std::map<std::string, dealii::types::boundary_id> &
  box_sides();

  template <int dim>
  BoundaryNames
  box_boundaries();

  /// By an angle in degrees in the x-y plane.
  template <int dim>
  dealii::Tensor<2, dim>
  rotation_matrix(const double degrees);

  /// The crossed mesh of a box with the boundary ids of box_sides(). Throws
  /// std::invalid_argument if a length is not positive or there are no cells in
  /// a direction.
  template <int dim>
  void
  make_box(const BoxParameters        &parameters,
           dealii::Triangulation<dim> &crossed);

  /// Returns the simplices that the cells of this mesh from @p begin on have,
  /// so many in each direction: see crossed_cells(). The boundary ids are those
  /// of box_sides(), also where the part ends inside of the box.
  template <int dim>
  CellsAndVertices<dim>
  part_of_box(const BoxParameters               &box,
              const std::array<unsigned int, 3> &begin,
              const std::array<unsigned int, 3> &n_cells);



  /// A box with its crossed mesh.
  template <int dim>
  class Box : public Body<dim>
  {
  public:
    explicit Box(const BoxParameters &parameters)
      : parameters(parameters)
    {}

    std::set<std::string>
    whole_boundaries() const override;

    /// None.
    std::set<std::string>
    whole_regions() const override
    {
      return {};
    }

    double
    n_cells() const override;

    double
    n_vertices() const override;

    std::array<double, 3>
    extents() const override
    {
      return parameters.lengths;
    }

    bool
    has_coarse_levels() const override;

    PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// Half as many cells in the directions in which they are shortest: those
    /// of stretched cells get rounder first. Odd numbers are rounded up: a box
    /// of one cell is its own coarsest.
    std::unique_ptr<Body<dim>>
    coarser_whole() const override;

    LinearFields<dim>
    linear_fields() const override;

    /// Not where its cells would be longer than those of this one.
    std::unique_ptr<Body<dim>>
    coarser_level() const override;

    const BoxParameters parameters;
  };
} // namespace Debond

#endif
