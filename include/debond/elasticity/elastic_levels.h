// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_elasticity_elastic_levels_h
#define debond_elasticity_elastic_levels_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/lac/vector.h>

#include <debond/elasticity/elastic_problem.h>
#include <debond/elasticity/problem_piece.h>
#include <debond/linear_algebra/multigrid/truncated_cycle.h>
#include <debond/mesh/body.h>

#include <Eigen/SparseCore>

#include <map>
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

    /// For the problem on a piece of the body. To be called by all ranks, and
    /// so are the functions below for the level 0 and prolongate() from the
    /// level 1; of the coarser levels only the root knows. Keeps references.
    static std::unique_ptr<ElasticLevels<dim>>
    make(const ProblemPiece<dim> &piece, const ElasticProblem<dim> &problem);

    /// Whether the process has the coarser levels.
    bool
    is_root() const;

    unsigned int
    n_levels() const;

    unsigned int
    n_unknowns(const unsigned int l) const;

    TruncatedCycle<dim> &
    cycle();

    /// The unknowns s_l, dealii::numbers::invalid_unsigned_int for those that
    /// other ranks have.
    const std::vector<unsigned int> &
    normals(const unsigned int l) const;

    /// P_l.
    const Eigen::SparseMatrix<double> &
    trace_prolongation(const unsigned int l) const;

    const dealii::Vector<double> &
    load(const unsigned int l) const;

    /// dst = A_l src.
    void
    vmult(const unsigned int            l,
          dealii::Vector<double>       &dst,
          const dealii::Vector<double> &src) const;

    /// The entries of all s_l.
    dealii::Vector<double>
    trace(const unsigned int l, const dealii::Vector<double> &v) const;

    /// <a, b>.
    double
    product(const unsigned int            l,
            const dealii::Vector<double> &a,
            const dealii::Vector<double> &b) const;

    /// The rows and columns s_l of A_l; the column j has the row's entries.
    Eigen::SparseMatrix<double>
    contact_rows(const unsigned int l) const;

    /// Makes the entries that other ranks have the same as there.
    void
    update_ghosts(const unsigned int l, dealii::Vector<double> &v) const;

    /// v += factor times the column of A_l.
    void
    add_column(const unsigned int      l,
               const unsigned int      column,
               const double            factor,
               dealii::Vector<double> &v) const;

    double
    diagonal_entry(const unsigned int l, const unsigned int i) const;

    /// The vertices of the mesh of a level l > 0.
    const std::vector<dealii::Point<dim>> &
    vertices(const unsigned int l) const;

    /// The unknowns of the level l > 0 for the displacements at its vertices.
    dealii::Vector<double>
    from_vertex_displacements(
      const unsigned int                         l,
      const std::vector<dealii::Tensor<1, dim>> &displacements) const;

    /// The same field on the next finer level.
    dealii::Vector<double>
    prolongate(const unsigned int l, const dealii::Vector<double> &u) const;

  private:
    /// @p piece and @p root are null unless ranks share the problem.
    ElasticLevels(const ElasticProblem<dim>      &problem,
                  std::unique_ptr<SharedNodes>    whole,
                  const ProblemPiece<dim>        *piece,
                  std::unique_ptr<RootLevel<dim>> root,
                  std::vector<CoarseLevel<dim>> &&coarse);

    /// The level 1 where ranks share the finest one.
    void
    add_shared_level();

    /// The unknowns s_l; returns the index of each of the finer ones.
    std::map<unsigned int, unsigned int>
    add_normals(const unsigned int               l,
                const std::vector<unsigned int> &fine_normals);

    /// P_l, from the entries of the step from the next finer level.
    void
    add_trace(const unsigned int                         l,
              const std::vector<Eigen::Triplet<double>> &entries);

    /// Calls @p visit with column and entry of a row of A_l.
    template <typename Visitor>
    void
    visit_row(const unsigned int l,
              const unsigned int row,
              const Visitor     &visit) const;

    struct Level
    {
      std::vector<dealii::Point<dim>> vertices;
      std::vector<unsigned int>       normals;
      Eigen::SparseMatrix<double>     trace_prolongation;
      dealii::Vector<double>          load;
    };

    const ElasticProblem<dim>            &problem;
    const std::unique_ptr<SharedNodes>    whole; ///< if no ranks share it
    const ProblemPiece<dim> *const        piece;
    const std::unique_ptr<RootLevel<dim>> root;
    const SharedNodes                    &nodes;
    std::vector<Level>                    levels;
    std::unique_ptr<TruncatedCycle<dim>>  truncated_cycle;
  };
} // namespace Debond

#endif
