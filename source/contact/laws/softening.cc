// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/base/tolerances.h>
#include <debond/contact/laws/curve.h>
#include <debond/contact/laws/softening.h>

#include <array>
#include <optional>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    const std::string of_stiffness = "Contact law/Bond stiffness";
    const std::string of_strength  = "Contact law/Bond strength";
    const std::string of_energy    = "Contact law/Fracture energy";



    std::string
    data_of(const SofteningBonds &bonds)
    {
      return words("stiffness ",
                   bonds.stiffness,
                   ", strength ",
                   bonds.strength,
                   ", fracture energy ",
                   bonds.energy);
    }



    void
    check(const SofteningBonds &bonds)
    {
      for (const double number :
           {bonds.stiffness, bonds.strength, bonds.energy})
        if (!(number > 0.) || !std::isfinite(number))
          throw std::invalid_argument(
            "bonds that soften need numbers > 0, these have " + data_of(bonds));
      // Bonds that take less than they have stored at their strength would have
      // to give back energy: the traction would have to fall while the opening
      // shrinks.
      const double stored =
        bonds.strength * bonds.strength / (2. * bonds.stiffness);
      if (!(bonds.energy > stored))
        throw std::invalid_argument(
          words("it has to exceed strength^2 / (2 stiffness) = ",
                stored,
                ", which a bond gives back when it breaks; equal to it is Law "
                "= winkler"));
    }



    /// The numbers or expressions of bonds, in the order of softening_paths.
    using SofteningTexts = std::array<std::string, 3>;

    const SofteningTexts softening_paths = {
      {of_stiffness, of_strength, of_energy}};



    /// Returns these bonds if all are numbers.
    std::optional<SofteningBonds>
    numbers_of(const SofteningTexts &texts)
    {
      SofteningBonds bonds = {};
      if (read_number(texts[0], bonds.stiffness) &&
          read_number(texts[1], bonds.strength) &&
          read_number(texts[2], bonds.energy))
        return bonds;
      return {};
    }



    /// The bonds of a field: the first piece ends at strength over stiffness.
    ContactLawParameters::Bonds
    bonds_of(const SofteningTexts &texts)
    {
      // Where there is no stiffness there are no bonds and no threshold.
      const std::optional<SofteningBonds> numbers = numbers_of(texts);
      return {texts[0],
              !numbers ? '(' + texts[1] + ") / (" + texts[0] + ')' :
              numbers->stiffness == 0. ?
                         "1" :
                         shortest_text(numbers->strength / numbers->stiffness),
              texts[2]};
    }



    /// The texts of boundaries that have some of their own, by their names;
    /// what a boundary does not say is as @p everywhere.
    std::map<std::string, SofteningTexts>
    texts_of_boundaries(const ParameterTable &table,
                        const SofteningTexts &everywhere)
    {
      // Entries for one boundary have its name behind that of the entry.
      std::map<std::string, SofteningTexts> result;
      for (const auto &[path, unused] : table.locations())
        for (unsigned int k = 0; k < softening_paths.size(); ++k)
          if (path.compare(0,
                           softening_paths[k].size() + 1,
                           softening_paths[k] + ' ') == 0 &&
              table.is_set(path) && !table.get(path).empty())
            result
              .emplace(path.substr(softening_paths[k].size() + 1), everywhere)
              .first->second[k] = table.get(path);
      return result;
    }



    /// A law of three numbers, or of some for each place.
    template <ContactLawParameters (*law_of)(const SofteningBonds &)>
    LawMaker
    maker(ParameterTable &)
    {
      // Each number is checked by itself first, then all of them together, so
      // that an error names the entry at fault. That bonds would take less than
      // they have stored is an error of the fracture energy. Of bonds that vary
      // it shows where they are evaluated.
      return [](ParameterTable &table) {
        // A number that is not given here has a default for Law = winkler,
        // which is none for other laws.
        SofteningTexts everywhere;
        bool           has_all = true;
        for (unsigned int k = 0; k < softening_paths.size(); ++k)
          if (everywhere[k] = table.get(softening_paths[k]);
              !table.is_set(softening_paths[k]) || everywhere[k].empty())
            {
              table.reject(softening_paths[k],
                           "bonds that soften need a Bond stiffness, a Bond "
                           "strength and a Fracture energy");
              has_all = false;
            }
        if (!has_all)
          return ContactLawParameters();
        const auto boundaries = texts_of_boundaries(table, everywhere);
        const std::optional<SofteningBonds> same = numbers_of(everywhere);
        try
          {
            ContactLawParameters law =
              law_of(same && same->stiffness > 0. ? *same :
                                                    SofteningBonds{1., 1., 1.});
            if (same && boundaries.empty())
              {
                law_of(*same);
                add_traction_factor(table, law);
                return law;
              }
            // The law itself is any of them, which the others scale.
            table.without_effect(traction_factor,
                                 "bonds vary by stiffness, strength and "
                                 "fracture energy",
                                 of_stiffness);
            const ContactLawParameters::Bonds bonds = bonds_of(everywhere);
            law.is_by_stiffness                     = true;
            law.stiffness                           = bonds.stiffness;
            law.threshold                           = bonds.threshold;
            law.energy                              = bonds.energy;
            law.data                                = words("stiffness ",
                             everywhere[0],
                             ", strength ",
                             everywhere[1],
                             ", fracture energy ",
                             everywhere[2]);
            for (const auto &[name, texts] : boundaries)
              law.boundaries[name] = bonds_of(texts);
            return law;
          }
        catch (const std::invalid_argument &error)
          {
            table.reject(of_energy, error.what(), {of_stiffness, of_strength});
            return ContactLawParameters();
          }
      };
    }



    const std::string softening_entries = of_stiffness + ", " + of_strength +
                                          ", " + of_energy + ", " +
                                          traction_factor;
  } // namespace



  ContactLawParameters
  bilinear_law(const SofteningBonds &bonds)
  {
    check(bonds);
    // The energy is the area of the triangle below the three points, strength
    // times the last opening divided by two. What is brittle but for rounding
    // breaks at once.
    const double         first = bonds.strength / bonds.stiffness;
    const double         last  = 2. * bonds.energy / bonds.strength;
    ContactLawParameters law   = curve_law(
      {{0., 0.},
         {first, bonds.strength},
         {last > (1. + Tolerance::brittle) * first ? last : first, 0.}});
    law.name = "bilinear";
    law.data = data_of(bonds);
    // The quotient of strength and opening has lost its last digit.
    law.pieces[0].curvature = bonds.stiffness;
    return law;
  }



  ContactLawParameters
  exponential_law(const SofteningBonds &bonds)
  {
    check(bonds);
    // The spring has stored this much when it reaches the strength. The rest of
    // the energy belongs to the falling part, whose area has to be what
    // remains.
    const double stored =
      bonds.strength * bonds.strength / (2. * bonds.stiffness);
    return {"exponential",
            {{bonds.stiffness, 0., -bonds.strength / bonds.stiffness, "bonded"},
             // The decay with which the area below the falling part is the rest
             // of the fracture energy, strength / decay.
             {0.,
              -bonds.strength,
              no_end,
              "softening",
              bonds.strength / (bonds.energy - stored)}},
            data_of(bonds)};
  }



  LawKind
  bilinear_kind()
  {
    return {"bilinear",
            "softens: springs of the Bond stiffness up to the Bond strength, "
            "whose traction then falls in a straight line while they take the "
            "Fracture energy",
            maker<bilinear_law>,
            softening_entries};
  }



  LawKind
  exponential_kind()
  {
    return {"exponential",
            "the same with a traction that falls exponentially",
            maker<exponential_law>,
            softening_entries};
  }
} // namespace Debond
