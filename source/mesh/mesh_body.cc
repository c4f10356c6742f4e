// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/bounding_box.h>

#include <debond/mesh/crossed_mesh.h>
#include <debond/mesh/mesh_body.h>

#include <algorithm>
#include <cmath>
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
    std::unique_ptr<SourceMesh<dim>>  coarsest = make(0);
    const dealii::Triangulation<dim> &mesh     = coarsest->mesh;
    is_simplicial = mesh.all_reference_cells_are_simplex();
    unit_level =
      is_simplicial ?
        n_refinements :
        HalvedMesh<dim>::level_of_units(mesh.n_active_cells(), n_refinements);
    all                = {static_cast<double>(mesh.n_used_vertices()),
                          static_cast<double>(mesh.n_active_lines()),
                          static_cast<double>(dim == 2 ? mesh.n_active_cells() :
                                                         mesh.n_active_faces()),
                          static_cast<double>(dim == 2 ? 0 : mesh.n_active_cells())};
    this->inner_groups = coarsest->inner_groups;
    source = unit_level == 0 ? std::move(coarsest) : make(unit_level);
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
  BodyShape
  MeshBody<dim>::shape() const
  {
    const dealii::BoundingBox<dim> box(source->mesh.get_vertices());
    double                         measure = 0.;
    for (const auto &cell : source->mesh.active_cell_iterators())
      measure += cell->measure();
    const double edge =
      std::pow(measure / n_cells() * (dim == 2 ? 4. : 24.), 1. / dim);

    BodyShape shape = {};
    for (unsigned int d = 0; d < dim; ++d)
      {
        shape.lengths[d] = box.side_length(d);
        shape.cells[d]   = std::max(1., std::round(shape.lengths[d] / edge));
      }
    return shape;
  }



  template <int dim>
  PieceNames
  MeshBody<dim>::make_whole_mesh(dealii::Triangulation<dim> &mesh) const
  {
    if (is_simplicial)
      {
        mesh.copy_triangulation(source->mesh);
        // Sides are flat between the vertices, wherever they came from.
        mesh.reset_all_manifolds();
      }
    else if (unit_level == n_refinements)
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
  MeshBody<dim>::is_of_simplices() const
  {
    return is_simplicial;
  }



  template <int dim>
  bool
  MeshBody<dim>::has_coarse_levels() const
  {
    return n_coarse_levels() > 0;
  }



  template <int dim>
  unsigned int
  MeshBody<dim>::n_coarse_levels() const
  {
    // Some generators have halved cells already, maybe not all of them.
    const dealii::Triangulation<dim> &mesh = source->mesh;
    if (is_simplicial ||
        mesh.n_cells(mesh.n_levels() - 1) != mesh.n_active_cells())
      return 0;
    unsigned int level = n_refinements;
    while (level > 0 && n_vertices_of_level(level) >= fewest_vertices_of_level)
      --level;
    return n_vertices_of_level(level) > most_coarsest_vertices ?
             0 :
             n_refinements - level;
  }



  template <int dim>
  HalvedMesh<dim>
  MeshBody<dim>::halved(const unsigned int finest,
                        const unsigned int rank,
                        const unsigned int n_ranks) const
  {
    return HalvedMesh<dim>(make(unit_level),
                           unit_level,
                           std::max(unit_level, finest),
                           rank,
                           n_ranks);
  }



  template <int dim>
  std::vector<CoarseLevel<dim>>
  MeshBody<dim>::coarse_levels(const dealii::Triangulation<dim> &mesh,
                               const std::vector<unsigned int>  &vertices) const
  {
    if (!has_coarse_levels())
      return {};
    const HalvedMesh<dim>           cells  = halved(n_refinements);
    auto                            finest = cells.vertices(n_refinements);
    const std::vector<unsigned int> places = cells.places(mesh, finest);
    std::vector<unsigned int>       nodes(vertices.size());
    for (unsigned int i = 0; i < vertices.size(); ++i)
      nodes[places[vertices[i]]] = i;
    finest.renumber(nodes);
    return cells.coarse_levels(n_refinements, finest, n_coarse_levels());
  }



  template <int dim>
  std::vector<unsigned int>
  MeshBody<dim>::slabs(const dealii::Triangulation<dim> &mesh) const
  {
    if (!has_coarse_levels())
      return Body<dim>::slabs(mesh);
    // The first simplex that comes to a vertex is in its unit.
    const HalvedMesh<dim>     units = halved(unit_level);
    constexpr unsigned int    unset = dealii::numbers::invalid_unsigned_int;
    const unsigned int        n     = mesh.n_active_cells() / units.n_units();
    std::vector<unsigned int> result(mesh.n_vertices(), unset);
    for (const auto &cell : mesh.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (unsigned int &slab = result[cell->vertex_index(v)]; slab == unset)
          slab = units.slab_of_unit(cell->active_cell_index() / n);
    return result;
  }



  template <int dim>
  unsigned int
  MeshBody<dim>::finest_level() const
  {
    return n_refinements;
  }



  template <int dim>
  unsigned int
  MeshBody<dim>::level_of_units() const
  {
    return unit_level;
  }



  template <int dim>
  const PieceNames &
  MeshBody<dim>::names() const
  {
    return source->names;
  }



  template <int dim>
  std::map<dealii::types::boundary_id, unsigned int>
  MeshBody<dim>::n_faces() const
  {
    std::map<dealii::types::boundary_id, unsigned int> result;
    for (const auto &face : source->mesh.active_face_iterators())
      if (face->at_boundary())
        result[face->boundary_id()] +=
          (dim == 2 ? 1u : 4u) << (dim - 1) * (n_refinements - unit_level);
    return result;
  }



  template class MeshBody<2>;
  template class MeshBody<3>;
} // namespace Debond
