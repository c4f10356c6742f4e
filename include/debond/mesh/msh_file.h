// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_msh_file_h
#define debond_mesh_msh_file_h

#include <array>
#include <istream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Debond
{
  /// The contents of a Gmsh file of version 2.2 or 4.1 in ASCII: vertices, and
  /// elements with the physical groups they are in.
  struct MshFile
  {
    /// Gmsh's numbers of the kinds of elements.
    enum ElementType
    {
      line          = 1,
      triangle      = 2,
      quadrilateral = 3,
      tetrahedron   = 4,
      hexahedron    = 5,
      prism         = 6,
      pyramid       = 7,
      point         = 15
    };

    struct Element
    {
      unsigned int              line; ///< of the file
      ElementType               type;
      std::vector<unsigned int> vertices; ///< indices, in Gmsh's order
      std::set<int>             groups;
    };

    std::vector<std::array<double, 3>> vertices;
    std::vector<Element>               elements;

    /// By dimension and number of the group.
    std::map<std::pair<int, int>, std::string> names;
  };

  /**
   * Reads such a file; @p name stands in messages. Throws
   * std::invalid_argument, with "NAME:LINE: " in front, if the file is no such
   * file, is binary or partitioned, has elements of higher order, or ends too
   * early.
   */
  MshFile
  read_msh(std::istream &input, const std::string &name);
} // namespace Debond

#endif
