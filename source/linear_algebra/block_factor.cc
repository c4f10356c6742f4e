// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/array_view.h>
#include <deal.II/lac/lapack_templates.h>

#include <debond/linear_algebra/block_factor.h>

namespace Debond
{
  BlockFactor::BlockFactor(const MatrixOnRanks &matrix,
                           const Elimination   &elimination)
    : elimination(elimination)
    , ranks(matrix.ranks)
    , is_first(rank_of_this(ranks) == 0)
    , n_rows(matrix.A.m())
    , n_eliminated(elimination.n_eliminated())
    , n_kept(elimination.n_kept)
  {
    // A_is has the rows of eliminated unknowns that this rank owns, and zeros
    // in all others, so that products with A_is or its transpose are parts,
    // which sum() adds up over the ranks.
    S.reinit(n_kept, n_kept);
    const std::vector<int> position = elimination.positions(n_rows);
    std::vector<Eigen::Triplet<double>> couplings;
    for (const auto row : matrix.own_rows)
      if (const int i = position[row];
          i >= 0 && i < static_cast<int>(n_eliminated))
        for (auto entry = matrix.A.begin(row); entry != matrix.A.end(row);
             ++entry)
          if (const int k =
                position[entry->column()] - static_cast<int>(n_eliminated);
              k >= 0)
            couplings.emplace_back(i, k, entry->value());
    A_is.resize(n_eliminated, n_kept);
    A_is.setFromTriplets(couplings.begin(), couplings.end());
  }



  void
  BlockFactor::finish(const MatrixOnRanks &matrix)
  {
    // S is dense and whole on each rank, since all that is nonsmooth works on
    // it everywhere. Only the first rank is sure to have it yet. That rank also
    // makes the factor and hands it out, so that all have the same bits of both
    // and take the same decisions.
    for (unsigned int i = 0; i < n_kept; ++i)
      for (unsigned int j = 0; j < i; ++j)
        S(j, i) = S(i, j);
    const auto broadcast = [this](dealii::FullMatrix<double> &whole) {
      if (!whole.empty())
        dealii::Utilities::MPI::broadcast(&whole(0, 0),
                                          whole.n_elements(),
                                          0,
                                          ranks);
    };
    broadcast(S);

    // Of a semidefinite A, S_+ = S + diag(A_ss) is factorised. Each diagonal
    // entry is known to the owner of its row.
    L_ss                     = S;
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n_kept);
    for (unsigned int k = 0; k < n_kept; ++k)
      if (const unsigned int row = elimination.unknowns[n_eliminated + k];
          elimination.is_semidefinite && matrix.own_rows.is_element(row))
        diagonal(k) = matrix.A.diag_element(row);
    sum(diagonal);
    for (unsigned int k = 0; k < n_kept; ++k)
      L_ss(k, k) += diagonal(k);

    dealii::types::blas_int info = 0;
    if (is_first && n_kept > 0)
      {
        const auto n = static_cast<dealii::types::blas_int>(n_kept);
        // The upper triangle by columns is the lower one by rows.
        dealii::potrf("U", &n, &L_ss(0, 0), &n, &info);
      }
    info = dealii::Utilities::MPI::broadcast(ranks, info);
    if (info != 0)
      throw IndefiniteMatrix("kept unknown " + std::to_string(info) + " of " +
                             std::to_string(n_kept));
    broadcast(L_ss);
  }



  void
  BlockFactor::sum(Eigen::VectorXd &values) const
  {
    const dealii::ArrayView<double> view(values.data(), values.size());
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view),
                                ranks,
                                view);
  }



  ReducedLoad
  BlockFactor::reduce(const DofVector &f) const
  {
    // With x = A_ii^{-1} f_i the eliminated unknowns are at equilibrium for s =
    // 0: the energy is c_0 = -1/2 f_i'x, and the kept unknowns see the load g =
    // f_s - A_si x. The own part of the load is f_i itself, since expand()
    // solves anew.
    Eigen::VectorXd f_i(n_eliminated);
    for (unsigned int i = 0; i < n_eliminated; ++i)
      f_i(i) = f(elimination.unknowns[i]);
    // All ranks have the same f and get the same x; only the product with A_si
    // is in parts.
    const Eigen::VectorXd x = solve(f_i);
    Eigen::VectorXd       g = -(A_is.transpose() * x);
    sum(g);
    for (unsigned int k = 0; k < n_kept; ++k)
      g(k) += f(elimination.unknowns[n_eliminated + k]);
    return {
      f_i,
      g,
      -0.5 * f_i.dot(x),
      0.5 *
        factor_of_kept().triangularView<Eigen::Lower>().solve(g).squaredNorm()};
  }



  DofVector
  BlockFactor::expand(const ReducedLoad &load, const VectorView &s) const
  {
    // u_i = A_ii^{-1} (f_i - A_is s): a given s acts on the others through the
    // couplings, whose products the ranks have in parts.
    Eigen::VectorXd force = A_is * s;
    sum(force);
    Eigen::VectorXd x(n_eliminated + n_kept);
    x << solve(load.own - force), s;

    DofVector u(n_rows);
    for (unsigned int i = 0; i < x.size(); ++i)
      u(elimination.unknowns[i]) = x(i);
    return u;
  }
} // namespace Debond
