// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/contact/laws/winkler.h>

#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    void
    require_in_range(const bool         condition,
                     const std::string &parameter,
                     const double       value,
                     const std::string &range)
    {
      if (condition && std::isfinite(value))
        return;

      std::ostringstream message;
      message << parameter << " = " << value << " is out of range: it must be "
              << range << " and finite";
      throw std::invalid_argument(message.str());
    }
  } // namespace



  ContactLawParameters
  winkler_law(const double bond_stiffness, const double bond_threshold)
  {
    const double a = bond_stiffness, M = bond_threshold;
    require_in_range(a >= 0., "Bond stiffness", a, ">= 0");
    require_in_range(M > 0., "Bond threshold", M, "> 0");

    std::ostringstream data;
    data << "a = " << a << ", M = " << M;
    if (a == 0.)
      return {"winkler", {{0., 0., 0.L, "free"}}, data.str()};
    return {"winkler",
            {{a, 0., 0.L, "bonded"}, {0., 0., 0.5L * a * M * M, "broken"}},
            data.str()};
  }



  LawKind
  winkler_kind()
  {
    return {"winkler",
            "is the paper's, with bonds that pull in proportion to the "
            "displacement and break at the threshold",
            [](ParameterTable &table) -> LawMaker {
              struct Entries
              {
                double stiffness = 69., threshold = 0.002;
              };
              const auto law = std::make_shared<Entries>();
              table.bind("Contact law/Bond stiffness",
                         law->stiffness,
                         quantity(true),
                         "a",
                         "force per volume");
              table.bind("Contact law/Bond threshold",
                         law->threshold,
                         quantity(),
                         "M, the displacement at which bonds break",
                         "length");
              return [law](ParameterTable &) {
                return winkler_law(law->stiffness, law->threshold);
              };
            }};
  }
} // namespace Debond
