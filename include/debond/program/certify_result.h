// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_certify_result_h
#define debond_program_certify_result_h

#include <debond/input/accuracy_parameters.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/output/run_result.h>
#include <debond/solve/certificate.h>
#include <debond/solve/scene.h>

#include <memory>

namespace Debond
{
  /// What certifies results of the scene, null if that is not asked for or if
  /// rounding does not allow it. Throws BadInput if the scene does not.
  template <int dim>
  std::unique_ptr<const Certifier<dim>>
  make_certifier(const CertificateKind                    kind,
                 const std::shared_ptr<const Scene<dim>> &scene);

  /// @p certifier: of the scene as it was before its mesh was refined, if it
  /// was; null if there is none. @p kind is for a certificate on
  /// the last mesh. A note says why there is none.
  template <int dim>
  void
  certify_result(const Certifier<dim>                    *certifier,
                 const CertificateKind                    kind,
                 const bool                               is_refined,
                 const BranchAndBoundParameters          &proof,
                 const std::shared_ptr<const Scene<dim>> &scene,
                 RunResult<dim>                          &result);
} // namespace Debond

#endif
