// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_certify_certificate_companion_h
#define debond_certify_certificate_companion_h

#include <debond/program/companion.h>

namespace Debond
{
  /// The section Certificate, and what it asks for after a run.
  std::unique_ptr<Companion>
  make_certificate_companion();
} // namespace Debond

#endif
