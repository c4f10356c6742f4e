// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_certify_result_h
#define debond_program_certify_result_h

#include <debond/input/certificate_parameters.h>
#include <debond/optimization/global/branch_and_bound.h>
#include <debond/output/run_result.h>
#include <debond/solve/certificate.h>
#include <debond/solve/scene.h>

#include <memory>

namespace Debond
{
  /// What certifies results of the scene, null if that is not asked for.
  /// Throws BadInput if it cannot be done.
  template <int dim>
  std::unique_ptr<const Certifier>
  make_certifier(const CertificateKind                    kind,
                 const std::shared_ptr<const Scene<dim>> &scene);

  /// @p certifier: of the scene as it was before its mesh was refined, if it
  /// was. @p kind is that of a certificate on the last mesh.
  template <int dim>
  void
  certify_result(const Certifier                         &certifier,
                 const CertificateKind                    kind,
                 const bool                               is_refined,
                 const BranchAndBoundParameters          &proof,
                 const std::shared_ptr<const Scene<dim>> &scene,
                 RunResult<dim>                          &result);
} // namespace Debond

#endif
