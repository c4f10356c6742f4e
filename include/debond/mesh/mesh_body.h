// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_mesh_body_h
#define debond_mesh_mesh_body_h

#include <debond/mesh/halved_mesh.h>

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

    /// The box that encloses the body, measured on a mesh of some hundred
    /// cells, and as many cells in it as there would be if it was filled as the
    /// body is.
    BodyShape
    shape() const override;

    /// If quadrilaterals or hexahedra are halved, from a mesh that is coarse
    /// enough.
    bool
    has_coarse_levels() const override;

    PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    /// The one with a refinement less.
    std::unique_ptr<Body<dim>>
    coarser_whole() const override;

    std::vector<CoarseLevel<dim>>
    coarse_levels(const dealii::Triangulation<dim> &mesh,
                  const std::vector<unsigned int>  &vertices) const override;

    /// Those of units (HalvedMesh).
    std::vector<unsigned int>
    slabs(const dealii::Triangulation<dim> &mesh) const override;

    /// Of triangles or tetrahedra from the start.
    bool
    is_of_simplices() const;

    /// How many coarse_levels() there are.
    unsigned int
    n_coarse_levels() const;

    /// The cells before they are crossed, or what a rank needs of them, at most
    /// halved to the level @p finest and at least to that of the units.
    HalvedMesh<dim>
    halved(const unsigned int finest,
           const unsigned int rank    = 0,
           const unsigned int n_ranks = 1) const;

    unsigned int
    finest_level() const;

    unsigned int
    level_of_units() const;

    /// Of the crossed mesh.
    double
    n_vertices_of_level(const unsigned int level) const;

    /// The names of the whole mesh, and of each id the number of its faces,
    /// crossed.
    const PieceNames &
    names() const;

    std::map<dealii::types::boundary_id, unsigned int>
    n_faces() const;

  private:
    const Source       make;
    const unsigned int n_refinements;

    /// Of the mesh before it is halved.
    bool         is_simplicial = false;
    unsigned int unit_level    = 0;

    /// Corners, edges, faces (of hexahedra) and cells of a part of the mesh.
    struct Counts
    {
      double corners = 0., edges = 0., squares = 0., cubes = 0.;

      /// After all of it is halved.
      Counts
      halved(const unsigned int times) const;
    };

    Counts all;

    /// The mesh of the units' level: all that there is beforehand.
    std::unique_ptr<const SourceMesh<dim>> source;
  };
} // namespace Debond

#endif
