// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/contact_parameters.h>

#include <boost/algorithm/string/predicate.hpp>

namespace Debond
{
  const std::vector<std::pair<std::string, TangentialDisplacement>> &
  tangential_words()
  {
    static const std::vector<std::pair<std::string, TangentialDisplacement>>
      words = {{"fixed", TangentialDisplacement::fixed},
               {"free", TangentialDisplacement::free},
               {"bonded", TangentialDisplacement::bonded}};
    return words;
  }



  TangentialDisplacement
  tangential_named(const std::string &word)
  {
    // The pattern of the entry has allowed the word, so that it is found.
    const auto &words = tangential_words();
    return std::find_if(words.begin(),
                        words.end(),
                        [&word](const auto &entry) {
                          return entry.first == word;
                        })
      ->second;
  }



  void
  bind_boundaries(ProblemParameters &p, ParameterTable &table)
  {
    table.bind(
      "Boundary conditions/Clamped boundaries",
      p.clamped_boundaries,
      "Boundaries that form Gamma_D, where the displacement is zero. Of a box: left and right have the smallest and largest x, bottom and top y, back and front z (3D only). Commas separate names; a boundary's name that has commas itself is taken as a whole");
    table.bind(
      "Boundary conditions/Contact boundary",
      p.contact_boundaries,
      "Boundaries that form Gamma_C, where the body rests on the foundation");
  }



  namespace
  {
    /// Stiffness, strength and energy of bonds in shear.
    void
    bind_shear_numbers(ShearParameters &shear, ParameterTable &table)
    {
      // Without a text shear has the stiffness along the normal, which no
      // number could say.
      const auto none_or = [](const Pattern &number) {
        return Pattern("nothing, or " + number.description(),
                       [number](const std::string &text) {
                         return text.empty() || number.match(text);
                       });
      };
      // An entry with the name of a boundary behind it is for that boundary
      // alone.
      const auto bind_number = [&](const std::string      &path,
                                   ShearParameters::Entry &entry,
                                   const Pattern          &number,
                                   const std::string      &documentation,
                                   const std::string      &units) {
        table.bind(
          path, entry.everywhere, none_or(number), documentation, units);
        table.bind_family(path,
                          entry.boundaries,
                          number,
                          documentation +
                            ", on the contact boundary or part of this name",
                          units);
      };
      bind_number(
        "Contact law/Bond shear stiffness",
        shear.stiffness,
        quantity(true),
        "The stiffness of bonds in shear, with Tangential displacement = bonded: a number, or nothing for that along the normal. Where there are no bonds there are none in shear; the Traction factor multiplies both",
        "force per volume");
      bind_number(
        "Contact law/Bond shear strength",
        shear.strength,
        quantity(),
        "The strength of bonds that soften in shear, with a Mixed mode: a number, or nothing for that which follows from stiffness and energies with the form of the law",
        "force per area");
      bind_number(
        "Contact law/Shear fracture energy",
        shear.energy,
        quantity(),
        "What it takes to break bonds in shear, with Bond failure = separate or a Mixed mode: the law in shear has the same form, with this energy, the Bond shear stiffness and, unless Bond shear strength says another one, the strength that follows from these",
        "energy per area");
    }



