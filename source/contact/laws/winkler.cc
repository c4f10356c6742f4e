// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/base/text.h>
#include <debond/contact/laws/winkler.h>

#include <cmath>
#include <functional>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

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
      return {"winkler", {{0., 0., no_end, "free"}}, data.str()};
    return {"winkler",
            {{a, 0., -M, "bonded"}, {0., 0., no_end, "broken"}},
            data.str()};
  }



  namespace
  {
    const std::string stiffness_path = "Contact law/Bond stiffness";
    const std::string threshold_path = "Contact law/Bond threshold";
    const std::string strength_path  = "Contact law/Bond strength";
    const std::string energy_path    = "Contact law/Fracture energy";



    /// Numbers or expressions.
    struct BondTexts
    {
      std::string stiffness, threshold, strength, energy;
    };



    /// As a scene has them.
    struct BondEntries
    {
      BondTexts everywhere = {"69", "0.002", "", ""};

      /// By the names of boundaries.
      std::map<std::string, std::string> stiffnesses, thresholds, strengths,
        energies;
    };



    Pattern
    quantity_or_expression(const bool may_be_zero)
    {
      const Pattern number = quantity(may_be_zero);
      return Pattern(number.description() + ", or an expression",
                     [number](const std::string &value) {
                       double unused;
                       return !read_number(value, unused) ||
                              number.match(value);
                     });
    }



    /// Stiffness and threshold from the two that are given, of entries with @p
    /// suffix behind their names.
    void
    complete(const std::string &suffix, BondTexts &bonds, ParameterTable &table)
    {
      std::string &a = bonds.stiffness, &M = bonds.threshold,
                  &t = bonds.strength, &G = bonds.energy;
      if (t.empty() && G.empty())
        {
          const std::string &missing =
            a.empty() ? stiffness_path : threshold_path;
          if (a.empty() || M.empty())
            table.reject(table.is_set(missing + suffix) ? missing + suffix :
                                                          missing,
                         "bonds need a stiffness and a threshold, or two of "
                         "these, Bond strength and Fracture energy");
          return;
        }
      const std::string source =
        (t.empty() ? energy_path : strength_path) + suffix;
      const bool has_a = !a.empty() && table.is_set(stiffness_path + suffix);
      const bool has_M = !M.empty() && table.is_set(threshold_path + suffix);
      if (has_a + has_M + !t.empty() + !G.empty() != 2)
        {
          table.reject(source,
                       "two of Bond stiffness, Bond threshold, Bond strength "
                       "and Fracture energy are given" +
                         (suffix.empty() ? "" : " for" + suffix) +
                         ", no more and no fewer",
                       {stiffness_path + suffix,
                        threshold_path + suffix,
                        strength_path + suffix,
                        energy_path + suffix});
          return;
        }
      const auto is_number = [](const std::string &text) {
        double unused;
        return read_number(text, unused);
      };
      // A number of numbers, else an expression of expressions.
      const auto combine = [&](const std::string                           &p,
                               const std::string                           &q,
                               const std::function<double(double, double)> &f,
                               const std::string &first,
                               const std::string &middle,
                               const std::string &last) {
        return is_number(p) && is_number(q) ?
                 shortest_text(f(std::stod(p), std::stod(q))) :
                 first + '(' + p + ')' + middle + '(' + q + ')' + last;
      };
      const auto  quotient = [](double p, double q) { return p / q; };
      std::string new_a = a, new_M = M;
      if (!has_a && !has_M)
        {
          new_a = combine(
            t,
            G,
            [](double p, double q) { return p * p / (2. * q); },
            "",
            "^2/(2*",
            ")");
          new_M = combine(
            G, t, [](double p, double q) { return 2. * p / q; }, "2*", "/", "");
        }
      else if (has_a)
        new_M = t.empty() ?
                  combine(
                    G,
                    a,
                    [](double p, double q) { return std::sqrt(2. * p / q); },
                    "sqrt(2*",
                    "/",
                    ")") :
                  combine(t, a, quotient, "", "/", "");
      else
        new_a = t.empty() ?
                  combine(
                    G,
                    M,
                    [](double p, double q) { return 2. * p / (q * q); },
                    "2*",
                    "/",
                    "^2") :
                  combine(t, M, quotient, "", "/", "");
      // A threshold of 0 or a quotient by 0.
      const auto is_impossible = [](const std::string &text,
                                    const bool         may_be_zero) {
        return text == "inf" || text == "nan" || text == "-nan" ||
               !quantity_or_expression(may_be_zero).match(text);
      };
      for (const auto &[name, text, may_be_zero] :
           {std::make_tuple("stiffness", new_a, true),
            std::make_tuple("threshold", new_M, false)})
        if (is_impossible(text, may_be_zero))
          {
            table.reject(source,
                         std::string("the ") + name + " would be " + text);
            return;
          }
      a = new_a;
      M = new_M;
      t.clear();
      G.clear();
      // The effective scene has one pair only.
      table.derive(stiffness_path + suffix, a, source);
      table.derive(threshold_path + suffix, M, source);
      for (const std::string &path : {strength_path, energy_path})
        if (table.is_set(path + suffix))
          table.derive(path + suffix, "", path + suffix);
    }



    /// What a boundary does not say of its bonds is as everywhere.
    std::map<std::string, ContactLawParameters::Bonds>
    bonds_of_boundaries(const BondEntries &entries, ParameterTable &table)
    {
      std::map<std::string, BondTexts> texts;
      for (const auto &[name, text] : entries.stiffnesses)
        texts[name].stiffness = text;
      for (const auto &[name, text] : entries.thresholds)
        texts[name].threshold = text;
      for (const auto &[name, text] : entries.strengths)
        texts[name].strength = text;
      for (const auto &[name, text] : entries.energies)
        texts[name].energy = text;

      std::map<std::string, ContactLawParameters::Bonds> result;
      for (auto &[name, bonds] : texts)
        {
          if (bonds.strength.empty() && bonds.energy.empty())
            {
              if (bonds.stiffness.empty())
                bonds.stiffness = entries.everywhere.stiffness;
              if (bonds.threshold.empty())
                bonds.threshold = entries.everywhere.threshold;
            }
          complete(' ' + name, bonds, table);
          result[name] = {bonds.stiffness, bonds.threshold};
        }
      return result;
    }



    /// The number that fields are relative to: that of the first text that is
    /// a positive number.
    double
    reference_value(const std::vector<std::string> &texts)
    {
      double value;
      for (const std::string &text : texts)
        if (read_number(text, value) && value > 0.)
          return value;
      return 1.;
    }



    ContactLawParameters
    law_of(const BondTexts                                          &everywhere,
           const std::map<std::string, ContactLawParameters::Bonds> &boundaries)
    {
      double     a = 1., M = 1.;
      const bool a_is_number = read_number(everywhere.stiffness, a);
      const bool M_is_number = read_number(everywhere.threshold, M);
      if (boundaries.empty() && a_is_number && (M_is_number || a == 0.))
        return winkler_law(a, M);

      std::vector<std::string> stiffnesses = {everywhere.stiffness};
      std::vector<std::string> thresholds  = {everywhere.threshold};
      for (const auto &[name, bonds] : boundaries)
        {
          stiffnesses.push_back(bonds.stiffness);
          thresholds.push_back(bonds.threshold);
        }
      ContactLawParameters law =
        winkler_law(reference_value(stiffnesses), reference_value(thresholds));
      law.data =
        "a = " + everywhere.stiffness + ", M = " + everywhere.threshold;
      if (!a_is_number || a == 0.)
        law.stiffness = everywhere.stiffness;
      if (!M_is_number)
        law.threshold = everywhere.threshold;
      law.boundaries = boundaries;
      return law;
    }
  } // namespace



  LawKind
  winkler_kind()
  {
    return {
      "winkler",
      "is the paper's, with bonds that pull in proportion to the "
      "displacement and break at the threshold",
      [](ParameterTable &table) -> LawMaker {
        const auto        entries = std::make_shared<BondEntries>();
        const std::string expression =
          ", a number or an expression in x, y (and z) as in Loads";
        const auto bind = [&](const std::string                  &path,
                              std::string                        &everywhere,
                              std::map<std::string, std::string> &boundaries,
                              const bool                          may_be_zero,
                              const std::string                  &documentation,
                              const std::string                  &units) {
          const Pattern pattern = quantity_or_expression(may_be_zero);
          table.bind(path, everywhere, pattern, documentation, units);
          table.bind_family(
            path,
            boundaries,
            pattern,
            documentation +
              ", on the contact boundary or part of this name. Of stiffness "
              "and threshold, the one that is not given for it is that of all",
            units);
        };
        bind(stiffness_path,
             entries->everywhere.stiffness,
             entries->stiffnesses,
             true,
             "a" + expression + ": zero where there are no bonds",
             "force per volume");
        bind(threshold_path,
             entries->everywhere.threshold,
             entries->thresholds,
             false,
             "M, the displacement at which bonds break" + expression,
             "length");
        bind(
          strength_path,
          entries->everywhere.strength,
          entries->strengths,
          true,
          "a M, the traction at which bonds break, likewise. Two of stiffness, threshold, strength and fracture energy are given, the other two follow. Bonds that soften begin to do so at it, and have stiffness, strength and fracture energy, three numbers",
          "force per area");
        bind(energy_path,
             entries->everywhere.energy,
             entries->energies,
             true,
             "a M^2/2, what it takes to break bonds, likewise",
             "energy per area");
        return [entries](ParameterTable &all) {
          complete("", entries->everywhere, all);
          const auto boundaries = bonds_of_boundaries(*entries, all);
          return law_of(entries->everywhere, boundaries);
        };
      },
      "Contact law/Bond stiffness, Contact law/Bond threshold, Contact law/Bond strength, Contact law/Fracture energy"};
  }
} // namespace Debond
