// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/interrupt.h>
#include <debond/input/bad_input.h>
#include <debond/program/certify_result.h>

namespace Debond
{
  template <int dim>
  std::unique_ptr<const Certifier>
  make_certifier(
    [[maybe_unused]] const CertificateKind                    kind,
    [[maybe_unused]] const std::shared_ptr<const Scene<dim>> &scene)
  {
    if constexpr (dim == 2)
      if (kind != CertificateKind::none)
        try
          {
            return std::make_unique<const Certifier>(kind, scene);
          }
        catch (const EquilibriumError &error)
          {
            const std::string entry = "Certificate/Kind";
            throw BadInput({scene->parameters().locations.at(entry) + ": " +
                            entry + ": " + error.what()});
          }
    return nullptr;
  }



  template <int dim>
  void
  certify_result(
    const Certifier                                          &certifier,
    [[maybe_unused]] const CertificateKind                    kind,
    const bool                                                is_refined,
    const BranchAndBoundParameters                           &proof,
    [[maybe_unused]] const std::shared_ptr<const Scene<dim>> &scene,
    RunResult<dim>                                           &result)
  {
    dealii::Timer        timer;
    const InterruptGuard guard;
    const auto           certify = [&](const Certifier &current) {
      if constexpr (dim == 2)
        result.certificate =
          current.certify(*scene, result.solve.u, proof, [&guard]() {
            return !guard.requested();
          });
      if (guard.requested())
        result.solve.minimum.interrupted = true;
    };
    try
      {
        if constexpr (dim == 2)
          {
            if (is_refined && !certifier.is_for_finer_meshes())
              certify(Certifier(kind, scene));
            else
              certify(certifier);
          }
      }
    catch (const EquilibriumError &error)
      {
        result.notes.push_back(std::string("There is no certificate: ") +
                               error.what() + ".");
      }
    result.times.emplace_back("certificate", timer.wall_time());
  }



  template decltype(make_certifier<2>) make_certifier<2>;
  template decltype(make_certifier<3>) make_certifier<3>;
  template decltype(certify_result<2>) certify_result<2>;
  template decltype(certify_result<3>) certify_result<3>;
} // namespace Debond
