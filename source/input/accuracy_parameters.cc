// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/accuracy_parameters.h>
#include <debond/input/load_parameters.h>

namespace Debond
{
  void
  bind_accuracy(AccuracyParameters     &accuracy,
                VerificationParameters &verification,
                ParameterTable         &table)
  {
    table.bind(
      "Accuracy/Target",
      accuracy.target,
      relative_target(),
      "The mesh is refined where that lowers J most, from the one of Mesh on, until the estimated error of J relative to J is not larger than this; 0 for the mesh as it is. Needs another method than euclidean bundle");
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
