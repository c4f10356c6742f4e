// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/function_parser.h>

#include <debond/base/parameter_table.h>
#include <debond/contact/laws/winkler.h>

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
      if (!condition || !std::isfinite(value))
        throw std::invalid_argument(words(parameter,
                                          " = ",
                                          value,
                                          " is out of range: it must be ",
                                          range,
                                          " and finite"));
    }
  } // namespace



  ContactLawParameters
  winkler_law(const double bond_stiffness, const double bond_threshold)
  {
    const double a = bond_stiffness, M = bond_threshold;
    require_in_range(a >= 0., "Bond stiffness", a, ">= 0");
    require_in_range(M > 0., "Bond threshold", M, "> 0");

    // These are the pieces of (10) from s = 0 downwards. Without stiffness
    // there is nothing to break and M has no meaning, so both pieces are one.
    const std::string data = words("a = ", a, ", M = ", M);
    if (a == 0.)
      return {"winkler", {{0., 0., no_end, "free"}}, data};
    return {"winkler",
            {{a, 0., -M, "bonded"}, {0., 0., no_end, "broken"}},
            data};
  }



  namespace
  {
    /// Numbers or expressions for a, M, a M and a M^2/2, empty if not given.
    using Texts = std::array<std::string, 4>;

    const Texts paths = {{"Contact law/Bond stiffness",
                          "Contact law/Bond threshold",
                          "Contact law/Bond strength",
                          "Contact law/Fracture energy"}};

    /// How the two texts p and q give a and M, each empty if it is given.
    struct Formula
    {
      unsigned int p, q;
      std::string  a, M;
    };

    // All follow from the strength t = a M and the energy G = a M^2 / 2: so G /
    // t = M / 2 and t^2 / G = 2 a. Stiffness and threshold together need no
    // formula.
    const std::array<Formula, 5> formulas = {{{2, 3, "P^2/(2*Q)", "2*Q/P"},
                                              {3, 0, "", "sqrt(2*P/Q)"},
                                              {2, 0, "", "P/Q"},
                                              {3, 1, "2*P/Q^2", ""},
                                              {2, 1, "P/Q", ""}}};



    /// The texts of a scene.
    struct BondEntries
    {
      Texts everywhere = {{"69", "0.002", "", ""}};

      /// By the names of boundaries.
      std::array<std::map<std::string, std::string>, 4> of_boundaries;
    };



    Pattern
    quantity_or_expression(const bool may_be_zero)
    {
      // A text that is a number has to be a quantity; any other text may be an
      // expression, which is checked where it is evaluated.
      const Pattern number = quantity(may_be_zero);
      return Pattern(number.description() + ", or an expression",
                     [number](const std::string &value) {
                       double unused;
                       return !read_number(value, unused) ||
                              number.match(value);
                     });
    }



    /// Returns the formula with p and q in place of P and Q, or its value if
    /// both are numbers.
    std::string
    insert(const std::string &formula,
           const std::string &p,
           const std::string &q)
    {
      std::string result;
      for (const char c : formula)
        // Brackets, as p and q may be sums.
        result += c == 'P' ? '(' + p + ')' :
                  c == 'Q' ? '(' + q + ')' :
                             std::string(1, c);
      // Two numbers give a number, so that bonds that are the same everywhere
      // are not taken for a field.
      double number;
      if (!read_number(p, number) || !read_number(q, number))
        return result;
      dealii::FunctionParser<1> function;
      function.initialize("x", result, {});
      return shortest_text(function.value(dealii::Point<1>()));
    }



    /// Makes stiffness and threshold from the two texts that are given, those
    /// of entries with @p suffix behind their names.
    void
    complete(const std::string &suffix, Texts &bonds, ParameterTable &table)
    {
      // Without a strength or an energy there are a and M, which both have
      // defaults, unless an entry has been emptied on purpose.
      if (bonds[2].empty() && bonds[3].empty())
        {
          const std::string &missing = paths[bonds[0].empty() ? 0 : 1];
          if (bonds[0].empty() || bonds[1].empty())
            table.reject(table.is_set(missing + suffix) ? missing + suffix :
                                                          missing,
                         "bonds need a stiffness and a threshold, or two of "
                         "these, Bond strength and Fracture energy",
                         {"Contact law/Law"});
          return;
        }
      // Only what the scene sets counts as given: a default for a or M must not
      // contradict a strength or an energy.
      Texts    given = bonds;
      Texts    all   = paths;
      unsigned n     = 0;
      for (unsigned int k = 0; k < 4; ++k)
        {
          all[k] += suffix;
          if (k < 2 && !table.is_set(all[k]))
            given[k].clear(); // the default
          n += given[k].empty() ? 0 : 1;
        }
      const std::string source = all[bonds[2].empty() ? 3 : 2];
      if (n != 2)
        {
          table.reject(source,
                       "two of Bond stiffness, Bond threshold, Bond strength "
                       "and Fracture energy are given" +
                         (suffix.empty() ? "" : " for" + suffix) +
                         ", no more and no fewer",
                       {all[0], all[1], all[2], all[3], "Contact law/Law"});
          return;
        }
      // Two texts are given, and at most one of them is a or M, so that there
      // is one formula for them.
      for (const auto &[p, q, a, M] : formulas)
        if (!given[p].empty() && !given[q].empty())
          {
            if (!a.empty())
              given[0] = insert(a, given[p], given[q]);
            if (!M.empty())
              given[1] = insert(M, given[p], given[q]);
            break;
          }
      // A threshold of 0 or a quotient by 0.
      for (const unsigned int k : {0, 1})
        if (const std::string &text = given[k];
            text == "inf" || text == "nan" || text == "-nan" ||
            !quantity_or_expression(k == 0).match(text))
          {
            table.reject(source,
                         words("the ",
                               k == 0 ? "stiffness" : "threshold",
                               " would be ",
                               text));
            return;
          }
      bonds = given;
      // The effective scene has one pair only, a and M, which stand for any of
      // the pairs. The others are emptied, so that reading it again gives the
      // same bonds.
      table.derive(all[0], bonds[0], source);
      table.derive(all[1], bonds[1], source);
      for (const std::string &path : {all[2], all[3]})
        if (table.is_set(path))
          table.derive(path, "", path);
    }



    /// Returns the bonds of the boundaries that have some of their own; what a
    /// boundary does not say of them is as everywhere.
    std::map<std::string, ContactLawParameters::Bonds>
    bonds_of_boundaries(const BondEntries &entries, ParameterTable &table)
    {
      // The four maps by entry become one map by boundary.
      std::map<std::string, Texts> texts;
      for (unsigned int k = 0; k < 4; ++k)
        for (const auto &[name, text] : entries.of_boundaries[k])
          texts[name][k] = text;
      std::map<std::string, ContactLawParameters::Bonds> result;
      for (auto &[name, bonds] : texts)
        {
          // A boundary with one of a and M has the other one from everywhere. A
          // strength or an energy of its own needs a second entry for the same
          // boundary, which complete() insists on.
          for (const unsigned int k : {0, 1})
            if (bonds[k].empty() && bonds[2].empty() && bonds[3].empty())
              bonds[k] = entries.everywhere[k];
          complete(' ' + name, bonds, table);
          result[name] = {bonds[0], bonds[1]};
        }
      return result;
    }



    /// Returns the number that fields are relative to: that of the first text
    /// that is a positive number.
    double
    reference_value(
      const std::string &everywhere,
      std::string ContactLawParameters::Bonds::*const           text,
      const std::map<std::string, ContactLawParameters::Bonds> &boundaries)
    {
      // Fields scale one law, whose own numbers are arbitrary as long as they
      // are positive. With a number of the scene the scales are exactly 1 where
      // bonds have that number, and the law's data are those that a user
      // expects.
      double value;
      if (read_number(everywhere, value) && value > 0.)
        return value;
      for (const auto &[unused, bonds] : boundaries)
        if (read_number(bonds.*text, value) && value > 0.)
          return value;
      return 1.;
    }



    ContactLawParameters
    law_of(const Texts                                              &everywhere,
           const std::map<std::string, ContactLawParameters::Bonds> &boundaries)
    {
      double     a = 1., M = 1.;
      const bool a_is_number = read_number(everywhere[0], a);
      const bool M_is_number = read_number(everywhere[1], M);
      // Bonds that are the same everywhere are the law itself and need no
      // field.
      if (boundaries.empty() && a_is_number && (M_is_number || a == 0.))
        return winkler_law(a, M);

      using Bonds              = ContactLawParameters::Bonds;
      ContactLawParameters law = winkler_law(
        reference_value(everywhere[0], &Bonds::stiffness, boundaries),
        reference_value(everywhere[1], &Bonds::threshold, boundaries));
      law.data = "a = " + everywhere[0] + ", M = " + everywhere[1];
      // A stiffness of zero that only holds outside some boundaries is a field,
      // too: a law without stiffness could not be scaled to that of the
      // boundaries.
      if (!a_is_number || a == 0.)
        law.stiffness = everywhere[0];
      if (!M_is_number)
        law.threshold = everywhere[1];
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
        const std::vector<std::pair<std::string, std::string>> texts = {
          {"a" + expression + ": zero where there are no bonds",
           "force per volume"},
          {"M, the displacement at which bonds break" + expression, "length"},
          {"a M, the traction at which bonds break, likewise. Two of stiffness, threshold, strength and fracture energy are given, the other two follow. Bonds that soften begin to do so at it, and have stiffness, strength and fracture energy, three numbers",
           "force per area"},
          {"a M^2/2, what it takes to break bonds, likewise",
           "energy per area"}};
        for (unsigned int k = 0; k < 4; ++k)
          {
            const auto &[documentation, units] = texts[k];
            const Pattern pattern              = quantity_or_expression(k != 1);
            table.bind(
              paths[k], entries->everywhere[k], pattern, documentation, units);
            // An entry with the name of a boundary behind it is for that
            // boundary alone.
            table.bind_family(
              paths[k],
              entries->of_boundaries[k],
              pattern,
              documentation +
                ", on the contact boundary or part of this name. Of stiffness "
                "and threshold, the one that is not given for it is that of all",
              units);
          }
        return [entries](ParameterTable &all) {
          // Those for all boundaries come first, as boundaries take from them
          // what they do not say themselves.
          complete("", entries->everywhere, all);
          const auto           boundaries = bonds_of_boundaries(*entries, all);
          ContactLawParameters law = law_of(entries->everywhere, boundaries);
          law.is_by_stiffness      = true;
          return law;
        };
      },
      join({paths.begin(), paths.end()}, ", ")};
  }
} // namespace Debond
