// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/base/tolerances.h>
#include <debond/contact/laws/curve.h>
#include <debond/contact/laws/softening.h>

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



    /// A law of three numbers.
    template <ContactLawParameters (*law_of)(const SofteningBonds &)>
    LawMaker
    maker(ParameterTable &)
    {
      // Each number is checked by itself first, then all of them together, so
      // that an error names the entry at fault. That bonds would take less than
      // they have stored is an error of the fracture energy.
      return [](ParameterTable &table) {
        const std::string for_winkler =
          "is for Law = winkler: bonds that soften are the same everywhere but "
          "for the Traction factor";
        // The bonds of Law = winkler vary by stiffness and threshold, which
        // scale one law. Three numbers that vary would change its shape from
        // point to point, so only a factor of the tractions may vary here.
        // Entries for one boundary have its name behind that of the entry.
        for (const auto &[path, unused] : table.locations())
          for (const std::string &entry :
               {of_stiffness, of_strength, of_energy})
            if (path.compare(0, entry.size() + 1, entry + ' ') == 0 &&
                table.is_set(path))
              table.reject(path, for_winkler);
        // A number that is not given here has a default for Law = winkler,
        // which is none for other laws.
        SofteningBonds bonds   = {};
        bool           has_all = true;
        for (const auto &[path, number] :
             {std::make_pair(of_stiffness, &bonds.stiffness),
              std::make_pair(of_strength, &bonds.strength),
              std::make_pair(of_energy, &bonds.energy)})
          if (!table.is_set(path) || !read_number(table.get(path), *number))
            {
              table.reject(
                path,
                "bonds that soften need a Bond stiffness, a Bond "
                "strength and a Fracture energy, three numbers; where they "
                "differ, Traction factor says");
              has_all = false;
            }
        if (!has_all)
          return ContactLawParameters();
        try
          {
            ContactLawParameters law = law_of(bonds);
            add_traction_factor(table, law);
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
