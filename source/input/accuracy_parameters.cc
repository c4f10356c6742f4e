// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/accuracy_parameters.h>
#include <debond/input/load_parameters.h>

namespace Debond
{
  void
  bind_accuracy(CertificateParameters  &certificate,
                AccuracyParameters     &accuracy,
                VerificationParameters &verification,
                ParameterTable         &table)
  {
    table.bind_choice(
      "Certificate/Kind",
      certificate.kind,
      {{"none", CertificateKind::none},
       {"fixed state", CertificateKind::fixed_state},
       {"global", CertificateKind::global}},
      "An interval, with a proof, for the minimum of the continuous problem on the body of the mesh: global is for the least J (2D), fixed state for the least J with the bonds of each side of the contact boundary on the branch of the result");
    const Pattern width = number("that is 0 or in [1e-7, 1)", [](double x) {
      return x == 0. || (x >= 1e-7 && x < 1.);
    });
    table.bind(
      "Accuracy/Target",
      accuracy.target,
      width,
      "The mesh is refined where that lowers J most, from the one of Mesh on, until the estimated error of J relative to J is not larger than this; 0 for the mesh as it is. Needs another method than euclidean bundle");
    table.bind(
      "Certificate/Target",
      accuracy.certified_width,
      width,
      "The mesh is refined where that makes the interval narrower, from the one of Mesh on, until its width relative to J is not larger than this; 0 for the mesh as it is");
    table.bind(
      "Accuracy/Maximum unknowns",
      accuracy.maximum_unknowns,
      whole_number(0, 1000000000),
      "The mesh is refined no further than to so many unknowns (vertices times Dimension); 0 for as many as the memory has room for. Without a Target it is refined as far as that");
    table.bind(
      "Verification/Tolerance",
      verification.tolerance,
      positive_number(),
      "The program returns 3 if the equilibrium residual, the force imbalance (both relative to the forces) or the violation of the contact law of the result is larger, whatever the solver says");
    table.bind(
      "Verification/Exact displacement",
      verification.exact_displacement,
      vector_expression(),
      "If the displacement is known, expressions for it with the names of the loads: the log and summary.json then have the relative errors of u in the norms of L2, H1 and the energy",
      "length");
  }
} // namespace Debond
