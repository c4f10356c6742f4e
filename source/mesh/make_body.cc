// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_tools.h>

#include <debond/base/instantiate.h>
#include <debond/mesh/make_body.h>
#include <debond/mesh/mesh_body.h>

namespace Debond
{
  template <int dim>
  std::shared_ptr<Body<dim>>
  make_body(const BodyParameters &parameters)
  {
    using Source = BodyParameters::Source;
    if (parameters.source == Source::box)
      return std::make_shared<Box<dim>>(parameters.box);

    // A file is read once, and each mesh is a copy of what was read. The mesh
    // of a generator is made anew instead, as the manifolds of curved sides do
    // not survive a copy.
    std::shared_ptr<const SourceMesh<dim>> file;
    if (parameters.source == Source::file)
      file = read_gmsh_mesh<dim>(parameters.file,
                                 parameters.scale,
                                 parameters.meshing);
    // The body calls this for its own mesh and again, with fewer refinements,
    // for coarser ones. So the function holds what it needs by value.
    const auto make = [file, parameters](const unsigned int n_refinements) {
      auto source = std::make_unique<SourceMesh<dim>>();
      if (file)
        {
          source->mesh.copy_triangulation(file->mesh);
          source->names = file->names;
          source->refine(n_refinements);
        }
      else
        source = generate_mesh<dim>(parameters.generator,
                                    parameters.arguments,
                                    n_refinements);
      // The rotation comes last: manifolds have placed the vertices of refined
      // cells before it.
      if (parameters.box.rotation != 0.)
        dealii::GridTools::transform(
          [rotation = rotation_matrix<dim>(parameters.box.rotation)](
            const dealii::Point<dim> &point) {
            return dealii::Point<dim>(rotation * point);
          },
          source->mesh);
      return source;
    };
    return std::make_shared<MeshBody<dim>>(make, parameters.n_refinements);
  }



  DEBOND_INSTANTIATE(make_body);
} // namespace Debond
