// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_source_mesh_h
#define debond_mesh_source_mesh_h

#include <debond/mesh/body.h>
#include <debond/mesh/gmsh_file.h>

namespace Debond
{
  /// A mesh as a file or a generator makes it: of triangles (tetrahedra), or of
  /// quadrilaterals (hexahedra), which are to be crossed.
  template <int dim>
  struct SourceMesh
  {
    dealii::Triangulation<dim> mesh;
    PieceNames                 names;

    /// Halves the cells in each direction @p n_refinements times. Throws
    /// std::invalid_argument if they are triangles or tetrahedra.
    void
    refine(const unsigned int n_refinements);
  };

  /**
   * The mesh of a Gmsh file, see read_gmsh_file(), with its lengths multiplied
   * by @p scale; the @p options have lengths of the body. In 2D z must be the
   * same everywhere. Physical groups of faces are boundaries, those of cells
   * regions, by their names or, without one, by their numbers. Faces that
   * groups have inside the body belong to no boundary and have manifold ids.
   *
   * Throws std::invalid_argument with file and line if the mesh has cells of
   * several kinds or none, if a cell is flat or so distorted that its centre
   * does not see its faces, if cells overlap or hang together by less than a
   * face, or if a vertex lies on a face without being one of its own (a hanging
   * node).
   */
  template <int dim>
  std::unique_ptr<SourceMesh<dim>>
  read_gmsh_mesh(const std::string &file_name,
                 const double       scale,
                 MeshingOptions     options);

  /**
   * The mesh that deal.II's GridGenerator::generate_from_name_and_arguments()
   * makes, refined. The names of boundaries and regions are their numbers.
   * Throws std::invalid_argument with deal.II's words if it makes no mesh.
   */
  template <int dim>
  std::unique_ptr<SourceMesh<dim>>
  generate_mesh(const std::string &name,
                const std::string &arguments,
                const unsigned int n_refinements);
} // namespace Debond

#endif
