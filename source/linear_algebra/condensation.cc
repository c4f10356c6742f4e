// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/lapack_templates.h>

#include <debond/base/memory.h>
#include <debond/linear_algebra/condensation.h>

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

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
      const int        n = static_cast<int>(matrix->nrow);
      std::vector<int> group(n, 0), permutation(n);
      // Numbers of groups are below n, which a single unknown has to heed.
      if (n > static_cast<int>(n_kept))
        std::fill(group.end() - n_kept, group.end(), 1);
      if (!cholmod_camd(
            matrix, nullptr, 0, group.data(), permutation.data(), &common))
        throw std::bad_alloc();
      // CAMD keeps the groups apart but not the order within the last one.
      for (unsigned int k = 0; k < n_kept; ++k)
        permutation[n - n_kept + k] = n - n_kept + k;

      common.nmethods           = 1;
      common.method[0].ordering = CHOLMOD_GIVEN;
      // A postordering is free to mix the kept unknowns with the others.
      common.postorder = 0;
      return Symbolic(
        cholmod_analyze_p(matrix, permutation.data(), nullptr, 0, &common),
        common);
    }
  } // namespace



  /// The factorisation P A P' = L L'.
  class Condensation::Factor
  {
  public:
    /// The diagonal entries of the kept unknowns are multiplied by @p
    /// diagonal_factor.
    Factor(const dealii::SparseMatrix<double> &A,
           const std::vector<unsigned int>    &unknowns,
           const unsigned int                  n_kept,
           const double                        diagonal_factor)
      : n(static_cast<int>(unknowns.size()))
      , n_kept(n_kept)
    {
      // CHOLMOD factorises nothing less.
      if (n > 0)
        factorize(A, unknowns, diagonal_factor);
    }

    /// Solves with one part of the factorisation, CHOLMOD_P, CHOLMOD_L, ...
    std::vector<double>
    solve(const int system, const std::vector<double> &right_side)
    {
      if (n == 0)
        return {};
      Dense b(cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &common), common);
      std::copy(right_side.begin(),
                right_side.end(),
                static_cast<double *>(b->x));
      const Dense   x(cholmod_solve(system, factor->get(), b.get(), &common),
                    common);
      const double *values = static_cast<const double *>(x->x);
      return std::vector<double>(values, values + n);
    }

    /// The trailing block L_ss of the factor, lower triangular.
    dealii::FullMatrix<double>
    trailing_block() const
    {
      dealii::FullMatrix<double> block(n_kept, n_kept);
      if (n_kept == 0)
        return block;
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

  private:
    void
    factorize(const dealii::SparseMatrix<double> &A,
              const std::vector<unsigned int>    &unknowns,
              const double                        diagonal_factor)
    {
      std::vector<int> position(A.m(), -1);
      for (int i = 0; i < n; ++i)
        position[unknowns[i]] = i;

      // The upper triangle by columns, which is the lower one by rows.
      std::size_t n_entries = 0;
      for (const unsigned int row : unknowns)
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
          for (auto entry = A.begin(unknowns[i]); entry != A.end(unknowns[i]);
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

      // What is more than that the system would end the program for.
      if (8. * static_cast<double>(L->xsize) > memory_left(0.))
        throw std::bad_alloc();
      cholmod_factorize(matrix.get(), L, &common);
      if (common.status == CHOLMOD_NOT_POSDEF)
        throw std::runtime_error(
          "Condensation: the elasticity matrix is not positive definite (row " +
          std::to_string(L->minor) + " of " + std::to_string(n) +
          "). Check the supports and the material.");
      if (common.status != CHOLMOD_OK)
        throw std::bad_alloc();
    }

    const int               n;
    const unsigned int      n_kept;
    Common                  common;
    std::optional<Symbolic> factor; ///< none without unknowns
  };



  FactorisationCost
  factorisation_cost(const dealii::SparseMatrix<double> &A,
                     const std::vector<unsigned int>    &kept,
                     const unsigned int                  n_components)
  {
    const unsigned int        n = A.m() / n_components;
    std::vector<unsigned int> order, position(n);
    std::vector<char>         is_kept(n, 0);
    for (const unsigned int i : kept)
      is_kept[i / n_components] = 1;
    for (const int last : {0, 1})
      for (unsigned int node = 0; node < n; ++node)
        if (is_kept[node] == last)
          {
            position[node] = static_cast<unsigned int>(order.size());
            order.push_back(node);
          }
    const unsigned int n_kept =
      static_cast<unsigned int>(std::count(is_kept.begin(), is_kept.end(), 1));

    // The upper triangle by columns. A row of a held unknown has only its
    // diagonal entry.
    std::vector<int>       starts = {0}, rows;
    std::set<unsigned int> column;
    for (const unsigned int node : order)
      {
        column.clear();
        for (unsigned int c = 0; c < n_components; ++c)
          for (auto entry = A.begin(node * n_components + c);
               entry != A.end(node * n_components + c);
               ++entry)
            if (const unsigned int row =
                  position[entry->column() / n_components];
                row <= position[node])
              column.insert(row);
        rows.insert(rows.end(), column.begin(), column.end());
        starts.push_back(static_cast<int>(rows.size()));
      }

    Common common;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    const Sparse graph(cholmod_allocate_sparse(
                         n, n, rows.size(), 1, 1, 1, CHOLMOD_PATTERN, &common),
                       common);
    std::copy(starts.begin(), starts.end(), static_cast<int *>(graph->p));
    std::copy(rows.begin(), rows.end(), static_cast<int *>(graph->i));
    analyse(graph.get(), n_kept, common);
    return {std::pow(n_components, 3) * common.fl,
            std::pow(n_components, 2) * common.lnz};
  }



  Condensation::Condensation(
    const dealii::SparseMatrix<double>      &A,
    const DofVector                         &f,
    const std::vector<unsigned int>         &kept,
    const std::function<bool(unsigned int)> &is_excluded,
    const OtherParts                        &others,
    const bool                               is_semidefinite)
    : n(f.size())
    , other_energy(others.energy)
  {
    std::vector<char> is_kept(n, 0);
    for (const unsigned int i : kept)
      is_kept[i] = 1;
    for (unsigned int i = 0; i < n; ++i)
      if (is_kept[i] == 0 && !is_excluded(i))
        unknowns.push_back(i);
    unknowns.insert(unknowns.end(), kept.begin(), kept.end());

    factor = std::make_unique<Factor>(A,
                                      unknowns,
                                      kept.size(),
                                      is_semidefinite ? 2. : 1.);

    given_y = forward(f);
    if (others.constant_load.size() > 0)
      constant_y = forward(others.constant_load);
    if (others.second_load.size() > 0)
      second_y = forward(others.second_load);

    L_ss = factor->trailing_block();
    S.reinit(kept.size(), kept.size());
    if (!kept.empty())
      L_ss.mTmult(S, L_ss);
    if (is_semidefinite)
      for (unsigned int i = 0; i < kept.size(); ++i)
        S(i, i) -= A.diag_element(kept[i]);
    scale_load(1.);
  }



  Condensation::~Condensation() = default;



  void
  Condensation::scale_load(const double factor, const double second)
  {
    constant_part = other_energy ? other_energy(factor, second) : 0.;
    y             = given_y;
    for (double &entry : y)
      entry *= factor;
    for (unsigned int i = 0; i < constant_y.size(); ++i)
      y[i] += (1. - factor) * constant_y[i];
    if (second != factor)
      for (unsigned int i = 0; i < second_y.size(); ++i)
        y[i] += (second - factor) * second_y[i];
    g = condensed_load(y);
  }



  MatrixView
  Condensation::schur_complement() const
  {
    // deal.II's matrices have contiguous rows, Eigen's contiguous columns,
    // which for a symmetric one is the same.
    return Eigen::Map<const Eigen::MatrixXd>(S.empty() ? nullptr : &S(0, 0),
                                             S.m(),
                                             S.n());
  }



  double
  Condensation::energy_at_zero() const
  {
    double c_0 = constant_part;
    for (std::size_t i = 0; i < y.size() - S.m(); ++i)
      c_0 -= 0.5 * y[i] * y[i];
    return c_0;
  }



  double
  Condensation::energy_without_contact() const
  {
    double sum = 0.;
    for (const double entry : y)
      sum += 0.5 * entry * entry;
    return sum;
  }



  double
  Condensation::energy_of_kept() const
  {
    double sum = 0.;
    for (std::size_t i = y.size() - S.m(); i < y.size(); ++i)
      sum += 0.5 * y[i] * y[i];
    return sum;
  }



  double
  Condensation::condition_estimate() const
  {
    const dealii::types::blas_int n_kept =
      static_cast<dealii::types::blas_int>(S.m());
    if (n_kept == 0)
      return 1.;
    const double                         norm = S.l1_norm();
    double                               reciprocal;
    std::vector<double>                  work(3 * n_kept);
    std::vector<dealii::types::blas_int> integers(n_kept);
    dealii::types::blas_int              info;
    // L_ss by rows is its transpose by columns, the upper factor.
    dealii::pocon("U",
                  &n_kept,
                  &L_ss(0, 0),
                  &n_kept,
                  &norm,
                  &reciprocal,
                  work.data(),
                  integers.data(),
                  &info);
    AssertThrow(info == 0, dealii::ExcInternalError());
    return 1. / reciprocal;
  }



  std::vector<double>
  Condensation::forward(const DofVector &f) const
  {
    std::vector<double> right_side(unknowns.size());
    for (unsigned int i = 0; i < unknowns.size(); ++i)
      right_side[i] = f(unknowns[i]);
    return factor->solve(CHOLMOD_L, factor->solve(CHOLMOD_P, right_side));
  }



  Eigen::VectorXd
  Condensation::condensed_load(const std::vector<double> &reduced) const
  {
    const unsigned int n_kept = static_cast<unsigned int>(L_ss.m());
    const unsigned int n_eliminated =
      static_cast<unsigned int>(unknowns.size()) - n_kept;
    Eigen::VectorXd result = Eigen::VectorXd::Zero(n_kept);
    for (unsigned int i = 0; i < n_kept; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        result(i) += L_ss(i, j) * reduced[n_eliminated + j];
    return result;
  }



  DofVector
  Condensation::backward(const std::vector<double> &reduced,
                         const VectorView          &s) const
  {
    const unsigned int n_eliminated =
      static_cast<unsigned int>(unknowns.size() - s.size());
    std::vector<double> x(unknowns.size());
    for (unsigned int i = 0; i < n_eliminated; ++i)
      x[i] = reduced[i];
    for (unsigned int j = 0; j < s.size(); ++j)
      {
        double sum = 0.;
        for (unsigned int i = j; i < s.size(); ++i)
          sum += L_ss(i, j) * s(i);
        x[n_eliminated + j] = sum;
      }
    x = factor->solve(CHOLMOD_Pt, factor->solve(CHOLMOD_Lt, x));

    DofVector u(n);
    for (unsigned int i = 0; i < n_eliminated; ++i)
      u(unknowns[i]) = x[i];
    for (unsigned int i = 0; i < s.size(); ++i)
      u(unknowns[n_eliminated + i]) = s(i);
    return u;
  }



  DofVector
  Condensation::solve(
    const DofVector &other_f,
    const std::function<Eigen::VectorXd(const Eigen::VectorXd &)>
      &kept_unknowns) const
  {
    const std::vector<double> reduced = forward(other_f);
    return backward(reduced, kept_unknowns(condensed_load(reduced)));
  }
} // namespace Debond
