// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_make_body_h
#define debond_mesh_make_body_h

#include <debond/mesh/box.h>
#include <debond/mesh/gmsh_file.h>

namespace Debond
{
  /// The entries of a scene on its body.
  struct BodyParameters
  {
    enum class Source
    {
      box,
      file,
      generator
    };

    Source        source = Source::box;
    BoxParameters box;
    std::string   file;              ///< that Gmsh reads
    double        scale = 1.;        ///< of the lengths in the file
    std::string   generator;         ///< a function of dealii::GridGenerator
    std::string   arguments;         ///< of that function
    unsigned int  n_refinements = 0; ///< unless it is a box
    std::string   cuts;              ///< "y = 2, core | ring"
    std::string   interfaces;        ///< "glue: plate | rib_foot, ..."

    MeshingOptions meshing; ///< of the file
  };

  /// The body that the parameters describe. Throws std::invalid_argument if
  /// there is no such function or file, or no body in it.
  template <int dim>
  std::shared_ptr<Body<dim>>
  make_body(const BodyParameters &parameters);
} // namespace Debond

#endif
