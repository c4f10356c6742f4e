// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_condensation_h
#define debond_linear_algebra_condensation_h

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>

#include <debond/linear_algebra/dof_vector.h>
#include <debond/linear_algebra/views.h>

#include <functional>
#include <memory>
#include <vector>

namespace Debond
{
  /// What Condensation::scale_load() does not scale by the first factor.
  struct OtherParts
  {
    DofVector constant_load = {}; ///< a part of f, empty for none
    DofVector second_load   = {}; ///< that has the second factor

    /// A part of the energy, by both factors; none for null.
    std::function<double(double, double)> energy = {};
  };



  /// What the factorisation of a Condensation takes.
  struct FactorisationCost
  {
    double operations; ///< floating point
    double entries;    ///< of the factor, 8 bytes each
  };

  /// By the symbolic factorisation of the graph of nodes, each of which has @p
  /// n_components successive rows of A. Throws std::bad_alloc.
  FactorisationCost
  factorisation_cost(const dealii::SparseMatrix<double> &A,
                     const std::vector<unsigned int>    &kept,
                     const unsigned int                  n_components);



  /**
   * The elastic problem condensed onto some of its unknowns s, here the normal
   * displacements of the contact nodes: with all others at equilibrium,
   *
   *     1/2 <A u, u> - <f, u> = c_0 + 1/2 s'S s - g's,
   *
   * S being the Schur complement (discrete Steklov-Poincare operator) of A.
   *
   * One supernodal Cholesky factorisation P A P' = L L' with the kept unknowns
   * last gives everything: the trailing block L_ss of the factor has S = L_ss
   * L_ss', L y = P f gives g = L_ss y_s and c_0 = -1/2 |y_i|^2, and L'x = (y_i,
   * L_ss's) all unknowns for given s.
   */
  class Condensation
  {
  public:
    /// @p kept: the unknowns s in their order. @p is_excluded says which rows
    /// of A are left out (u = 0 there); on the others A has to be symmetric and
    /// positive definite.
    ///
    /// If @p is_semidefinite, A needs to be definite only where s is zero, and
    /// S is as singular as A: the factor is that of A with its diagonal entries
    /// of s twice as large, S_+ = S + diag(A_ss) its Schur complement.
    ///
    /// Throws std::runtime_error if A is not positive definite, std::bad_alloc
    /// if the factor does not fit into memory.
    Condensation(const dealii::SparseMatrix<double>      &A,
                 const DofVector                         &f,
                 const std::vector<unsigned int>         &kept,
                 const std::function<bool(unsigned int)> &is_excluded,
                 const OtherParts                        &others = {},
                 const bool is_semidefinite                      = false);

    Condensation(const Condensation &) = delete;

    ~Condensation();

    /// From now on f is @p factor times the load that the constructor got, but
    /// for its constant part and the one that has the @p second factor; S and
    /// the factorisation stay.
    void
    scale_load(const double factor, const double second);

    /// With both factors the same.
    void
    scale_load(const double factor)
    {
      scale_load(factor, factor);
    }

    /// S, symmetric, a row for each kept unknown. Valid as long as this object.
    MatrixView
    schur_complement() const;

    /// g.
    const Eigen::VectorXd &
    load() const
    {
      return g;
    }

    /// c_0 with the other part, the energy of s = 0.
    double
    energy_at_zero() const;

    /// 1/2 <A u, u> >= 0 of the solution of A u = f, without any contact: a
    /// scale for energies. The functional's minimum over all s is minus this,
    /// but for the other part of the energy. With S_+ if A is semidefinite.
    double
    energy_without_contact() const;

    /// 1/2 g'S^{-1} g, what the kept unknowns gain without any contact. With
    /// S_+ if A is semidefinite.
    double
    energy_of_kept() const;

    /// An estimate of |S| |S^{-1}| in the 1-norm, by LAPACK from the factor; 1
    /// if no unknown is kept. Of S_+ if A is semidefinite.
    double
    condition_estimate() const;

    /// u at equilibrium for given s, with the size of f.
    DofVector
    expand(const VectorView &s) const
    {
      return backward(y, s);
    }

    /// u at equilibrium under another load, for the s that @p kept_unknowns
    /// returns for the g of this load.
    DofVector
    solve(const DofVector &other_f,
          const std::function<Eigen::VectorXd(const Eigen::VectorXd &)>
            &kept_unknowns) const;

  private:
    class Factor;

    /// L^{-1} P f.
    std::vector<double>
    forward(const DofVector &f) const;

    /// L_ss y_s.
    Eigen::VectorXd
    condensed_load(const std::vector<double> &y) const;

    /// u for y in the eliminated unknowns.
    DofVector
    backward(const std::vector<double> &y, const VectorView &s) const;

    unsigned int              n;        ///< size of f
    std::vector<unsigned int> unknowns; ///< rows of A, the kept ones last
    std::unique_ptr<Factor>   factor;
    std::vector<double>       y;          ///< L^{-1} P f of the load
    std::vector<double>       given_y;    ///< of the given one
    std::vector<double>       constant_y; ///< of its constant part, if any
    std::vector<double>       second_y;   ///< of the one with a factor
    std::function<double(double, double)> other_energy;
    double                                constant_part = 0.; ///< of the energy
    dealii::FullMatrix<double>            L_ss;
    dealii::FullMatrix<double>            S;
    Eigen::VectorXd                       g;
  };
} // namespace Debond

#endif
