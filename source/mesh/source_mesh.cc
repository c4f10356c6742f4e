// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/source_mesh.h>

#include <stdexcept>

namespace Debond
{
  template <int dim>
  void
  SourceMesh<dim>::refine(const unsigned int n_refinements)
  {
    if (n_refinements == 0)
      return;
    if (mesh.all_reference_cells_are_simplex())
      throw std::invalid_argument(
        "A mesh of triangles or tetrahedra is not refined, but one of "
        "quadrilaterals or hexahedra.");
    mesh.refine_global(n_refinements);
  }



  template struct SourceMesh<2>;
  template struct SourceMesh<3>;
} // namespace Debond
