// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/input/bad_input.h>
#include <debond/program/certify_result.h>

namespace Debond
{
  template <int dim>
  std::unique_ptr<const Certifier<dim>>
  make_certifier(const CertificateKind                    kind,
                 const std::shared_ptr<const Scene<dim>> &scene)
  {
    if (kind == CertificateKind::none)
      return nullptr;
    try
      {
        return std::make_unique<const Certifier<dim>>(kind, scene);
      }
    catch (const EquilibriumError &error)
      {
        const std::string entry = "Certificate/Kind";
        throw BadInput({scene->parameters().locations.at(entry) + ": " + entry +
                        ": " + error.what()});
      }
    catch (const std::exception &)
      {
        // It is no fault of the scene; certify_result() will say it.
        return nullptr;
      }
  }



  template <int dim>
  void
  certify_result(const Certifier<dim>                    *certifier,
                 const CertificateKind                    kind,
                 const bool                               is_refined,
                 const BranchAndBoundParameters          &proof,
                 const std::shared_ptr<const Scene<dim>> &scene,
                 RunResult<dim>                          &result)
  {
    dealii::Timer        timer;
    const InterruptGuard guard;
    const auto           certify = [&](const Certifier<dim> &current) {
      result.certificate =
        current.certify(*scene, result.solve.u, proof, [&guard]() {
          return !guard.requested();
        });
      result.certificate->include(result.solve.functional);
      if (guard.requested())
        result.solve.minimum.interrupted = true;
    };
    try
      {
        if (certifier == nullptr ||
            (is_refined && !certifier->is_for_finer_meshes()))
          certify(Certifier<dim>(kind, scene));
        else
          certify(*certifier);
      }
    catch (const std::exception &error)
      {
        result.notes.push_back(no_certificate(error));
      }
    result.times.emplace_back("certificate", timer.wall_time());
  }



  template decltype(make_certifier<2>) make_certifier<2>;
  template decltype(make_certifier<3>) make_certifier<3>;
  template decltype(certify_result<2>) certify_result<2>;
  template decltype(certify_result<3>) certify_result<3>;
} // namespace Debond
