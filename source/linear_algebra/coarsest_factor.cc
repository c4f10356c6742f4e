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
    solver.analyzePattern(matrix);
  }



  void
  CoarsestFactor::factorise(const NumberedRows &change)
  {
    Eigen::SparseMatrix<double>       now     = matrix;
    const Eigen::SparseMatrix<double> changes = gather(change, matrix.cols());
    for (int j = 0; j < changes.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(changes, j); entry;
           ++entry)
        {
          double &value = now.coeffRef(entry.row(), j);
          value         = changed(value, entry.value(), entry.row() == j);
        }
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
