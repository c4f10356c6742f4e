// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_mesh_body_h
#define debond_mesh_mesh_body_h

#include <debond/mesh/source_mesh.h>

#include <functional>

namespace Debond
{
  /// The body of a mesh that comes from elsewhere: triangles and tetrahedra are
  /// used as they are, quadrilaterals and hexahedra are halved in each
  /// direction as often as asked, and crossed.
  template <int dim>
  class MeshBody : public Body<dim>
  {
  public:
    /// Makes the mesh with its cells halved so many times.
    using Source = std::function<std::unique_ptr<const SourceMesh<dim>>(
      const unsigned int n_refinements)>;

    /// Throws what @p make throws.
    MeshBody(const Source &make, const unsigned int n_refinements);

    std::set<std::string>
    boundaries() const override;

    std::set<std::string>
    regions() const override;

    double
    n_cells() const override;

    double
    n_vertices() const override;

    double
    n_vertices_on(const std::string &boundary) const override;

    /// The box that encloses the body, and as many cells in it as there would
    /// be if it was filled as the body is.
    BodyShape
    shape() const override;

    PieceNames
    make_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// The one with a refinement less.
    std::unique_ptr<const Body<dim>>
    coarser() const override;

    /// Points beside the mesh, as on the curved side of a finer one, belong to
    /// a cell next to them.
    std::vector<dealii::Tensor<1, dim>>
    interpolate(const dealii::Triangulation<dim>          &mesh,
                const std::vector<dealii::Tensor<1, dim>> &values,
                const std::vector<dealii::Point<dim>> &points) const override;

  private:
    const Source                                 make;
    const unsigned int                           n_refinements;
    const std::unique_ptr<const SourceMesh<dim>> source;
    const bool                                   is_simplicial;
    std::map<std::string, double>                boundary_vertices;
  };
} // namespace Debond

#endif
