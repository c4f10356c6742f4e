// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/base/text.h>
#include <debond/contact/laws/stepped.h>

#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    void
    require_steps(const bool holds, const std::string &reason)
    {
      if (!holds)
        throw std::invalid_argument("a stepped law needs " + reason);
    }

  } // namespace



  ContactLawParameters
  stepped_law(const std::vector<double> &stiffnesses,
              const std::vector<double> &thresholds)
  {
    const std::size_t n = stiffnesses.size();
    require_steps(n > 0 && thresholds.size() == n,
                  "as many stiffnesses as thresholds, at least one");
    for (std::size_t k = 0; k < n; ++k)
      {
        require_steps(std::isfinite(stiffnesses[k]) && stiffnesses[k] > 0. &&
                        (k == 0 || stiffnesses[k] < stiffnesses[k - 1]),
                      "stiffnesses > 0 that fall from step to step");
        require_steps(std::isfinite(thresholds[k]) && thresholds[k] > 0. &&
                        (k == 0 || thresholds[k] > thresholds[k - 1]),
                      "thresholds > 0 that rise from step to step");
      }

    ContactLawParameters law = {"stepped", {}, ""};
    std::ostringstream   data;
    long double          energy = 0.L;
    for (std::size_t k = 0; k < n; ++k)
      {
        const double      a = stiffnesses[k];
        const long double M = thresholds[k];
        law.branches.push_back(
          {a,
           0.,
           energy,
           k == 0 ? "bonded" : "partly broken (" + std::to_string(k) + ")"});
        energy += 0.5L * (a - (k + 1 < n ? stiffnesses[k + 1] : 0.L)) * M * M;
        data << (k == 0 ? "" : ", then ") << "a = " << a
             << " up to M = " << thresholds[k];
      }
    law.branches.push_back({0., 0., energy, "broken"});
    law.data = data.str();
    return law;
  }



  LawKind
  stepped_kind()
  {
    return {
      "stepped",
      "breaks in steps, from each of the stiffnesses of its section to the next "
      "one at the thresholds, and holds nothing after the last",
      [](ParameterTable &table) -> LawMaker {
        struct Entries
        {
          std::vector<double> stiffnesses = {69., 23.};
          std::vector<double> thresholds  = {0.001, 0.003};
          std::string         factor;
        };
        const auto        law         = std::make_shared<Entries>();
        const std::string stiffnesses = "Contact law/Stepped/Stiffnesses";
        const std::string thresholds  = "Contact law/Stepped/Thresholds";
        const std::string factor      = "Contact law/Stepped/Factor";
        const Pattern     quantities("a list, each " + quantity().description(),
                                 [](const std::string &text) {
                                   return quantity().match(text);
                                 });
        table.bind(stiffnesses,
                   law->stiffnesses,
                   quantities,
                   "a_1, a_2, ..., which fall from step to step",
                   "force per volume");
        table.bind(thresholds,
                   law->thresholds,
                   quantities,
                   "M_1, M_2, ..., the displacement at which each step ends, "
                   "which rise",
                   "length");
        table.bind(
          factor,
          law->factor,
          Pattern("nothing, or an expression"),
          "What multiplies all stiffnesses, an expression in x, y (and z) as in Loads: 0 where there are no bonds, such as on a crack; 1 if empty");
        return [=](ParameterTable &entries) {
          try
            {
              ContactLawParameters result =
                stepped_law(law->stiffnesses, law->thresholds);
              result.stiffness       = law->factor;
              result.stiffness_entry = factor;
              if (!law->factor.empty())
                result.data += ", times " + law->factor;
              return result;
            }
          catch (const std::invalid_argument &error)
            {
              entries.reject(stiffnesses,
                             error.what() +
                               comma_hint(entries.get(stiffnesses) + ", " +
                                          entries.get(thresholds)),
                             {thresholds});
              return ContactLawParameters();
            }
        };
      },
      "Contact law/Stepped/"};
  }
} // namespace Debond
