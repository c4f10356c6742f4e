// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_bordered_cholesky_h
#define debond_linear_algebra_bordered_cholesky_h

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <map>
#include <vector>

namespace Debond
{
  /**
   * Solves M_ff x = b for one set f of indices after the other, of a dense
   * symmetric matrix M that may change in few rows, by a Cholesky factor of an
   * earlier M_FF = L L' with a border. Indices R that have left F are held at
   * zero by multipliers, and indices N that have come have rows of their own:
   *
   *     M_FF  M_FN  I_R      x_F     b_F
   *     M_NF  M_NN   0       x_N  =  b_N
   *     I_R'   0     0     lambda     0
   *
   * A row of M that has changed leaves with its old entries and comes with the
   * new ones. See Gill, Murray, Saunders and Wright, SIAM J. Sci. Stat. Comput.
   * 5 (1984), for such Schur complements. Where they would be as much work as a
   * new factor, one is made.
   */
  class BorderedCholesky
  {
  public:
    using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

    /// To be called before restrict_to() when M has become another one.
    void
    compare(const Matrix &M);

    /// Makes what solve_in_place() needs for the rows and columns @p free of
    /// M. Returns whether this part of M is positive definite.
    bool
    restrict_to(const std::vector<unsigned int> &free, const Matrix &M);

    /// b <- M_ff^{-1} b, in the order of the free indices.
    void
    solve_in_place(Eigen::VectorXd &b) const;

    /// Whether there is a border, which loses some digits.
    bool
    has_border() const
    {
      return !added.empty() || !removed.empty();
    }

    /// Of the last restrict_to(), in multiplications with an addition each.
    double
    operations() const
    {
      return n_operations;
    }

  private:
    /// Returns false if a new factor is less work, or where the matrix does not
    /// seem to be positive definite.
    bool
    make_border(const Matrix &M);

    /// L^{-1} times the columns of the border, those for @p indices as
    /// @p column_of says.
    template <typename ColumnOf>
    Eigen::MatrixXd
    border_columns(const std::vector<unsigned int>         &indices,
                   const ColumnOf                          &column_of,
                   std::map<unsigned int, Eigen::VectorXd> &known);

    std::vector<unsigned int> free;        ///< f
    std::vector<unsigned int> in_F;        ///< F
    Eigen::MatrixXd           M_of_F;      ///< M when the factor was made
    Eigen::MatrixXd           L;           ///< lower triangle
    std::vector<int>          position;    ///< in F, or -1, by index
    std::vector<char>         has_changed; ///< rows of M since then

    std::vector<unsigned int>               added, removed; ///< N, R
    std::map<unsigned int, Eigen::VectorXd> known_added, known_removed;
    Eigen::MatrixXd                         Y_N, Y_R; ///< L^{-1}(M_FN, I_R)
    Eigen::MatrixXd                         X;        ///< L_W^{-1} Y_R'Y_N
    Eigen::LLT<Eigen::MatrixXd>             of_W;     ///< W = Y_R'Y_R
    Eigen::LLT<Eigen::MatrixXd>             of_P;     ///< M_NN - Y_N'Y_N + X'X
    double                                  n_operations = 0.;
  };
} // namespace Debond

#endif
