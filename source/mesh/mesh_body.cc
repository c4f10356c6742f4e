// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/mesh_body.h>

#include <cmath>

namespace Debond
{
  template <int dim>
  MeshBody<dim>::MeshBody(const Source &make, const unsigned int n_refinements)
    : make(make)
    , n_refinements(n_refinements)
    , source(make(0))
  {
    // The source without refinements is kept, for its names, the number of its
    // cells and its kind of cells. A refinement of simplices throws at once,
    // before anything else is made of the body.
    for (const auto &[name, unused] : source->names.inner_groups)
      this->inner_groups.insert(name);
    if (source->mesh.all_reference_cells_are_simplex() && n_refinements > 0)
      make(n_refinements); // says that they are not halved
  }



  template <int dim>
  double
  MeshBody<dim>::n_cells() const
  {
    // The number follows without the refined mesh, in floating point: what a
    // user asks for may exceed any integer, and is refused by this number then.
    const double n = source->mesh.n_active_cells();
    return source->mesh.all_reference_cells_are_simplex() ?
             n :
             (dim == 2 ? 4. : 24.) * n * std::pow(1 << dim, n_refinements);
  }



  template <int dim>
  void
  MeshBody<dim>::make_whole_mesh(dealii::Triangulation<dim> &mesh) const
  {
    if (source->mesh.all_reference_cells_are_simplex())
      mesh.copy_triangulation(source->mesh);
    else
      crossed_subdivision(n_refinements == 0 ? source->mesh :
                                               make(n_refinements)->mesh)
        .make_mesh(mesh);
    // All sides are flat between the vertices, wherever these came from: the
    // elements are affine, and no point may be moved to a curve afterwards. A
    // cut finds the faces of a group by their manifold ids and makes a mesh
    // without them.
    if (this->cuts.empty())
      mesh.set_all_manifold_ids(dealii::numbers::flat_manifold_id);
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  MeshBody<dim>::coarser_whole() const
  {
    if (n_refinements == 0)
      return nullptr;
    // The copy shares the source. Parts have to be named anew on the coarser
    // mesh, which Body::coarser() does.
    auto coarser = std::make_unique<MeshBody>(*this);
    --coarser->n_refinements;
    coarser->parts.clear();
    return coarser;
  }



  DEBOND_INSTANTIATE_CLASS(MeshBody);
} // namespace Debond
