// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/base/text.h>
#include <debond/contact/law.h>
#include <debond/contact/laws/none.h>
#include <debond/contact/laws/stepped.h>
#include <debond/contact/laws/winkler.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  AdhesiveLaw::AdhesiveLaw(const std::vector<ConvexBranch> &branches)
    : minimum(branches)
  {
    for (unsigned int k = 0; k < minimum.size(); ++k)
      names.push_back(branches[minimum[k].branch].name);
  }



  double
  AdhesiveLaw::value(const double s) const
  {
    if (s > 0.)
      return 0.;
    // A bond that does not pull keeps the energy that the branch before it has
    // at the kink, to the last digit: the constant is rounded otherwise, which
    // the bundle method amplifies.
    const unsigned int k = minimum.index(s);
    return k > 0 && is_loose(k) ? minimum[k - 1].value(minimum[k].upper) :
                                  minimum[k].value(s);
  }



  bool
  AdhesiveLaw::is_before(const double s, const unsigned int least) const
  {
    return least > 0 && minimum.index(s) < least;
  }



  double
  AdhesiveLaw::value(const double s, const unsigned int least) const
  {
    if (!is_before(s, least))
      return value(s);
    // As value() has it at the kink.
    const double kink = minimum[least].upper;
    return minimum[least - 1].value(kink) + minimum[least].value(s) -
           minimum[least].value(kink);
  }



  double
  AdhesiveLaw::derivative(const double s, const unsigned int least) const
  {
    return is_before(s, least) ? minimum[least].derivative(s) : derivative(s);
  }



  double
  AdhesiveLaw::curvature(const double s, const unsigned int least) const
  {
    return is_before(s, least) ? minimum[least].curvature : curvature(s);
  }



  Interval
  AdhesiveLaw::clarke_interval(const double s, const unsigned int least) const
  {
    if (!is_before(s, least))
      return clarke_interval(s);
    const double force = minimum[least].derivative(s);
    return {force, force};
  }



  Interval
  AdhesiveLaw::clarke_interval(const double s) const
  {
    if (s > 0.)
      return {0., 0.};
    const unsigned int k     = minimum.index(s);
    const double       force = minimum[k].derivative(s);
    // The other side, if s is a kink.
    const double other =
      s == 0. ? 0. :
                (s == minimum[k].lower ? minimum[k + 1].derivative(s) : force);
    return {std::min(force, other), std::max(force, other)};
  }



  double
  AdhesiveLaw::derivative(const double s) const
  {
    return s > 0. ? 0. : minimum[minimum.index(s)].derivative(s);
  }



  double
  AdhesiveLaw::curvature(const double s) const
  {
    return s > 0. ? 0. : minimum[minimum.index(s)].curvature;
  }



  Interval
  AdhesiveLaw::goldstein_interval(const double s, const double delta) const
  {
    return goldstein_interval(s, delta, 0);
  }



  Interval
  AdhesiveLaw::goldstein_interval(const double       s,
                                  const double       delta,
                                  const unsigned int least) const
  {
    Interval hull = clarke_interval(s, least);
    if (!(delta > 0.))
      return hull;

    const auto extend = [&](const double t) {
      const Interval interval = clarke_interval(t, least);
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



  std::vector<double>
  AdhesiveLaw::kinks() const
  {
    std::vector<double> result;
    for (unsigned int k = minimum.size() - 1; k > 0; --k)
      result.push_back(minimum[k].upper);
    if (!is_loose(0))
      result.push_back(0.);
    return result;
  }



  const BranchMinimum &
  AdhesiveLaw::branches() const
  {
    return minimum;
  }



  const std::string &
  AdhesiveLaw::name(const unsigned int piece) const
  {
    return names[piece];
  }



  bool
  AdhesiveLaw::is_loose(const unsigned int piece) const
  {
    return minimum[piece].curvature == 0. && minimum[piece].slope == 0.;
  }



  double
  AdhesiveLaw::bond_threshold() const
  {
    return std::abs(minimum[minimum.size() - 1].upper);
  }



  double
  AdhesiveLaw::bond_strength() const
  {
    double strength = 0.;
    for (const double kink : kinks())
      strength = std::max(strength, -clarke_interval(kink).lower);
    return strength;
  }



  namespace
  {
    const std::vector<LawKind> &
    kinds()
    {
      static const std::vector<LawKind> all = {winkler_kind(),
                                               stepped_kind(),
                                               no_adhesion_kind()};
      return all;
    }
  } // namespace



  std::vector<std::string>
  law_names()
  {
    std::vector<std::string> names;
    for (const LawKind &kind : kinds())
      names.push_back(kind.name);
    std::sort(names.begin(), names.end());
    return names;
  }



  LawSection::LawSection()
    : name(kinds()[0].name)
  {}



  void
  LawSection::bind(ParameterTable &table)
  {
    std::vector<std::string> descriptions;
    for (const LawKind &kind : kinds())
      descriptions.push_back(kind.name + " " + kind.description);
    table.bind("Contact law/Law",
               name,
               one_of(law_names()),
               "The adhesive law: " + join(descriptions, "; "));
    for (const LawKind &kind : kinds())
      makers[kind.name] = kind.bind(table);
  }



  ContactLawParameters
  LawSection::make_law(ParameterTable &table) const
  {
    // Without adhesion on purpose.
    for (const LawKind &kind : kinds())
      if (kind.name != name)
        table.without_effect(kind.entries,
                             "it belongs to Contact law/Law = " + kind.name +
                               ", the law is " + name +
                               (name == "stepped" ?
                                  "; bonds by place: Stepped/Factor" :
                                  ""),
                             name == "none" ? "" : "Contact law/Law");
    return makers.at(name)(table);
  }
} // namespace Debond
