// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/linear_algebra/cholmod_factor.h>
#include <debond/linear_algebra/condensation.h>
#include <debond/linear_algebra/mumps_factor.h>

namespace Debond
{
  namespace
  {
    std::shared_ptr<const EliminationFactor>
    factorise(const MatrixOnRanks &A, const Elimination &elimination)
    {
      // CHOLMOD knows no ranks, and on one rank it is asked because it gives
      // the whole of L_ss, from which g and energies follow without solutions
      // of their own.
      if (A.is_shared())
        return make_mumps_factor(A, elimination);
      return make_cholmod_factor(A.A, elimination);
    }
  } // namespace



  Condensation::Condensation(
    const MatrixOnRanks                     &A,
    const DofVector                         &f,
    const std::vector<unsigned int>         &kept,
    const std::function<bool(unsigned int)> &is_excluded,
    const double                             other_energy,
    const bool                               is_semidefinite)
    : Condensation(factorise(A,
                             eliminate_all_but(kept,
                                               f.size(),
                                               is_excluded,
                                               is_semidefinite)),
                   f,
                   other_energy)
  {}
} // namespace Debond
