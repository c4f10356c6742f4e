// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/exceptions.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/linear_algebra/bordered_cholesky.h>

namespace Debond
{
  namespace
  {
    /// A border of more than this part of the factor costs as much as a new
    /// factor, at the rates of triangular solves and of factorisations.
    constexpr double largest_border = 0.2;

    using LapackInteger = dealii::types::blas_int;



    /// A'B by BLAS, see DenseCholesky.
    Eigen::MatrixXd
    product(const Eigen::MatrixXd &A, const Eigen::MatrixXd &B)
    {
      const auto m = static_cast<LapackInteger>(A.cols()),
                 n = static_cast<LapackInteger>(B.cols()),
                 k = static_cast<LapackInteger>(A.rows());
      Eigen::MatrixXd result(m, n);
      const double    one = 1., zero = 0.;
      if (m > 0 && n > 0)
        dealii::gemm("T",
                     "N",
                     &m,
                     &n,
                     &k,
                     &one,
                     A.data(),
                     &k,
                     B.data(),
                     &k,
                     &zero,
                     result.data(),
                     &m);
      return result;
    }
  } // namespace



  void
  BorderedCholesky::compare(const Matrix &M)
  {
    if (M.rows() != M_of_F.rows())
      {
        in_F.clear();
        return;
      }
    // Row i has changed if any of its entries differs from that of which the
    // factor was made. L^{-1} times the column of a row that has changed, now
    // or at the last comparison, is that of another column and is forgotten;
    // L^{-1} times a unit vector depends on L alone.
    std::vector<char> changes(has_changed.size(), 0);
    for (Eigen::Index j = 0; j < M.cols(); ++j)
      for (Eigen::Index i = j; i < M.rows(); ++i)
        if (M(i, j) != M_of_F(i, j))
          changes[i] = changes[j] = 1;
    for (std::size_t i = 0; i < changes.size(); ++i)
      if (changes[i] != 0 || has_changed[i] != 0)
        known_added.erase(static_cast<unsigned int>(i));
    has_changed = std::move(changes);
  }



  bool
  BorderedCholesky::restrict_to(const std::vector<unsigned int> &now_free,
                                const Matrix                    &M)
  {
    // The border is tried first. If it is too large or seems indefinite, a new
    // factor of M_ff decides, which starts with an empty border.
    free         = now_free;
    n_operations = 0.;
    if (make_border(M))
      return true;
    in_F = free;
    position.assign(M.rows(), -1);
    for (unsigned int k = 0; k < in_F.size(); ++k)
      position[in_F[k]] = static_cast<int>(k);
    L.resize(in_F.size(), in_F.size());
    for (unsigned int l = 0; l < in_F.size(); ++l)
      for (unsigned int k = l; k < in_F.size(); ++k)
        L(k, l) = M(in_F[k], in_F[l]);
    // M is kept as a whole, since compare() has to find out which of its rows
    // differ later, free or not.
    M_of_F = M;
    has_changed.assign(M.rows(), 0);
    for (auto *set : {&added, &removed})
      set->clear();
    for (auto *columns : {&known_added, &known_removed})
      columns->clear();
    const auto   n    = static_cast<LapackInteger>(in_F.size());
    const double size = static_cast<double>(in_F.size());
    n_operations += size * size * size / 3.;
    LapackInteger info = 0;
    if (n > 0)
      dealii::potrf("L", &n, L.data(), &n, &info);
    AssertThrow(info >= 0, dealii::ExcInternalError());
    if (info != 0)
      in_F.clear();
    return info == 0;
  }



  template <typename ColumnOf>
  Eigen::MatrixXd
  BorderedCholesky::border_columns(
    const std::vector<unsigned int>         &indices,
    const ColumnOf                          &column_of,
    std::map<unsigned int, Eigen::VectorXd> &known)
  {
    // Active sets change by a few indices at a time, so most columns of the
    // border have been there before. The others are solved for by one call,
    // whose triangular solves work on all of them at once: n^2 / 2
    // multiplications a column.
    std::vector<unsigned int> missing;
    for (const unsigned int i : indices)
      if (known.count(i) == 0)
        missing.push_back(i);
    if (!missing.empty())
      {
        Eigen::MatrixXd columns(L.rows(), missing.size());
        for (std::size_t c = 0; c < missing.size(); ++c)
          columns.col(c) = column_of(missing[c]);
        const auto n         = static_cast<LapackInteger>(L.rows()),
                   n_columns = static_cast<LapackInteger>(missing.size());
        LapackInteger info;
        dealii::trtrs("L",
                      "N",
                      "N",
                      &n,
                      &n_columns,
                      L.data(),
                      &n,
                      columns.data(),
                      &n,
                      &info);
        AssertThrow(info == 0, dealii::ExcInternalError());
        for (std::size_t c = 0; c < missing.size(); ++c)
          known[missing[c]] = columns.col(c);
        n_operations += 0.5 * double(n) * double(n) * double(n_columns);
      }
    Eigen::MatrixXd result(L.rows(), indices.size());
    for (std::size_t c = 0; c < indices.size(); ++c)
      result.col(c) = known.at(indices[c]);
    return result;
  }