    /// When bonds in shear break, and with which energy.
    void
    bind_failure(ShearParameters &shear, ParameterTable &table)
    {
      table.bind_choice(
        "Contact law/Failure criterion",
        shear.criterion,
        {{"quadratic", FailureCriterion::quadratic},
         {"largest", FailureCriterion::largest}},
        "When bonds with a Bond shear strength begin to soften: if the squares of the tractions along the normal and in shear, as parts of their strengths, sum up to 1, or if one of these parts is 1");
      table.bind_choice(
        "Contact law/Bond failure",
        shear.breaks_separately,
        {{"common", false}, {"separate", true}},
        "How bonded ones break: common, in all directions at once with one fracture energy, or separate, along the normal and in shear each by itself");
      // The pattern and the reader share this function, so that what is allowed
      // can be read. A name ends in a blank, behind which its exponent follows.
      const auto parse_mode = [](const std::string &text, double &exponent) {
        for (const auto &[name, mode] :
             {std::pair<std::string, MixedMode>{"benzeggagh-kenane ",
                                                MixedMode::benzeggagh_kenane},
              {"power law ", MixedMode::power_law}})
          if (boost::starts_with(text, name) &&
              read_number(text.substr(name.size()), exponent) && exponent > 0.)
            return std::make_optional(mode);
        return text == "none" ? std::make_optional(MixedMode::none) :
                                std::nullopt;
      };
      table.declare(
        "Contact law/Mixed mode",
        shear.mixed_mode_text,
        Pattern("none, benzeggagh-kenane ETA or power law ALPHA, with a number "
                "> 0",
                [parse_mode](const std::string &text) {
                  double unused;
                  return parse_mode(text, unused).has_value();
                }),
        "How the energy that breaks bonds in all directions at once depends on the part m of shear in what they store, between Fracture energy G_I and Shear fracture energy G_II: G_I + (G_II - G_I) m^ETA, or ((1 - m)^ALPHA / G_I^ALPHA + m^ALPHA / G_II^ALPHA)^(-1/ALPHA). Such bonds have no energy to minimise; along a load path each step has one with m of the step before",
        "none",
        [&shear, parse_mode](const std::string &text) {
          shear.mixed_mode      = *parse_mode(text, shear.exponent);
          shear.mixed_mode_text = text;
        });
    }
  } // namespace



  void
  bind_contact(ProblemParameters &p, ParameterTable &table)
  {
    table.declare(
      "Contact law/Quadrature",
      p.quadrature_name,
      Pattern("nodal, midpoint, or gauss N with N from 1 to 99"),
      "The quadrature of the adhesion energy on each face: at the vertices, at the midpoint, Gauss' rule with N points, at most 99 (in 3D for each direction, at most 7)",
      "none",
      [&p](const std::string &text) {
        p.quadrature      = ContactQuadratureParameters::parse(text);
        p.quadrature_name = text;
      });
    table.bind_choice(
      "Contact law/Tangential displacement",
      p.tangential_displacement,
      tangential_words(),
      "On the contact boundary: fixed is the paper's simplification u_tau = 0, free is sigma_tau = 0, bonded is bonds that bear shear as well, those of the law at the opening sqrt(p^2 + r |t|^2), p along the normal, t along the boundary and r = Bond shear stiffness / Bond stiffness");
    table.bind_family(
      "Contact law/Tangential displacement",
      p.tangential_displacements,
      one_of({"fixed", "free", "bonded"}),
      "u_tau on the contact boundary or part of this name, as above; vertices where it meets others are fixed if one of them is");
    bind_shear_numbers(p.shear, table);
    bind_failure(p.shear, table);
    table.bind_choice(
      "Contact law/Friction acts",
      p.friction.is_of_damage,
      {{"everywhere", false}, {"where bonds are damaged", true}},
      "Where friction is: everywhere, or where bonds are damaged in the proportion of their damage before the step of a load path with Bonds heal = false; where there are no bonds it is whole");
    const Pattern     expression("nothing, or an expression");
    const std::string where =
      ". Where there is friction the body may slide, and Tangential displacement = bonded are bonds besides; expressions as in Loads";
    const auto bind = [&](const std::string         &path,
                          FrictionParameters::Entry &entry,
                          const std::string         &documentation,
                          const std::string         &units) {
      table.bind(
        path, entry.everywhere, expression, documentation + where, units);
      table.bind_family(path,
                        entry.boundaries,
                        expression,
                        documentation + where +
                          "; on the contact boundary or part of this name",
                        units);
    };
    bind(
      "Contact law/Friction bound",
      p.friction.bound,
      "The traction along the contact boundary up to which nothing slides, whatever presses (Tresca)",
      "force per area");
    bind(
      "Contact law/Friction coefficient",
      p.friction.coefficient,
      "The traction along the contact boundary up to which nothing slides, over the pressure (Coulomb), on a load path; a Friction bound is added to it",
      "none");
  }
} // namespace Debond
