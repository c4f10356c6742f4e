// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_elimination_factor_h
#define debond_linear_algebra_elimination_factor_h

#include <deal.II/lac/full_matrix.h>

#include <debond/base/dof_vector.h>
#include <debond/base/views.h>

#include <Eigen/Core>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace Debond
{
  /// Which rows i of a symmetric matrix A are eliminated, and which rows s are
  /// kept. Those that are in neither are left out.
  struct Elimination
  {
    std::vector<unsigned int> unknowns; ///< rows of A, the kept ones last
    unsigned int              n_kept;

    /// Whether A needs to be definite only where s is zero.
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



  /// Of a matrix with @p n rows, without those that @p is_excluded says.
  Elimination
  eliminate_all_but(const std::vector<unsigned int>         &kept,
                    const unsigned int                       n,
                    const std::function<bool(unsigned int)> &is_excluded,
                    const bool                               is_semidefinite);



  /**
   * A factorisation of A that eliminates all but the kept unknowns, for
   * Condensation, which says what its quantities are. Loads are reduced once;
   * what else depends on a load comes from its reduced form, which is linear in
   * the load.
   *
   * On several ranks all functions but schur_complement() and
   * condition_estimate(), and the destructor too, are to be called by all of
   * them, and all get the same.
   */
  class EliminationFactor
  {
  public:
    EliminationFactor() = default;

    EliminationFactor(const EliminationFactor &) = delete;

    virtual ~EliminationFactor() = default;

    /// Of @p f with an entry for each row of A. Its entries are the factor's
    /// own affair.
    virtual Eigen::VectorXd
    reduce(const DofVector &f) const = 0;

    /// g, an entry for each kept unknown.
    virtual Eigen::VectorXd
    condensed_load(const Eigen::VectorXd &reduced) const = 0;

    /// @p other plus c_0.
    virtual double
    energy_at_zero(const Eigen::VectorXd &reduced,
                   const double           other) const = 0;

    /// 1/2 g'S^{-1} g, with S_+ if A is semidefinite.
    virtual double
    energy_of_kept(const Eigen::VectorXd &reduced) const = 0;

    /// That and -c_0.
    virtual double
    energy_without_contact(const Eigen::VectorXd &reduced) const = 0;

    /// u at equilibrium for the kept unknowns @p s, with an entry for each row
    /// of A, zero in those left out.
    virtual DofVector
    expand(const Eigen::VectorXd &reduced, const VectorView &s) const = 0;

    /// S, both triangles.
    const dealii::FullMatrix<double> &
    schur_complement() const
    {
      return S;
    }

    /// See Condensation::condition_estimate().
    double
    condition_estimate() const;

  protected:
    dealii::FullMatrix<double> S;
    dealii::FullMatrix<double> L_ss; ///< S or S_+ = L_ss L_ss', lower triangle
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
