// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_box_h
#define debond_mesh_box_h

#include <debond/mesh/body.h>
#include <debond/mesh/crossed_mesh.h>

namespace Debond
{
  /// The body (0, L_1) x (0, L_2) [x (0, L_3)], moved to begin at `origin` and
  /// then turned about zero.
  struct BoxParameters
  {
    std::array<double, 3>       lengths  = {{0.4, 0.04, 0.04}};
    std::array<unsigned int, 3> cells    = {{40, 4, 4}};
    double                      rotation = 0.; ///< degrees, in the x-y plane
    std::array<double, 3>       origin   = {{0., 0., 0.}};
  };



  /// The sides of the (unturned) box by name: left and right are the smallest
  /// and largest x, bottom and top y, back and front z (3D only).
  template <int dim>
  std::map<std::string, dealii::types::boundary_id>
  box_sides();

  /// The rotation by an angle in degrees in the x-y plane.
  template <int dim>
  dealii::Tensor<2, dim>
  rotation_matrix(const double degrees);

  /// The crossed mesh of a part of a box, of the cells from @p begin on, so
  /// many in each direction; simplices and vertices are to the last bit those
  /// of the whole. The faces around the part have the boundary ids that the
  /// sides of a box have. Throws std::invalid_argument if a length is not
  /// positive or there are no cells in a direction.
  template <int dim>
  MeshData<dim>
  part_of_box(const BoxParameters               &box,
              const std::array<unsigned int, 3> &begin,
              const std::array<unsigned int, 3> &n_cells);

  /// The crossed mesh of all of it.
  template <int dim>
  void
  make_box(const BoxParameters &box, dealii::Triangulation<dim> &mesh)
  {
    part_of_box<dim>(box, {}, box.cells).make_mesh(mesh);
  }



  /// A box with its crossed mesh.
  template <int dim>
  class Box : public Body<dim>
  {
  public:
    explicit Box(const BoxParameters &parameters)
      : parameters(parameters)
    {}

    double
    n_cells() const override
    {
      const auto &n = parameters.cells;
      return dim == 2 ? 4. * n[0] * n[1] : 24. * n[0] * n[1] * n[2];
    }

    PieceNames
    whole_names() const override
    {
      PieceNames names;
      for (const auto &[side, id] : box_sides<dim>())
        names.boundaries[side] = {id};
      return names;
    }

    void
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override
    {
      make_box(parameters, mesh);
    }

    /// Half as many cells in the directions in which they are shortest: those
    /// of stretched cells get rounder first. Odd numbers are rounded up: a box
    /// of one cell is its own coarsest.
    std::unique_ptr<Body<dim>>
    coarser_whole() const override;

    LinearFields<dim>
    linear_fields() const override;

    /// Null also where its cells would be longer than those of this one.
    std::unique_ptr<Body<dim>>
    coarser_level() const override;

    const BoxParameters parameters;
  };
} // namespace Debond

#endif
