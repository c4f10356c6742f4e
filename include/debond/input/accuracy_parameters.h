// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_accuracy_parameters_h
#define debond_input_accuracy_parameters_h

#include <string>

namespace Debond
{
  class ParameterTable;

  /// The limits up to which the mesh is refined where that makes J more
  /// accurate.
  struct AccuracyParameters
  {
    /// Estimated error relative to J; 0 for any.
    double target = 0.;

    /// Says whether a RefinementGoal is to be reached as well.
    bool has_goal = false;

    /// Unknowns of the finest mesh; 0 for as many as the memory has room for.
    unsigned int maximum_unknowns = 0;

    /// Says whether the mesh is refined at all.
    bool
    is_adaptive() const
    {
      return target > 0. || has_goal || maximum_unknowns > 0;
    }
  };



  /// The limit up to which a result counts, and what it is compared with.
  struct VerificationParameters
  {
    /// Largest Verification::error() of a result that counts.
    double tolerance = 1e-3;

    /// An expression with the constants of the loads; empty if unknown.
    std::string exact_displacement;
  };



  /// Binds the sections Accuracy and Verification.
  void
  bind_accuracy(AccuracyParameters     &accuracy,
                VerificationParameters &verification,
                ParameterTable         &table);
} // namespace Debond

#endif
