// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/contact/law.h>
#include <debond/contact/laws/none.h>
#include <debond/contact/laws/winkler.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace Debond
{
  LawShape
  AdhesiveLaw::shape() const
  {
    return LawShape::other;
  }



  Interval
  AdhesiveLaw::goldstein_interval(const double s, const double delta) const
  {
    Interval hull = clarke_interval(s);
    if (!(delta > 0.))
      return hull;

    const auto extend = [&](const double t) {
      const Interval interval = clarke_interval(t);
      hull.lower              = std::min(hull.lower, interval.lower);
      hull.upper              = std::max(hull.upper, interval.upper);
    };

    // The derivative is linear between the kinks, so its extremes are at the
    // ends and at the kinks, whose intervals hold both one-sided values.
    extend(s - delta);
    extend(s + delta);
    for (const double kink : kinks())
      if (std::abs(kink - s) <= delta)
        extend(kink);
    return hull;
  }



  namespace
  {
    using Factory =
      std::function<std::unique_ptr<AdhesiveLaw>(const ContactLawParameters &)>;

    const std::map<std::string, Factory> &
    registry()
    {
      static const std::map<std::string, Factory> laws = {
        {"none",
         [](const ContactLawParameters &) {
           return std::make_unique<NoAdhesion>();
         }},
        {"winkler", [](const ContactLawParameters &parameters) {
           return std::make_unique<WinklerLaw>(parameters.bond_stiffness,
                                               parameters.bond_threshold);
         }}};
      return laws;
    }
  } // namespace



  std::vector<std::string>
  law_names()
  {
    std::vector<std::string> names;
    for (const auto &law : registry())
      names.push_back(law.first);
    return names;
  }



  std::unique_ptr<AdhesiveLaw>
  make_law(const ContactLawParameters &parameters)
  {
    const auto law = registry().find(parameters.name);
    if (law == registry().end())
      {
        std::string message =
          "The contact law \"" + parameters.name + "\" is unknown; known are:";
        for (const std::string &name : law_names())
          message += " " + name;
        throw std::invalid_argument(message);
      }
    return law->second(parameters);
  }
} // namespace Debond
