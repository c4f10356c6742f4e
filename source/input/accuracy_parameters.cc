// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/accuracy_parameters.h>

namespace Debond
{
  void
  bind_accuracy(AccuracyParameters &accuracy, ParameterTable &table)
  {
    table.bind(
      "Accuracy/Target",
      accuracy.target,
      number("that is 0 or in [1e-7, 1)",
             [](double x) { return x == 0. || (x >= 1e-7 && x < 1.); }),
      "The mesh is refined where that lowers J most, from the one of Mesh on, until the estimated error of J relative to J is not larger than this; 0 for the mesh as it is. Needs a method with a direct linear solver",
      "none");
    table.bind(
      "Certificate/Target",
      accuracy.certified_width,
      number("that is 0 or in [1e-7, 1)",
             [](double x) { return x == 0. || (x >= 1e-7 && x < 1.); }),
      "The mesh is refined where that makes the interval narrower, from the one of Mesh on, until its width relative to J is not larger than this; 0 for the mesh as it is",
      "none");
    table.bind(
      "Accuracy/Maximum unknowns",
      accuracy.maximum_unknowns,
      whole_number(0, 1000000000),
      "The mesh is refined no further than to so many unknowns (vertices times Dimension); 0 for as many as the memory has room for. Without a Target it is refined as far as that",
      "none");
  }
} // namespace Debond
