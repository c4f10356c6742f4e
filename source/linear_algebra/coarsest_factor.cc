// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>

#include <debond/linear_algebra/coarsest_factor.h>
#include <debond/linear_algebra/multigrid_level.h>

#include <algorithm>
#include <stdexcept>

namespace Debond
{
  CoarsestFactor::CoarsestFactor(const NumberedRows &rows,
                                 const bool          may_be_singular,
                                 const MPI_Comm      ranks)
    : larger_diagonal(may_be_singular ? 1. + Tolerance::regular_diagonal : 1.)
    , ranks(ranks)
    , matrix(
        gather(rows,
               dealii::Utilities::MPI::sum(rows.n_rows(), ranks) * rows.width))
  {
    // Changes by truncation stay within the pattern, so that it is analysed
    // once.
    solver.analyzePattern(matrix);
  }



  void
  CoarsestFactor::factorise(const NumberedRows &change)
  {
    // All ranks gather the few rows that change and factorise the same matrix.
    // It begins with the unchanged one each time, so that changes do not
    // accumulate, and they are within its pattern, so that coeffRef() inserts
    // nothing.
    Eigen::SparseMatrix<double>       now     = matrix;
    const Eigen::SparseMatrix<double> changes = gather(change, matrix.cols());
    // Entries of which rounding alone remains become zero, by the same rule as
    // on the other levels.
    for (int j = 0; j < changes.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(changes, j); entry;
           ++entry)
        {
          double &value = now.coeffRef(entry.row(), j);
          value         = changed(value, entry.value(), entry.row() == j);
        }
    // Truncation leaves the modes of an aggregate dependent if few of its
    // unknowns are free, and the matrix singular. In a preconditioner a
    // slightly larger diagonal only bounds the size of corrections along such
    // modes. A matrix that is no coarse one is factorised as it is.
    now.diagonal() *= larger_diagonal;
    solver.factorize(now);
    if (solver.info() != Eigen::Success)
      throw std::runtime_error(
        "multigrid: the matrix of the coarsest level is singular; try "
        "Solver/Linear solver = direct");
  }



  void
  CoarsestFactor::solve(SinglePrecisionVector       &x,
                        const SinglePrecisionVector &b) const
  {
    // Each rank puts its own forces in their places; the sum over the ranks
    // gives all of them to each rank, which solves for all unknowns and keeps
    // its own, so that nothing has to be sent back.
    Eigen::VectorXd   all   = Eigen::VectorXd::Zero(matrix.cols());
    const std::size_t begin = b.get_partitioner()->local_range().first;
    const std::size_t n     = b.locally_owned_size();
    std::copy_n(b.begin(), n, all.data() + begin);
    const dealii::ArrayView<double> view(all.data(), all.size());
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view),
                                ranks,
                                view);
    all = solver.solve(all).eval();
    std::copy_n(all.data() + begin, n, x.begin());
  }



  Eigen::SparseMatrix<double>
  CoarsestFactor::gather(const NumberedRows &own, const Eigen::Index n) const
  {
    // Blocks become entries of a matrix of single unknowns. Each row comes from
    // one rank, so that no entry occurs twice.
    std::vector<Eigen::Triplet<double>> entries;
    for (const NumberedRows &M : dealii::Utilities::MPI::all_gather(ranks, own))
      for (unsigned int r = 0; r < M.n_rows(); ++r)
        for (auto k = M.starts[r]; k < M.starts[r + 1]; ++k)
          for (unsigned int e = 0; e < M.n_entries_of_block(); ++e)
            entries.emplace_back(M.rows[r] * M.height + e / M.width,
                                 M.columns[k] * M.width + e % M.width,
                                 M.block(k)[e]);
    Eigen::SparseMatrix<double> result(n, n);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }
} // namespace Debond
