// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>

#include <debond/linear_algebra/block_factor.h>
#include <debond/linear_algebra/multigrid_factor.h>
#include <debond/linear_algebra/stagnation.h>

#include <sstream>
#include <utility>

namespace Debond
{
  namespace
  {
    constexpr unsigned int maximum_iterations = 2000;

    /// The cycle stays truncated at the kept unknowns, so that S and all later
    /// loads are solved for with the same preconditioner.
    class MultigridFactor : public BlockFactor
    {
    public:
      MultigridFactor(const MatrixOnRanks                &matrix,
                      const Elimination                  &elimination,
                      std::unique_ptr<TruncatedMultigrid> given_cycle)
        : BlockFactor(matrix, elimination)
        , own(matrix.own_rows)
        , cycle(std::move(given_cycle))
      {
        // With the kept unknowns held at zero and no bonds, the matrix of the
        // cycle is A_ii beside the diagonal of A_ss. So a right side that is
        // zero at kept unknowns has a solution that is zero there, and the
        // others are A_ii^{-1} times it.
        std::vector<unsigned int> held;
        for (unsigned int k = n_eliminated; k < elimination.unknowns.size();
             ++k)
          if (own.is_element(elimination.unknowns[k]))
            held.push_back(elimination.unknowns[k]);
        cycle->truncate({}, held);

        // S = A_ss - A_si A_ii^{-1} A_is, column by column, with a solution
        // each. A rank has the couplings in its own rows i only, so that the
        // k-th column of A_is and its product with A_si are sums over the
        // ranks. The owner of row k adds the entries of A_ss in that row, which
        // by symmetry are those of the column.
        const std::vector<int> position = elimination.positions(n_rows);
        for (unsigned int k = 0; k < n_kept; ++k)
          {
            Eigen::VectorXd couplings = A_is.col(k);
            sum(couplings);
            Eigen::VectorXd column = -(A_is.transpose() * solve(couplings));
            const auto      row    = elimination.unknowns[n_eliminated + k];
            if (own.is_element(row))
              for (auto entry = matrix.A.begin(row); entry != matrix.A.end(row);
                   ++entry)
                if (const int i = position[entry->column()] -
                                  static_cast<int>(n_eliminated);
                    i >= 0)
                  column(i) += entry->value();
            // The product with A_si and the row of A_ss are added up by one
            // exchange.
            sum(column);
            for (unsigned int i = 0; i < n_kept; ++i)
              S(i, k) = column(i);
          }
        // Residuals of the solutions make S symmetric up to these only.
        S.symmetrize();
        finish(matrix);
      }

    private:
      Eigen::VectorXd
      solve(const Eigen::VectorXd &b) const override
      {
        // Conjugate gradients from zero. The residual that is aimed at may be
        // below what rounding allows; so the iteration also ends if it
        // stagnates, and what has been reached is accepted down to
        // required_residual. deal.II throws NoConvergence in both cases.
        DistributedVector right(own, ranks), x(own, ranks);
        for (unsigned int i = 0; i < n_eliminated; ++i)
          if (const unsigned int row = elimination.unknowns[i];
              own.is_element(row))
            right(row) = b(i);
        const double                        size = right.l2_norm();
        dealii::SolverControl               control(maximum_iterations,
                                      Tolerance::wanted_residual * size);
        dealii::SolverCG<DistributedVector> cg(control);
        Stagnation                          stagnation;
        cg.connect(
          [&stagnation](const unsigned int, const double value, const auto &) {
            return stagnation.is_reached(value) ?
                     dealii::SolverControl::failure :
                     dealii::SolverControl::success;
          });
        try
          {
            cg.solve(cycle->matrix(), x, right, *cycle);
          }
        catch (const dealii::SolverControl::NoConvergence &)
          {
            // The negation also refuses a residual that is not a number.
            if (!(control.last_value() <= Tolerance::required_residual * size))
              {
                std::ostringstream text;
                text << "Condensation by multigrid: relative residual "
                     << control.last_value() / size << " after "
                     << control.last_step() << " steps, required is "
                     << Tolerance::required_residual
                     << "; try Solver/Linear solver = direct";
                throw std::runtime_error(text.str());
              }
          }
        // All ranks get all of the solution as the sum of the parts.
        Eigen::VectorXd result = Eigen::VectorXd::Zero(n_eliminated);
        for (unsigned int i = 0; i < n_eliminated; ++i)
          if (const unsigned int row = elimination.unknowns[i];
              own.is_element(row))
            result(i) = x(row);
        sum(result);
        return result;
      }

      const dealii::IndexSet                    own;
      const std::unique_ptr<TruncatedMultigrid> cycle;
    };
  } // namespace



  std::unique_ptr<EliminationFactor>
  make_multigrid_factor(const MatrixOnRanks                &matrix,
                        const Elimination                  &elimination,
                        std::unique_ptr<TruncatedMultigrid> cycle)
  {
    return std::make_unique<MultigridFactor>(matrix,
                                             elimination,
                                             std::move(cycle));
  }
} // namespace Debond
