// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_certificate_file_h
#define debond_certify_certificate_file_h

#include <debond/certify/global_bound.h>

#include <nlohmann/json.hpp>

namespace Debond
{
  /// The content of certificate_proof.json (doc/reference/proofs.md) but for
  /// the interval: the body, its loads and supports, the laws of its contact
  /// sides with their trace constants, a displacement, and what was proved of
  /// it stage by stage. Null if the format has no words for the scene.
  nlohmann::ordered_json
  certificate_proof(const EquilibriumProblem<2>        &equilibrium,
                    const ElasticFields<2>             &fields,
                    const DofVector                    &displacement,
                    const std::vector<PiecewiseEnergy> &laws,
                    const std::vector<double>          &trace_constants,
                    const std::vector<BoundStage>      &stages);
} // namespace Debond

#endif
