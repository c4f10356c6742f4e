// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/mesh_body.h>

#include <stdexcept>

namespace Debond
{
  namespace
  {
    template <typename Names>
    std::set<std::string>
    keys(const Names &names)
    {
      std::set<std::string> result;
      for (const auto &[name, unused] : names)
        result.insert(name);
      return result;
    }
  } // namespace



  template <int dim>
  typename MeshBody<dim>::Counts
  MeshBody<dim>::Counts::halved(const unsigned int times) const
  {
    Counts result = *this;
    for (unsigned int k = 0; k < times; ++k)
      {
        const Counts was = result;
        result.corners   = was.corners + was.edges + was.squares + was.cubes;
        result.edges     = 2. * was.edges + 4. * was.squares + 6. * was.cubes;
        result.squares   = 4. * was.squares + 12. * was.cubes;
        result.cubes     = 8. * was.cubes;
      }
    return result;
  }



  template <int dim>
  MeshBody<dim>::MeshBody(const Source &make, const unsigned int n_refinements)
    : make(make)
    , n_refinements(n_refinements)
  {
    source                                 = make(0);
    const dealii::Triangulation<dim> &mesh = source->mesh;
    is_simplicial      = mesh.all_reference_cells_are_simplex();
    all                = {static_cast<double>(mesh.n_used_vertices()),
                          static_cast<double>(mesh.n_active_lines()),
                          static_cast<double>(dim == 2 ? mesh.n_active_cells() :
                                                         mesh.n_active_faces()),
                          static_cast<double>(dim == 2 ? 0 : mesh.n_active_cells())};
    this->inner_groups = source->inner_groups;
    if (is_simplicial && n_refinements > 0)
      make(n_refinements); // says that they are not halved
  }



  template <int dim>
  std::set<std::string>
  MeshBody<dim>::whole_boundaries() const
  {
    return keys(source->names.boundaries);
  }



  template <int dim>
  std::set<std::string>
  MeshBody<dim>::whole_regions() const
  {
    return keys(source->names.regions);
  }



  template <int dim>
  double
  MeshBody<dim>::n_cells() const
  {
    if (is_simplicial)
      return source->mesh.n_active_cells();
    const Counts counts = all.halved(n_refinements);
    return dim == 2 ? 4. * counts.squares : 24. * counts.cubes;
  }



  template <int dim>
  double
  MeshBody<dim>::n_vertices_of_level(const unsigned int level) const
  {
    // Cells have a vertex in their centre, and hexahedra one on each face.
    const Counts counts = all.halved(level);
    return counts.corners + counts.squares + counts.cubes;
  }



  template <int dim>
  double
  MeshBody<dim>::n_vertices() const
  {
    return is_simplicial ? all.corners : n_vertices_of_level(n_refinements);
  }



  template <int dim>
  std::array<double, 3>
  MeshBody<dim>::extents() const
  {
    const dealii::BoundingBox<dim> box(source->mesh.get_vertices());
    std::array<double, 3>          result = {};
    for (unsigned int d = 0; d < dim; ++d)
      result[d] = box.side_length(d);
    return result;
  }



  template <int dim>
  PieceNames
  MeshBody<dim>::make_whole_mesh(dealii::Triangulation<dim> &mesh) const
  {
    if (is_simplicial)
      {
        mesh.copy_triangulation(source->mesh);
        // Sides are flat between the vertices, wherever they came from.
        mesh.set_all_manifold_ids(dealii::numbers::flat_manifold_id);
      }
    else if (n_refinements == 0)
      crossed_subdivision(source->mesh, mesh);
    else
      crossed_subdivision(make(n_refinements)->mesh, mesh);
    return source->names;
  }



  template <int dim>
  std::unique_ptr<Body<dim>>
  MeshBody<dim>::coarser_whole() const
  {
    return n_refinements > 0 ?
             std::make_unique<MeshBody>(make, n_refinements - 1) :
             nullptr;
  }



  template <int dim>
  bool
  MeshBody<dim>::has_coarse_levels() const
  {
    // Some generators have halved cells already, maybe not all of them.
    const dealii::Triangulation<dim> &mesh = source->mesh;
    if (is_simplicial || !this->cuts.empty() ||
        mesh.n_cells(mesh.n_levels() - 1) != mesh.n_active_cells())
      return false;
    unsigned int level = n_refinements;
    while (level > 0 && n_vertices_of_level(level) >= fewest_vertices_of_level)
      --level;
    return level < n_refinements &&
           n_vertices_of_level(level) <= most_coarsest_vertices;
  }



  template class MeshBody<2>;
  template class MeshBody<3>;
} // namespace Debond
