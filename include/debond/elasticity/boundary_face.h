// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_boundary_face_h
#define debond_elasticity_boundary_face_h

#include <deal.II/dofs/dof_handler.h>

#include <debond/elasticity/boundary_conditions.h>
#include <debond/mesh/bernstein.h>
#include <debond/mesh/overlap.h>

namespace Debond
{
  /// A boundary face, with what the degrees of freedom know of it.
  template <int dim>
  struct BoundaryFace
  {
    static constexpr unsigned int maximum = n_coefficients(dim, 2);

    dealii::types::coarse_cell_id           cell; ///< in the order of all
    dealii::types::boundary_id              id;
    unsigned int                            n_nodes; ///< vertices come first
    std::array<unsigned int, maximum>       indices; ///< of nodes
    std::array<dealii::Point<dim>, maximum> positions;
    double                                  measure;
    dealii::Tensor<1, dim>                  normal; ///< outward unit normal

    /// The distance to the other side of an interface in the mesh.
    std::array<double, maximum> gaps = {};

    /// Whether a node has the jump of another one.
    std::array<bool, maximum> borrowed = {};

    /// This is for Boost's serialisation.
    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &cell &id &n_nodes &indices &positions &measure &normal;
    }
  };



  /// The faces of these boundaries, of all ranks and on each of them, in the
  /// order of the cells. To be called by all ranks. Throws
  /// std::invalid_argument if one of the boundaries is not in the mesh.
  template <int dim>
  std::vector<BoundaryFace<dim>>
  boundary_faces(const dealii::DoFHandler<dim>              &dofs,
                 const std::set<dealii::types::boundary_id> &boundaries,
                 const BoundaryNames                        &names);



  /// The faces without their edges.
  template <int dim>
  std::vector<Facet<dim>>
  facets_of(const std::vector<BoundaryFace<dim>> &faces);
} // namespace Debond

#endif
