// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_linear_algebra_condensation_h
#define debond_linear_algebra_condensation_h

#include <debond/linear_algebra/elimination_factor.h>
#include <debond/linear_algebra/matrix_on_ranks.h>

#include <memory>
#include <utility>

namespace Debond
{
  /**
   * The elastic problem condensed onto some of its unknowns s, here the normal
   * displacements of the contact nodes: with all others at equilibrium,
   *
   *     1/2 <A u, u> - <f, u> = c_0 + 1/2 s'S s - g's,
   *
   * S being the Schur complement (discrete Steklov-Poincare operator) of A.
   *
   * A direct factorisation gives everything, CHOLMOD's on one rank, MUMPS' on
   * several, or multigrid (make_multigrid_factor()). On several ranks all
   * functions but schur_complement(), load() and condition_estimate(), the
   * constructor and the destructor too, are to be called by all ranks; what
   * they get has to be the same on all, but for the matrix, and what they
   * return and throw is.
   */
  class Condensation
  {
  public:
    /// @p kept: the unknowns s in their order. @p is_excluded says which rows
    /// of A are left out (u = 0 there); on the others A has to be symmetric and
    /// positive definite. It is not kept. @p other_energy is a part of the
    /// energy that does not depend on u.
    ///
    /// If @p is_semidefinite, A needs to be definite only where s is zero, and
    /// S is as singular as A; S_+ = S + diag(A_ss) is the Schur complement of A
    /// with its diagonal entries of s twice as large.
    ///
    /// Throws std::runtime_error if A is not positive definite, std::bad_alloc
    /// if the factor does not fit into memory.
    Condensation(const MatrixOnRanks                     &A,
                 const DofVector                         &f,
                 const std::vector<unsigned int>         &kept,
                 const std::function<bool(unsigned int)> &is_excluded,
                 const double                             other_energy = 0.,
                 const bool is_semidefinite                            = false);

    /// Takes what eliminates the unknowns.
    Condensation(std::shared_ptr<const EliminationFactor> given_factor,
                 const DofVector                         &f,
                 const double                             other_energy)
      : factor(std::move(given_factor))
      , reduced(factor->reduce(f))
      , other_energy(other_energy)
    {}

    /// Returns the problem with another load and energy. Both share the
    /// factorisation.
    Condensation
    with_load(const DofVector &f, const double energy = 0.) const
    {
      return {factor, f, energy};
    }

    /// S, symmetric, a row for each kept unknown. Valid as long as this object.
    MatrixView
    schur_complement() const
    {
      return factor->schur_complement();
    }

    /// g.
    const Eigen::VectorXd &
    load() const
    {
      return reduced.g;
    }

    /// c_0 with the other part, the energy of s = 0.
    double
    energy_at_zero() const
    {
      return other_energy + reduced.energy_at_zero;
    }

    /// 1/2 <A u, u> >= 0 of the solution of A u = f, without any contact: a
    /// scale for energies. The functional's minimum over all s is minus this,
    /// but for the other part of the energy. With S_+ if A is semidefinite.
    double
    energy_without_contact() const
    {
      return reduced.energy_of_kept - reduced.energy_at_zero;
    }

    /// 1/2 g'S^{-1} g, what the kept unknowns gain without any contact. With
    /// S_+ if A is semidefinite.
    double
    energy_of_kept() const
    {
      return reduced.energy_of_kept;
    }

    /// An estimate of the condition of S in the 1-norm, of a definite A; 1 if
    /// no unknown is kept.
    double
    condition_estimate() const
    {
      return factor->condition_estimate();
    }

    /// u at equilibrium for given s, with the size of f.
    DofVector
    expand(const VectorView &s) const
    {
      return factor->expand(reduced, s);
    }

  private:
    std::shared_ptr<const EliminationFactor> factor;
    ReducedLoad                              reduced; ///< f
    double                                   other_energy;
  };
} // namespace Debond

#endif
