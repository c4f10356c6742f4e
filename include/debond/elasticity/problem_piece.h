// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_problem_piece_h
#define debond_elasticity_problem_piece_h

#include <deal.II/base/mpi.h>

#include <debond/contact/boundary.h>
#include <debond/elasticity/fields.h>
#include <debond/elasticity/unknowns.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/linear_algebra/multigrid/shared_nodes.h>
#include <debond/linear_algebra/multigrid/shared_trace.h>
#include <debond/mesh/body_piece.h>

#include <memory>
#include <vector>

namespace Debond
{
  /// The vertices of the mesh that the nodes (of degree 1) are, by number.
  template <int dim>
  std::vector<unsigned int>
  node_vertices(const ElasticUnknowns<dim> &unknowns);



  /// For each vertex of the mesh of a piece its place in the order of the
  /// numbers in the whole.
  template <int dim>
  std::vector<unsigned int>
  node_order(const BodyPiece<dim>             &piece,
             const dealii::Triangulation<dim> &mesh);



  /**
   * What a rank knows besides its piece of a body: who has which nodes, and the
   * contact boundary of the whole body, which all ranks have. Vectors of a rank
   * have the entries of its unknowns, and right ones at ghosts.
   */
  template <int dim>
  class ProblemPiece
  {
  public:
    /// To be called by all ranks, and so are the functions below that gather.
    /// The order of the unknowns has to be that of node_order(). Supports must
    /// have no displacements or gaps other than zero.
    ProblemPiece(const BodyPiece<dim>       &piece,
                 const ElasticUnknowns<dim> &unknowns,
                 const MPI_Comm              communicator);

    ProblemPiece(const ProblemPiece &) = delete;

    const BodyPiece<dim> &
    body() const
    {
      return piece;
    }

    const SharedNodes &
    nodes() const
    {
      return shared_nodes;
    }

    /// Of the whole body, as on one rank.
    const ContactBoundary<dim> &
    boundary() const
    {
      return contact_boundary;
    }

    /// The rank's unknowns of the contact nodes,
    /// dealii::numbers::invalid_unsigned_int for those that it does not have.
    const std::vector<unsigned int> &
    normals() const
    {
      return local_normals;
    }

    /// The same in the whole.
    const std::vector<unsigned int> &
    normal_numbers() const
    {
      return numbers_of_normals;
    }

    /// The entries of all contact nodes, on all ranks.
    Eigen::VectorXd
    trace(const DofVector &v) const
    {
      return (*shared_trace)(v);
    }

    /// The entries of all unknowns in the order of their numbers, on the root;
    /// empty elsewhere.
    DofVector
    gather(const DofVector &v) const;

    /// A number for each active cell of the piece gives those of all cells in
    /// the order of the whole mesh, on the root; empty elsewhere.
    std::vector<double>
    gather_cells(const std::vector<double> &values) const;

    /// ElasticFields::elastic_functional() of the whole, on the root; zero
    /// elsewhere.
    double
    elastic_functional(const ElasticFields<dim> &fields,
                       const DofVector          &u) const;

  private:
    /// What the root gathers: how much of each rank, one after the other, and
    /// the place of each entry in the whole. Both are empty elsewhere.
    struct Gathering
    {
      std::vector<int>          counts, starts;
      std::vector<unsigned int> places;
    };

    /// From the keys of a rank's entries, by which the whole is ordered.
    template <typename Key>
    Gathering
    make_gathering(const std::vector<Key> &own_keys) const;

    /// @p own has @p n_components for each entry, and so has the result.
    std::vector<double>
    gather(const Gathering           &gathering,
           const unsigned int         n_components,
           const std::vector<double> &own) const;

    void
    prepare_gathering(const dealii::DoFHandler<dim> &dofs);

    const BodyPiece<dim>     &piece;
    SharedNodes               shared_nodes;
    ContactBoundary<dim>      contact_boundary;
    std::vector<unsigned int> local_normals, numbers_of_normals;

    std::unique_ptr<SharedTrace> shared_trace;

    std::vector<unsigned int> own_cells; ///< their active indices
    Gathering                 all_nodes, all_cells;
  };
} // namespace Debond

#endif
