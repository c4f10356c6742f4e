// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_accuracy_parameters_h
#define debond_input_accuracy_parameters_h

#include <debond/base/parameter_table.h>

namespace Debond
{
  /// Until when the mesh is refined where that makes J more accurate.
  struct AccuracyParameters
  {
    /// Estimated error relative to J; 0 for any.
    double target = 0.;

    /// Width of the interval of a certificate relative to J; 0 for any.
    double certified_width = 0.;

    /// Of the finest mesh; 0 for as many as the memory has room for.
    unsigned int maximum_unknowns = 0;

    /// Whether the mesh is refined at all.
    bool
    is_adaptive() const
    {
      return target > 0. || certified_width > 0. || maximum_unknowns > 0;
    }
  };

  /// The section Accuracy, and Certificate/Target.
  void
  bind_accuracy(AccuracyParameters &accuracy, ParameterTable &table);
} // namespace Debond

#endif