  bool
  BorderedCholesky::make_border(const Matrix &M)
  {
    if (in_F.empty())
      return false;
    // An index of F whose row has changed is in both sets: its old row is
    // removed by a multiplier, and the new one added to the border.
    std::vector<char> is_free(M.rows(), 0);
    for (const unsigned int i : free)
      is_free[i] = 1;
    added.clear();
    removed.clear();
    // In the order of F and of the free indices, which solve_in_place() relies
    // on.
    for (const unsigned int i : in_F)
      if (is_free[i] == 0 || has_changed[i] != 0)
        removed.push_back(i);
    for (const unsigned int i : free)
      if (position[i] < 0 || has_changed[i] != 0)
        added.push_back(i);
    const double size   = static_cast<double>(in_F.size()),
                 border = static_cast<double>(added.size() + removed.size());
    if (border > largest_border * size)
      return false;

    // Sets that wander would keep the columns of all indices.
    for (auto *columns : {&known_added, &known_removed})
      if (double(columns->size()) > 2. * largest_border * size)
        columns->clear();
    // Rows of M_FN at indices that have left do not matter, as x is zero there.
    Y_N = border_columns(
      added,
      [&](const unsigned int i) {
        Eigen::VectorXd column(in_F.size());
        for (unsigned int k = 0; k < in_F.size(); ++k)
          column(k) = M(in_F[k], i);
        return column;
      },
      known_added);
    Y_R = border_columns(
      removed,
      [&](const unsigned int i) {
        return Eigen::VectorXd::Unit(in_F.size(), position[i]);
      },
      known_removed);
    n_operations += border * border * (0.5 * size + border / 3.);

    // Elimination of x_F and then of the multipliers leaves a system with P for
    // x_N alone. With W = I_R' M_FF^{-1} I_R = Y_R'Y_R and X = L_W^{-1} Y_R'Y_N
    //
    //     P = M_NN - Y_N'Y_N + X'X,
    //
    // where X'X takes back what the removed indices had given to Y_N'Y_N.
    of_W.compute(product(Y_R, Y_R));
    X = of_W.matrixL().solve(product(Y_R, Y_N));
    // M_ff is positive definite if and only if this Schur complement is.
    Eigen::MatrixXd P(added.size(), added.size());
    for (std::size_t l = 0; l < added.size(); ++l)
      for (std::size_t k = 0; k < added.size(); ++k)
        P(k, l) = M(added[k], added[l]);
    P += X.transpose() * X - product(Y_N, Y_N);
    of_P.compute(P);
    return of_W.info() == Eigen::Success && of_P.info() == Eigen::Success;
  }



  void
  BorderedCholesky::solve_in_place(Eigen::VectorXd &b) const
  {
    // With y = L^{-1} b_F, where b is zero at removed indices, and v = L_W^{-1}
    // Y_R'y,
    //
    //     x_N    = P^{-1} (b_N - Y_N'y + X'v),
    //     lambda = L_W^{-T} (v - X x_N),
    //     x_F    = L^{-T} (y - Y_N x_N - Y_R lambda).
    //
    // x_F is zero at removed indices but for rounding, and these entries are
    // not returned.
    const auto      lower = L.triangularView<Eigen::Lower>();
    Eigen::VectorXd y     = Eigen::VectorXd::Zero(L.rows()), b_N(added.size());
    const auto      is_added = [this](const unsigned int i) {
      return position[i] < 0 || has_changed[i] != 0;
    };
    Eigen::Index next = 0;
    for (unsigned int k = 0; k < free.size(); ++k)
      if (is_added(free[k]))
        b_N(next++) = b(k);
      else
        y(position[free[k]]) = b(k);
    lower.solveInPlace(y);
    if (has_border())
      {
        const Eigen::VectorXd v = of_W.matrixL().solve(Y_R.transpose() * y);
        b_N = of_P.solve(b_N - Y_N.transpose() * y + X.transpose() * v);
        y -= Y_N * b_N + Y_R * of_W.matrixU().solve(v - X * b_N);
      }
    lower.transpose().solveInPlace(y);
    next = 0;
    for (unsigned int k = 0; k < free.size(); ++k)
      b(k) = is_added(free[k]) ? b_N(next++) : y(position[free[k]]);
  }
} // namespace Debond
