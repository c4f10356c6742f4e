// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_mesh_piece_h
#define debond_mesh_mesh_piece_h

#include <deal.II/base/mpi.h>

#include <debond/mesh/body_piece.h>
#include <debond/mesh/mesh_body.h>

namespace Debond
{
  /// The part that one of several ranks has of a mesh that is halved and
  /// crossed (HalvedMesh), with three layers of ghosts, two on coarser levels.
  /// All ranks have the mesh of the units.
  template <int dim>
  class MeshPiece : public BodyPiece<dim>
  {
  public:
    using typename BodyPiece<dim>::CoarsePiece;
    using typename BodyPiece<dim>::CoarseWhole;

    /// To be called by all ranks. Throws std::invalid_argument on all of them
    /// if there are more of them than slabs. The body has coarse levels.
    MeshPiece(const std::shared_ptr<const MeshBody<dim>> &body,
              const MPI_Comm                              ranks);

    /// Faces between the piece and what is not there have an id without a name.
    PieceNames
    make_whole_mesh(dealii::Triangulation<dim> &mesh) const override;

    std::vector<unsigned int>
    slabs(const dealii::Triangulation<dim> &mesh) const override;

    std::map<dealii::types::boundary_id, unsigned int>
    n_faces() const override;

    std::vector<unsigned int>
    numbers(const dealii::Triangulation<dim> &mesh) const override;

    std::size_t
    cell_number(const unsigned int active_cell) const override;

    bool
    owns_cell(const unsigned int active_cell) const override;

    unsigned int
    n_shared_levels() const override;

    std::vector<CoarsePiece>
    coarse_pieces(const dealii::Triangulation<dim> &mesh,
                  const std::vector<unsigned int>  &vertices,
                  const unsigned int                n) const override;

    CoarseWhole
    coarse_whole(const unsigned int n) const override;

  private:
    using Vertices = typename HalvedMesh<dim>::Vertices;

    MeshPiece(const std::shared_ptr<const MeshBody<dim>> &body,
              const MPI_Comm                              ranks,
              HalvedMesh<dim>                           &&cells);

    /// In the whole level, by asking those who own the vertices.
    std::vector<unsigned int>
    numbers_of(const Vertices &vertices) const;

    const std::shared_ptr<const MeshBody<dim>>  body;
    const MPI_Comm                              ranks;
    const HalvedMesh<dim>                       halved;
    std::vector<typename HalvedMesh<dim>::Cell> cells;
    Vertices                                    finest;
    std::vector<unsigned int>                   finest_numbers;
  };
} // namespace Debond

#endif
