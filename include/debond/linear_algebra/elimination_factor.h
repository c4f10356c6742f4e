// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_elimination_factor_h
#define debond_linear_algebra_elimination_factor_h

#include <deal.II/lac/full_matrix.h>

#include <debond/base/dof_vector.h>
#include <debond/base/views.h>

#include <string>

namespace Debond
{
  /// Which rows i of a symmetric matrix A are eliminated, and which rows s are
  /// kept. Those that are in neither are left out.
  struct Elimination
  {
    std::vector<unsigned int> unknowns; ///< rows of A, the kept ones last
    unsigned int              n_kept;

    /// True if A needs to be definite only where s is zero.
    bool is_semidefinite;

    unsigned int
    n_eliminated() const
    {
      return static_cast<unsigned int>(unknowns.size()) - n_kept;
    }

    /// For each of the @p n rows of A its place in unknowns, -1 for none.
    std::vector<int>
    positions(const unsigned int n) const;
  };



  /// The elimination for a matrix with @p n rows, without those that @p
  /// is_excluded says.
  Elimination
  eliminate_all_but(const std::vector<unsigned int>         &kept,
                    const unsigned int                       n,
                    const std::function<bool(unsigned int)> &is_excluded,
                    const bool                               is_semidefinite);



  /// A load f on the rows of A once all but the kept unknowns are eliminated.
  struct ReducedLoad
  {
    Eigen::VectorXd own;            ///< what the factor needs of it to expand()
    Eigen::VectorXd g;              ///< an entry for each kept unknown
    double          energy_at_zero; ///< c_0
    double          energy_of_kept; ///< 1/2 g'S_+^{-1} g
  };



  /**
   * A factorisation of A that eliminates all but the kept unknowns, for
   * Condensation, which says what its quantities are. S_+ is S unless A is
   * semidefinite.
   *
   * On several ranks reduce(), expand() and the destructor are to be called by
   * all of them, and all get the same.
   */
  class EliminationFactor
  {
  public:
    EliminationFactor() = default;

    EliminationFactor(const EliminationFactor &) = delete;

    virtual ~EliminationFactor() = default;

    virtual ReducedLoad
    reduce(const DofVector &f) const = 0;

    /// u at equilibrium for the kept unknowns @p s, with an entry for each row
    /// of A, zero in those left out.
    virtual DofVector
    expand(const ReducedLoad &load, const VectorView &s) const = 0;

    MatrixView
    schur_complement() const
    {
      // deal.II's matrices have contiguous rows, Eigen's contiguous columns,
      // which for a symmetric one is the same.
      return Eigen::Map<const Eigen::MatrixXd>(S.empty() ? nullptr : &S(0, 0),
                                               S.m(),
                                               S.n());
    }

    /// An estimate of |S| |S^{-1}| in the 1-norm, by LAPACK, of a definite A; 1
    /// if no unknown is kept.
    double
    condition_estimate() const;

  protected:
    using ByRows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    Eigen::Map<const ByRows>
    factor_of_kept() const
    {
      return {L_ss.empty() ? nullptr : &L_ss(0, 0),
              static_cast<Eigen::Index>(L_ss.m()),
              static_cast<Eigen::Index>(L_ss.n())};
    }

    dealii::FullMatrix<double> S;    ///< both triangles
    dealii::FullMatrix<double> L_ss; ///< S_+ = L_ss L_ss', lower triangle
  };



  /// A is not positive definite. @p where: what the factorisation knows about
  /// it.
  class IndefiniteMatrix : public std::runtime_error
  {
  public:
    explicit IndefiniteMatrix(const std::string &where);
  };
} // namespace Debond

#endif
