// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/memory.h>
#include <debond/linear_algebra/cholmod_factor.h>

#include <cholmod.h>

#include <cmath>
#include <new>
#include <optional>
#include <set>

namespace Debond
{
  namespace
  {
    /// CHOLMOD's workspace. It prints nothing: errors are thrown.
    struct Common : cholmod_common
    {
      Common()
      {
        cholmod_start(this);
        print         = 0;
        error_handler = nullptr;
      }

      ~Common()
      {
        cholmod_finish(this);
      }

      Common(const Common &) = delete;
    };



    /// Frees an object of CHOLMOD, which takes a pointer to the pointer and the
    /// workspace in which it has been allocated.
    template <typename Object, int (*release)(Object **, cholmod_common *)>
    struct Release
    {
      cholmod_common *common;

      void
      operator()(Object *object) const
      {
        release(&object, common);
      }
    };

    /// A CHOLMOD object that frees itself. Throws std::bad_alloc if it is null.
    template <typename Object, int (*release)(Object **, cholmod_common *)>
    class Owned : public std::unique_ptr<Object, Release<Object, release>>
    {
    public:
      Owned(Object *object, cholmod_common &common)
        : std::unique_ptr<Object, Release<Object, release>>(object, {&common})
      {
        if (object == nullptr)
          throw std::bad_alloc();
      }
    };

    using Dense    = Owned<cholmod_dense, cholmod_free_dense>;
    using Sparse   = Owned<cholmod_sparse, cholmod_free_sparse>;
    using Symbolic = Owned<cholmod_factor, cholmod_free_factor>;



    /// The symbolic factorisation of the symmetric matrix with the last
    /// @p n_kept unknowns last, the others by minimum degree.
    Symbolic
    analyse(cholmod_sparse    *matrix,
            const unsigned int n_kept,
            cholmod_common    &common)
    {
      // CAMD is minimum degree with constraints: unknowns of the first group
      // are eliminated before those of the second. Fill-in among the kept
      // unknowns is what it is, since their trailing block is S and dense in
      // any order.
      const int        n = static_cast<int>(matrix->nrow);
      std::vector<int> group(n, 0), permutation(n);
      // Numbers of groups are below n, which a single unknown has to heed.
      if (n > static_cast<int>(n_kept))
        std::fill(group.end() - n_kept, group.end(), 1);
      if (!cholmod_camd(
            matrix, nullptr, 0, group.data(), permutation.data(), &common))
        throw std::bad_alloc();
      // CAMD keeps the groups apart but not the order within the last one. They
      // are put back into their own order, so that S has its rows and columns
      // as the caller numbers them.
      for (unsigned int k = 0; k < n_kept; ++k)
        permutation[n - n_kept + k] = n - n_kept + k;

      common.nmethods           = 1;
      common.method[0].ordering = CHOLMOD_GIVEN;
      // A postordering is free to mix the kept unknowns with the others.
      // Without it the permutation of the factor is the given one.
      common.postorder = 0;
      return Symbolic(
        cholmod_analyze_p(matrix, permutation.data(), nullptr, 0, &common),
        common);
    }



    class CholmodFactor : public EliminationFactor
    {
    public:
      CholmodFactor(const dealii::SparseMatrix<double> &A,
                    const Elimination                  &elimination)
        : elimination(elimination)
        , n(static_cast<int>(elimination.unknowns.size()))
        , n_kept(elimination.n_kept)
        , n_rows(A.m())
      {
        // CHOLMOD factorises no empty matrix. If A is semidefinite the diagonal
        // of A_ss is added to A first, which makes it definite if no rigid
        // motion is zero on all of s. Eliminated unknowns do not see what is
        // added to A_ss, so that the Schur complement becomes S_+ = S + D and D
        // is subtracted again.
        if (n > 0)
          factorize(A, elimination.is_semidefinite ? 2. : 1.);
        L_ss = trailing_block();
        S.reinit(n_kept, n_kept);
        if (n_kept > 0)
          L_ss.mTmult(S, L_ss);
        if (elimination.is_semidefinite)
          for (unsigned int i = 0; i < n_kept; ++i)
            S(i, i) -= A.diag_element(elimination.unknowns[n - n_kept + i]);
      }

