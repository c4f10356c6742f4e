// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_verification_parameters_h
#define debond_input_verification_parameters_h

#include <string>

namespace Debond
{
  /// What makes a result count, and what it is compared with.
  struct VerificationParameters
  {
    /// Largest Verification::error() of a result that counts.
    double tolerance = 1e-3;

    /// An expression with the constants of the loads; empty if unknown.
    std::string exact_displacement;
  };
} // namespace Debond

#endif
