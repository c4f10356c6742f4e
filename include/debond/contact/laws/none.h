// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_contact_laws_none_h
#define debond_contact_laws_none_h

#include <debond/contact/law.h>

namespace Debond
{
  /// No adhesion, j_1 = 0: with the unilateral constraint, Signorini's law.
  ContactLawParameters
  no_adhesion();

  LawKind
  no_adhesion_kind();
} // namespace Debond

#endif