      /// Keeps y = L^{-1} P f.
      ReducedLoad
      reduce(const DofVector &f) const override
      {
        // With y = L^{-1} P f the energy 1/2 u'A u - f'u of eliminated unknowns
        // at equilibrium with s = 0 is -1/2 |y_i|^2. As S_+ = L_ss L_ss' and g
        // = L_ss y_s, 1/2 |y_s|^2 is 1/2 g'S_+^{-1} g, without another
        // solution.
        Eigen::VectorXd right_side(n);
        for (int i = 0; i < n; ++i)
          right_side(i) = f(elimination.unknowns[i]);
        const Eigen::VectorXd y =
          solve(CHOLMOD_L, solve(CHOLMOD_P, right_side));
        return {y,
                factor_of_kept().triangularView<Eigen::Lower>() *
                  y.tail(n_kept),
                -0.5 * y.head(n - n_kept).squaredNorm(),
                0.5 * y.tail(n_kept).squaredNorm()};
      }

      DofVector
      expand(const ReducedLoad &load, const VectorView &s) const override
      {
        // The last rows of L'x = y read L_ss'x_s = y_s. With L_ss's in place of
        // y_s the back substitution finds x_s = s, and x_i at equilibrium with
        // it. s is then copied, so that rounding does not change it.
        Eigen::VectorXd x = load.own;
        x.tail(n_kept) =
          factor_of_kept().transpose().triangularView<Eigen::Upper>() * s;
        x              = solve(CHOLMOD_Pt, solve(CHOLMOD_Lt, x));
        x.tail(n_kept) = s;

        DofVector u(n_rows);
        for (int i = 0; i < n; ++i)
          u(elimination.unknowns[i]) = x(i);
        return u;
      }

    private:
      /// Solves with one part of the factorisation, CHOLMOD_P, CHOLMOD_L, ...
      Eigen::VectorXd
      solve(const int system, const Eigen::VectorXd &right_side) const
      {
        if (n == 0)
          return right_side;
        const Dense b(cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &common),
                      common);
        std::copy(right_side.begin(),
                  right_side.end(),
                  static_cast<double *>(b->x));
        const Dense x(cholmod_solve(system, factor->get(), b.get(), &common),
                      common);
        return Eigen::Map<const Eigen::VectorXd>(
          static_cast<const double *>(x->x), n);
      }

      /// The trailing block L_ss of the factor, lower triangular.
      dealii::FullMatrix<double>
      trailing_block() const
      {
        dealii::FullMatrix<double> block(n_kept, n_kept);
        if (n_kept == 0)
          return block;
        // A supernode of CHOLMOD is a range of columns with the same rows
        // below: super has the first column of each, pi the first of its row
        // numbers in s, px the first of its values in x, a dense block by
        // columns. The first rows of the block are those of its own columns, so
        // that row r of column c is in the lower triangle for r >= c. A
        // supernode may begin before the kept unknowns and extend into them.
        const int             first = n - n_kept;
        const cholmod_factor *L     = factor->get();
        const int            *super = static_cast<const int *>(L->super);
        const int            *pi    = static_cast<const int *>(L->pi);
        const int            *px    = static_cast<const int *>(L->px);
        const int            *rows  = static_cast<const int *>(L->s);
        const double         *x     = static_cast<const double *>(L->x);
        for (int k = 0; k < static_cast<int>(L->nsuper); ++k)
          {
            const int n_rows = pi[k + 1] - pi[k];
            for (int column = std::max(super[k], first); column < super[k + 1];
                 ++column)
              {
                const double *values = x + px[k] + (column - super[k]) * n_rows;
                for (int r = column - super[k]; r < n_rows; ++r)
                  block(rows[pi[k] + r] - first, column - first) = values[r];
              }
          }
        return block;
      }

