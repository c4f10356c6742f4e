// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/number_text.h>
#include <debond/base/parameter_table.h>
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
      return {"winkler", {{0., 0., 0.L, "free"}}, data.str()};
    return {"winkler",
            {{a, 0., 0.L, "bonded"}, {0., 0., 0.5L * a * M * M, "broken"}},
            data.str()};
  }



  namespace
  {
    const std::string stiffness_path = "Contact law/Bond stiffness";
    const std::string threshold_path = "Contact law/Bond threshold";
    const std::string strength_path  = "Contact law/Bond strength";
    const std::string energy_path    = "Contact law/Fracture energy";



    /// Of Gamma_C, numbers or expressions.
    struct BondTexts
    {
      std::string stiffness = "69", threshold = "0.002", strength, energy;
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



    /// Stiffness and threshold from the two that are given.
    void
    complete(BondTexts &bonds, ParameterTable &table)
    {
      std::string &a = bonds.stiffness, &M = bonds.threshold,
                  &t = bonds.strength, &G = bonds.energy;
      if (t.empty() && G.empty())
        {
          if (a.empty() || M.empty())
            table.reject(a.empty() ? stiffness_path : threshold_path,
                         "bonds need a stiffness and a threshold, or two of "
                         "these, Bond strength and Fracture energy");
          return;
        }
      const bool has_a = !a.empty() && table.is_set(stiffness_path);
      const bool has_M = !M.empty() && table.is_set(threshold_path);
      if (has_a + has_M + !t.empty() + !G.empty() != 2)
        {
          table.reject(t.empty() ? energy_path : strength_path,
                       "two of Bond stiffness, Bond threshold, Bond strength "
                       "and Fracture energy are given, no more and no fewer");
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
            table.reject(t.empty() ? energy_path : strength_path,
                         std::string("the ") + name + " would be " + text);
            return;
          }
      a = new_a;
      M = new_M;
      t.clear();
      G.clear();
      // The effective scene has one pair only.
      table.assign(stiffness_path + '=' + a);
      table.assign(threshold_path + '=' + M);
      table.assign(strength_path + '=');
      table.assign(energy_path + '=');
    }



    ContactLawParameters
    law_of(const BondTexts &bonds)
    {
      double     a = 1., M = 1.;
      const bool a_is_number = read_number(bonds.stiffness, a);
      const bool M_is_number = read_number(bonds.threshold, M);
      if (a_is_number && (M_is_number || a == 0.))
        return winkler_law(a, M);
      ContactLawParameters law =
        winkler_law(a_is_number ? a : 1., M_is_number ? M : 1.);
      law.data = "a = " + bonds.stiffness + ", M = " + bonds.threshold;
      if (!a_is_number)
        law.stiffness = bonds.stiffness;
      if (!M_is_number)
        law.threshold = bonds.threshold;
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
        const auto        bonds = std::make_shared<BondTexts>();
        const std::string expression =
          ", a number or an expression in x, y (and z) as in Loads";
        table.bind(stiffness_path,
                   bonds->stiffness,
                   quantity_or_expression(true),
                   "a" + expression + ": zero where there are no bonds",
                   "force per volume");
        table.bind(threshold_path,
                   bonds->threshold,
                   quantity_or_expression(false),
                   "M, the displacement at which bonds break" + expression,
                   "length");
        table.bind(
          strength_path,
          bonds->strength,
          quantity_or_expression(true),
          "a M, the traction at which bonds break, likewise. Two of stiffness, threshold, strength and fracture energy are given, the other two follow",
          "force per area");
        table.bind(energy_path,
                   bonds->energy,
                   quantity_or_expression(true),
                   "a M^2/2, what it takes to break bonds, likewise",
                   "energy per area");
        return [bonds](ParameterTable &entries) {
          complete(*bonds, entries);
          return law_of(*bonds);
        };
      }};
  }
} // namespace Debond
