// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/laws/none.h>

namespace Debond
{
  ContactLawParameters
  no_adhesion()
  {
    // What remains of (9) without a traction is [0, inf) at 0 and zero below,
    // which the bound s <= 0 says.
    return {"none", {{0., 0., no_end, "free"}}, ""};
  }



  LawKind
  no_adhesion_kind()
  {
    return {"none", "has no adhesion", [](ParameterTable &) -> LawMaker {
              return [](ParameterTable &) { return no_adhesion(); };
            }};
  }
} // namespace Debond