      void
      factorize(const dealii::SparseMatrix<double> &A,
                const double                        diagonal_factor)
      {
        // A without the rows and columns that are left out, in the order of the
        // elimination. Entries are counted first, as CHOLMOD's arrays do not
        // grow.
        const std::vector<int> position = elimination.positions(A.m());

        // The upper triangle by columns, which is the lower one by rows.
        std::size_t n_entries = 0;
        for (const unsigned int row : elimination.unknowns)
          for (auto entry = A.begin(row); entry != A.end(row); ++entry)
            n_entries += position[entry->column()] >= 0 &&
                         position[entry->column()] <= position[row];
        const Sparse matrix(cholmod_allocate_sparse(
                              n, n, n_entries, 0, 1, 1, CHOLMOD_REAL, &common),
                            common);
        int         *starts = static_cast<int *>(matrix->p);
        int         *rows   = static_cast<int *>(matrix->i);
        double      *values = static_cast<double *>(matrix->x);
        std::size_t  next   = 0;
        for (int i = 0; i < n; ++i)
          {
            starts[i] = static_cast<int>(next);
            for (auto entry = A.begin(elimination.unknowns[i]);
                 entry != A.end(elimination.unknowns[i]);
                 ++entry)
              if (const int j = position[entry->column()]; j >= 0 && j <= i)
                {
                  const bool is_scaled =
                    j == i && i >= n - static_cast<int>(n_kept);
                  rows[next] = j;
                  values[next++] =
                    (is_scaled ? diagonal_factor : 1.) * entry->value();
                }
          }
        starts[n] = static_cast<int>(next);

        // Supernodes give S by dense kernels, and final_ll keeps the factor as
        // LL', of which trailing_block() reads the last columns.
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.final_ll   = 1;
        factor.emplace(analyse(matrix.get(), n_kept, common));
        cholmod_factor *const L = factor->get();
        for (unsigned int k = 0; k < n_kept; ++k)
          if (static_cast<const int *>(L->Perm)[n - n_kept + k] !=
              static_cast<int>(n - n_kept + k))
            throw std::runtime_error(
              "Condensation: the ordering did not keep the "
              "contact normals last.");

        // What is more than that the system would end the program for. Linux
        // grants an allocation before there is memory for it, so that it would
        // not fail here.
        if (8. * static_cast<double>(L->xsize) > memory_left(0.))
          throw std::bad_alloc();
        cholmod_factorize(matrix.get(), L, &common);
        if (common.status == CHOLMOD_NOT_POSDEF)
          throw IndefiniteMatrix("row " + std::to_string(L->minor) + " of " +
                                 std::to_string(n));
        if (common.status != CHOLMOD_OK)
          throw std::bad_alloc();
      }

      const Elimination       elimination;
      const int               n;
      const unsigned int      n_kept;
      const unsigned int      n_rows; ///< of A
      mutable Common          common;
      std::optional<Symbolic> factor; ///< none without unknowns
    };



    /// The number of nodes, the entries of their graph in the upper triangle
    /// with the kept nodes last, and how many nodes are kept.
    struct NodeGraph
    {
      unsigned int     n;
      unsigned int     n_kept;
      std::vector<int> rows;
      std::vector<int> columns;
    };



