// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/laws/none.h>

namespace Debond
{
  ContactLawParameters
  no_adhesion()
  {
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
