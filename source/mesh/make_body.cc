// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/grid/grid_tools.h>

#include <debond/mesh/make_body.h>
#include <debond/mesh/mesh_body.h>

namespace Debond
{
  namespace
  {
    template <int dim>
    void
    rotate(const double degrees, dealii::Triangulation<dim> &mesh)
    {
      if (degrees == 0.)
        return;
      const auto rotation = rotation_matrix<dim>(degrees);
      dealii::GridTools::transform(
        [&rotation](const dealii::Point<dim> &point) {
          return dealii::Point<dim>(rotation * point);
        },
        mesh);
    }



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
                                    parameters.size,
                                    parameters.memory);
              return std::make_shared<MeshBody<dim>>(
                [coarse, degrees = parameters.box.rotation](
                  const unsigned int n_refinements) {
                  auto source = std::make_unique<SourceMesh<dim>>();
                  source->mesh.copy_triangulation(coarse->mesh);
                  source->names        = coarse->names;
                  source->inner_groups = coarse->inner_groups;
                  source->refine(n_refinements);
                  rotate(degrees, source->mesh);
                  return source;
                },
                parameters.n_refinements);
            }
          case BodyParameters::Source::generator:
            // Made anew, as manifolds do not survive a copy.
            return std::make_shared<MeshBody<dim>>(
              [name      = parameters.generator,
               arguments = parameters.arguments,
               degrees =
                 parameters.box.rotation](const unsigned int n_refinements) {
                auto source =
                  generate_mesh<dim>(name, arguments, n_refinements);
                rotate(degrees, source->mesh);
                return source;
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
