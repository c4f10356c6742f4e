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
    using Source = std::function<std::unique_ptr<SourceMesh<dim>>(
      const unsigned int n_refinements)>;

    /// Throws what @p make throws.
    MeshBody(const Source &make, const unsigned int n_refinements);

    std::set<std::string>
    whole_boundaries() const override;

    std::set<std::string>
    whole_regions() const override;

    double
    n_cells() const override;

    double
    n_vertices() const override;

    std::array<double, 3>
    extents() const override;

    /// If quadrilaterals or hexahedra are halved, from a mesh that is coarse
    /// enough.
    bool
    has_coarse_levels() const override;

    PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// The one with a refinement less.
    std::unique_ptr<Body<dim>>
    coarser_whole() const override;

  private:
    const Source       make;
    const unsigned int n_refinements;

    bool is_simplicial = false;

    /// Returns the number of vertices of the crossed mesh.
    double
    n_vertices_of_level(const unsigned int level) const;

    /// Corners, edges, faces (of hexahedra) and cells of a part of the mesh.
    struct Counts
    {
      double corners = 0., edges = 0., squares = 0., cubes = 0.;

      /// After all of it is halved.
      Counts
      halved(const unsigned int times) const;
    };

    Counts all; ///< of the mesh before it is halved

    /// Before it is halved: all that there is beforehand.
    std::unique_ptr<const SourceMesh<dim>> source;
  };
} // namespace Debond

#endif