    /// The graph by the own rows of A. A row of a held unknown has only its
    /// diagonal entry.
    NodeGraph
    own_graph(const MatrixOnRanks             &matrix,
              const std::vector<unsigned int> &kept,
              const unsigned int               n_components)
    {
      // The graph has a node of the mesh for each of its unknowns together,
      // which makes it n_components^2 times smaller than that of A. Each rank
      // adds the columns of its own nodes, with the upper triangle alone. A
      // node is kept with all its unknowns if one of them is.
      const unsigned int n = matrix.A.m() / n_components;
      std::vector<char>  is_kept(n, 0);
      for (const unsigned int i : kept)
        is_kept[i / n_components] = 1;
      const unsigned int n_kept = static_cast<unsigned int>(
        std::count(is_kept.begin(), is_kept.end(), 1));
      NodeGraph graph{n, n_kept, {}, {}};

      // In each group, the eliminated and the kept nodes, the order is that of
      // the mesh.
      std::vector<int> position(n);
      int              next[2] = {0, static_cast<int>(n - n_kept)};
      for (unsigned int node = 0; node < n; ++node)
        position[node] = next[static_cast<int>(is_kept[node])]++;

      // The rows of a node's unknowns have the same neighbours, unless one is
      // held. The set joins them.
      std::set<int> column;
      for (unsigned int node = 0; node < n; ++node)
        {
          if (!matrix.own_rows.is_element(node * n_components))
            continue;
          column.clear();
          for (unsigned int c = 0; c < n_components; ++c)
            for (auto entry = matrix.A.begin(node * n_components + c);
                 entry != matrix.A.end(node * n_components + c);
                 ++entry)
              if (const int row = position[entry->column() / n_components];
                  row <= position[node])
                column.insert(row);
          graph.rows.insert(graph.rows.end(), column.begin(), column.end());
          graph.columns.resize(graph.rows.size(), position[node]);
        }
      return graph;
    }



    /// Throws std::bad_alloc.
    FactorisationCost
    cost_of(NodeGraph graph, const unsigned int n_components)
    {
      // The work and the entries of a factor of the graph, times those of dense
      // blocks: n_components^3 and n_components^2. The analysis alone is made,
      // for which a simplicial one is enough; it has no values.
      Common common;
      common.supernodal       = CHOLMOD_SIMPLICIAL;
      cholmod_triplet entries = {};
      entries.nrow = entries.ncol = graph.n;
      entries.nzmax = entries.nnz = graph.rows.size();
      entries.i                   = graph.rows.data();
      entries.j                   = graph.columns.data();
      entries.stype               = 1;
      entries.itype               = CHOLMOD_INT;
      entries.xtype               = CHOLMOD_PATTERN;
      const Sparse matrix(cholmod_triplet_to_sparse(&entries, 0, &common),
                          common);
      analyse(matrix.get(), graph.n_kept, common);
      return {std::pow(n_components, 3) * common.fl,
              std::pow(n_components, 2) * common.lnz};
    }



    /// Appends the numbers of all others to those of the first rank.
    void
    append_from_others(const MPI_Comm ranks, std::vector<int> &numbers)
    {
      const auto all = dealii::Utilities::MPI::gather(ranks, numbers);
      for (unsigned int rank = 1; rank < all.size(); ++rank)
        numbers.insert(numbers.end(), all[rank].begin(), all[rank].end());
    }
  } // namespace



  std::unique_ptr<EliminationFactor>
  make_cholmod_factor(const dealii::SparseMatrix<double> &A,
                      const Elimination                  &elimination)
  {
    return std::make_unique<CholmodFactor>(A, elimination);
  }



  FactorisationCost
  factorisation_cost(const MatrixOnRanks             &matrix,
                     const std::vector<unsigned int> &kept,
                     const unsigned int               n_components)
  {
    NodeGraph graph = own_graph(matrix, kept, n_components);
    if (!matrix.is_shared())
      return cost_of(std::move(graph), n_components);

    // The first rank analyses the entries of all, while the others wait for its
    // result. An exception on it alone would leave them waiting for ever, so
    // that a lack of memory becomes a number that all of them get.
    append_from_others(matrix.ranks, graph.rows);
    append_from_others(matrix.ranks, graph.columns);
    // Less than nothing says that memory was short.
    FactorisationCost cost = {-1., -1.};
    if (rank_of_this(matrix.ranks) == 0)
      try
        {
          cost = cost_of(std::move(graph), n_components);
        }
      catch (const std::bad_alloc &)
        {}
    cost = dealii::Utilities::MPI::broadcast(matrix.ranks, cost);
    if (cost.entries < 0.)
      throw std::bad_alloc();
    return cost;
  }
} // namespace Debond
