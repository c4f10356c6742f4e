// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_gmsh_file_h
#define debond_mesh_gmsh_file_h

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace Debond
{
  /// The contents of a mesh file as Gmsh understands them.
  struct GmshFile
  {
    /// The elements of one kind in one entity, with corners as tags of nodes.
    struct Elements
    {
      int                        dimension, entity, order, n_corners;
      std::vector<std::size_t>   tags, corners;
      std::map<int, std::string> groups; ///< names by number, if they have any
    };

    bool                     is_geometry = false; ///< meshed on the spot
    std::size_t              n_ghosts    = 0;     ///< of pieces of a partition
    std::vector<std::size_t> nodes;               ///< tags
    std::vector<double>      coordinates;         ///< three for each
    std::vector<Elements>    elements;
  };

  /// What Gmsh is told besides the file.
  struct MeshingOptions
  {
    double size   = 0.;   ///< of cells of a geometry; 0: what Gmsh finds good
    double memory = 1e12; ///< bytes that Gmsh may take

    /// Numbers by name, which DefineConstant of a .geo file takes.
    std::map<std::string, double> constants;
  };

  /**
   * Has Gmsh read a file in any of its formats, with elements of the dimension
   * @p dim and of one less, and mesh it if it is a geometry. Partitions are
   * joined. Throws std::invalid_argument with Gmsh's words, or if there is more
   * in the file than Gmsh understands.
   */
  GmshFile
  read_gmsh_file(const std::string    &file_name,
                 int                   dim,
                 const MeshingOptions &options);
} // namespace Debond

#endif
