// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_elastic_levels_h
#define debond_elasticity_elastic_levels_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/problem_piece.h>
#include <debond/linear_algebra/dof_vector.h>
#include <debond/linear_algebra/multigrid/shared_trace.h>
#include <debond/linear_algebra/multigrid/truncated_cycle.h>
#include <debond/mesh/body.h>

#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace Debond
{
  /**
   * An elastic problem on the coarser meshes of its body, without building
   * them: A, f and the normal displacements s of the contact nodes on the
   * subspaces of P1 fields of coarser meshes, with the supports and frames of
   * the finest one. Level 0 is the problem itself.
   *
   * Each level minimises J over a subspace: s = P_l s_l with entries of P_l >=
   * 0 where sides are flat.
   */
  template <int dim>
  class ElasticLevels
  {
  public:
    /// Null if the body has no coarser levels. Keeps a reference to the
    /// problem, whose storage has to be serial.
    static std::unique_ptr<ElasticLevels>
    make(const Body<dim> &body, const ElasticProblem<dim> &problem);

    /// For the problem on a piece of the body. Ranks share at most the levels
    /// below @p end_shared > 0, and the first one, the root, has the others. To
    /// be called by all ranks, and so are the functions below for the shared
    /// levels, and prolongate() to them. Keeps references.
    static std::unique_ptr<ElasticLevels<dim>>
    make(const ProblemPiece<dim>   &piece,
         const ElasticProblem<dim> &problem,
         const unsigned int         end_shared);

    /// Whether the process has the levels that are not shared.
    bool
    is_root() const
    {
      return !root || root->is_root();
    }

    /// Those that the process has.
    unsigned int
    n_levels() const;

    /// Zero on one process that does not share the problem.
    unsigned int
    n_shared_levels() const
    {
      return truncated_cycle->n_shared_levels();
    }

    /// Those that the process has.
    unsigned int
    n_unknowns(const unsigned int l) const;

    /// Of the whole level.
    unsigned int
    n_whole_unknowns(const unsigned int l) const
    {
      return levels[l].n_whole_unknowns;
    }

    TruncatedCycle<dim> &
    cycle()
    {
      return *truncated_cycle;
    }

    /// The unknowns s_l, dealii::numbers::invalid_unsigned_int for those that
    /// other ranks have.
    const std::vector<unsigned int> &
    normals(const unsigned int l) const
    {
      return levels[l].normals;
    }

    /// P_l.
    const Eigen::SparseMatrix<double> &
    trace_prolongation(const unsigned int l) const
    {
      return levels[l].trace_prolongation;
    }

    const DofVector &
    load(const unsigned int l) const
    {
      return l == 0 && !root ? problem.load() : levels[l].load;
    }

    /// dst = A_l src.
    void
    vmult(const unsigned int l, DofVector &dst, const DofVector &src) const;

    /// The entries of all s_l.
    Eigen::VectorXd
    trace(const unsigned int l, const DofVector &v) const;

    /// <a, b>.
    double
    product(const unsigned int l, const DofVector &a, const DofVector &b) const
    {
      return levels[l].nodes->product(a.begin(), b.begin());
    }

    /// The rows and columns s_l of A_l; the column j has the row's entries.
    Eigen::SparseMatrix<double>
    contact_rows(const unsigned int l) const;

    /// Makes the entries that other ranks have the same as there.
    void
    update_ghosts(const unsigned int l, DofVector &v) const
    {
      levels[l].nodes->update_ghosts(v.begin());
    }

    /// v += factor times the column of A_l.
    void
    add_column(const unsigned int l,
               const unsigned int column,
               const double       factor,
               DofVector         &v) const;

    double
    diagonal_entry(const unsigned int l, const unsigned int i) const;

    /// The vertices of the mesh of a level l > 0.
    const std::vector<dealii::Point<dim>> &
    vertices(const unsigned int l) const
    {
      return levels[l].vertices;
    }

    /// The unknowns of the level l > 0 for the displacements at its vertices.
    DofVector
    from_vertex_displacements(
      const unsigned int                         l,
      const std::vector<dealii::Tensor<1, dim>> &displacements) const;

    /// The same field on the next finer level.
    DofVector
    prolongate(const unsigned int l, const DofVector &u) const;

  private:
    struct Level
    {
      std::unique_ptr<SharedNodes>    own_nodes; ///< but for those of a piece
      const SharedNodes              *nodes = nullptr;
      std::vector<dealii::Point<dim>> vertices;
      std::vector<unsigned int>       normals;
      Eigen::SparseMatrix<double>     trace_prolongation;
      DofVector                       load;
      unsigned int                    n_whole_unknowns = 0;
      std::unique_ptr<SharedTrace>    trace; ///< if ranks share the level
    };

    /// @p levels have their nodes and vertices, @p piece and @p root are null
    /// unless ranks share the problem.
    ElasticLevels(const ElasticProblem<dim>      &problem,
                  const ProblemPiece<dim>        *piece,
                  std::unique_ptr<RootLevel<dim>> root,
                  std::vector<Level>            &&levels,
                  std::vector<Interpolation>    &&interpolations);

    /// The unknowns s_l and P_l of the level l > 0 from the numbers of those of
    /// the next finer one in the whole; returns its own numbers.
    std::vector<unsigned int>
    add_trace(const unsigned int               l,
              const std::vector<unsigned int> &fine_numbers);

    /// From places (row and column of each) and values; if ranks share the
    /// level l, from those of all of them.
    Eigen::SparseMatrix<double>
    gathered_matrix(const unsigned int               l,
                    const std::vector<unsigned int> &places,
                    const std::vector<double>       &values,
                    const unsigned int               n_rows,
                    const unsigned int               n_columns) const;

    bool
    is_shared(const unsigned int l) const
    {
      return l < levels.size() && !levels[l].nodes->is_whole();
    }

    /// Calls @p visit with column and entry of a row of A_l.
    template <typename Visitor>
    void
    visit_row(const unsigned int l,
              const unsigned int row,
              const Visitor     &visit) const;

    const ElasticProblem<dim>            &problem;
    const ProblemPiece<dim> *const        piece;
    const std::unique_ptr<RootLevel<dim>> root;
    std::vector<Level>                    levels;
    std::unique_ptr<TruncatedCycle<dim>>  truncated_cycle;
  };
} // namespace Debond

#endif
