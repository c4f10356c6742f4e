// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_mesh_body_h
#define debond_mesh_mesh_body_h

#include <debond/mesh/source_mesh.h>

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
    using Source = std::function<std::unique_ptr<SourceMesh<dim>>(
      const unsigned int n_refinements)>;

    /// Throws what @p make throws.
    MeshBody(const Source &make, const unsigned int n_refinements);

    double
    n_cells() const override;

    PieceNames
    whole_names() const override
    {
      return source->names;
    }

    void
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// The one with a refinement less.
    std::unique_ptr<Body<dim>>
    coarser_whole() const override;

  private:
    Source       make;
    unsigned int n_refinements;

    /// Before it is halved.
    std::shared_ptr<const SourceMesh<dim>> source;
  };
} // namespace Debond

#endif
