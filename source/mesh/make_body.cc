// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/make_body.h>
#include <debond/mesh/mesh_body.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    std::shared_ptr<BodyDescription>
    make(const BodyParameters &parameters)
    {
      switch (parameters.source)
        {
          case BodyParameters::Source::file:
            {
              const std::shared_ptr<const SourceMesh<dim>> coarse =
                read_gmsh_mesh<dim>(parameters.file,
                                    parameters.scale,
                                    parameters.size);
              return std::make_shared<MeshBody<dim>>(
                [coarse](const unsigned int n_refinements) {
                  auto source = std::make_unique<SourceMesh<dim>>();
                  source->mesh.copy_triangulation(coarse->mesh);
                  source->names        = coarse->names;
                  source->inner_groups = coarse->inner_groups;
                  source->refine(n_refinements);
                  return source;
                },
                parameters.n_refinements);
            }
          case BodyParameters::Source::generator:
            // Made anew, as manifolds do not survive a copy.
            return std::make_shared<MeshBody<dim>>(
              [name = parameters.generator, arguments = parameters.arguments](
                const unsigned int n_refinements) {
                return generate_mesh<dim>(name, arguments, n_refinements);
              },
              parameters.n_refinements);
          default:
            return std::make_shared<Box<dim>>(parameters.box);
        }
    }
  } // namespace



  std::shared_ptr<BodyDescription>
  make_body(const unsigned int dimension, const BodyParameters &parameters)
  {
    return dimension == 2 ? make<2>(parameters) : make<3>(parameters);
  }
} // namespace Debond
