// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_body_h
#define debond_mesh_body_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace Debond
{
  using BoundaryNames = std::map<std::string, dealii::types::boundary_id>;

  /// The name of a boundary for messages, "boundary 7" if it has none.
  std::string
  boundary_name(const BoundaryNames             &names,
                const dealii::types::boundary_id id);



  /// A box of about the body's extents and number of cells, for estimates. In
  /// 2D the third entries are zero.
  struct BodyShape
  {
    std::array<double, 3> lengths;
    std::array<double, 3> cells; ///< before they are cut into simplices
  };



  /**
   * A body: what is known of its mesh without building it, the mesh, coarser
   * meshes of the same body and the way between them. Numbers of cells and
   * vertices are double, as what a user writes may exceed an integer.
   */
  template <int dim>
  class Body
  {
  public:
    virtual ~Body() = default;

    /// The pieces of the boundary that a scene can name, with their ids in the
    /// mesh.
    virtual const BoundaryNames &
    boundaries() const = 0;

    /// Triangles or tetrahedra.
    virtual double
    n_cells() const = 0;

    virtual double
    n_vertices() const = 0;

    /// Of one of boundaries().
    virtual double
    n_vertices_on(const dealii::types::boundary_id boundary) const = 0;

    virtual BodyShape
    shape() const = 0;

    /// Fills an empty triangulation. Throws std::invalid_argument if the body
    /// is none.
    virtual void
    make_mesh(dealii::Triangulation<dim> &mesh) const = 0;

    /// The same body with about half as many cells in each direction, null if
    /// there is none.
    virtual std::unique_ptr<const Body>
    coarser() const = 0;

    /// The P1 field with @p values at the vertices of @p mesh, which is the one
    /// of make_mesh(), at points of the body.
    virtual std::vector<dealii::Tensor<1, dim>>
    interpolate(const dealii::Triangulation<dim>          &mesh,
                const std::vector<dealii::Tensor<1, dim>> &values,
                const std::vector<dealii::Point<dim>>     &points) const = 0;
  };
} // namespace Debond

#endif
