// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/suggestion.h>
#include <debond/base/text.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <map>
#include <regex>
#include <tuple>
#include <utility>

namespace Debond
{
  namespace
  {
    /// Counts the insertions, deletions, substitutions and transpositions of
    /// neighbours that turn one word into the other (Damerau's distance in its
    /// restricted form, in which no part is edited twice).
    std::size_t
    edit_distance(const std::string &s, const std::string &t)
    {
      // distance[i][j] is that of the first i letters of s from the first j
      // letters of t. Each one follows from those of shorter beginnings: the
      // last letter is deleted, inserted or replaced, or the last two are
      // exchanged. This takes |s| |t| operations, which is nothing for names.
      std::vector<std::vector<std::size_t>> distance(
        s.size() + 1, std::vector<std::size_t>(t.size() + 1));
      for (std::size_t i = 0; i <= s.size(); ++i)
        for (std::size_t j = 0; j <= t.size(); ++j)
          {
            std::size_t &d = distance[i][j] = i + j;
            if (i == 0 || j == 0)
              continue;
            d = std::min({distance[i - 1][j] + 1,
                          distance[i][j - 1] + 1,
                          distance[i - 1][j - 1] + (s[i - 1] != t[j - 1])});
            if (i > 1 && j > 1 && s[i - 1] == t[j - 2] && s[i - 2] == t[j - 1])
              d = std::min(d, distance[i - 2][j - 2] + 1);
          }
      return distance[s.size()][t.size()];
    }
  } // namespace



  std::string
  suggestion(const std::string &path, const std::vector<std::string> &known)
  {
    // Three questions are asked in turn: whether the word stands for something
    // that the program does not have, whether it is another program's word for
    // an entry, and whether an entry has nearly the same name. The first one
    // comes before the others, since a name that looks similar would be a wrong
    // hint there.
    if (path == "Study")
      return "; this is a study: run scripts/study";
    static const std::map<std::string, std::string> absent = {
      {"plastic|yield|hardening", "plasticity"},
      {"visc|creep|damping", "viscosity"},
      {"density|\\bmass|veloc|accelerat|time step",
       "inertia (weight is Loads/Body force)"},
      {"(large|finite) (displ|strain|rot|def)", "large displacements"},
      {"penalt", "penalty: contact is exact"},
      {"moment|torque",
       "moments as loads: a traction that varies, such as 3*(y - 1); 0, has one"},
      {"fatigue", "fatigue"},
      {"\\btie\\b", "ties: regions of one mesh hold together without"},
      {"\\b(end )?time\\b", "time: loads grow along Load path/Factors"}};
    for (const auto &[words, what] : absent)
      if (std::regex_search(path, std::regex(words, std::regex::icase)))
        return "; Debond has no " + what +
               ", see 'What the model does not contain' in "
               "doc/guide/answers.md";

    // Case does not count in comparisons, and the section is compared apart
    // from the name: the same name in another section is a better guess than a
    // different name in the same one.
    const auto split = [](std::string text) {
      boost::to_lower(text);
      const std::size_t name = text.rfind('/') + 1; // 0 without a section
      return std::make_pair(text.substr(0, name), text.substr(name));
    };
    // Two letters are part of too many words to mean anything.
    const auto has = [](const std::string &word, const std::string &part) {
      return part.size() > 2 && word.find(part) != std::string::npos;
    };
    // The words of other programs for cohesive laws and materials are
    // translated before names are compared. They are regular expressions on the
    // whole path, in which a name begins after the slash.
    static const std::map<std::string, std::string> synonyms = {
      {"\\bg_?i?_?c\\b|toughness|critical energy", "Fracture energy"},
      {"\\bcte\\b|/alpha$", "Thermal expansion"},
      {"/(e|elastic\\w* modulus|stiffness)$", "Young modulus"},
      {"/nu$", "Poisson ratio"},
      {"gravity|/weight$", "Body force"},
      {"symmetry", "Roller boundaries"},
      {"tangential stiffness|shear strength|/k_?(ss|tt|t)$",
       "Bond shear stiffness"},
      {"/k_?nn?$", "Bond stiffness"},
      {"/(mu|friction|[a-z ]*coulomb[a-z ]*)$", "Friction coefficient"},
      {"mode (ii|2) energy|\\bg_?ii_?c\\b", "Shear fracture energy"},
      {"cohesive", "Bond"}};
    std::string translated = path;
    for (const auto &[words, ours] : synonyms)
      translated = std::regex_replace(translated,
                                      std::regex(words, std::regex::icase),
                                      ours);
    const auto [section, name] = split(translated);
    std::vector<std::tuple<std::size_t, std::size_t, std::string>> near;
    std::vector<std::string>                                       siblings;
    for (const std::string &other : known)
      {
        // The members of a family end in a name that the scene chooses, so that
        // only the words before it can be compared.
        const bool is_family = boost::ends_with(other, " NAME");
        const auto [its_section, its_name] =
          split(boost::erase_last_copy(other, " NAME"));
        const std::string word =
          is_family ? name.substr(0, name.rfind(' ')) : name;
        const std::size_t distance = edit_distance(word, its_name);
        if (distance <= std::max<std::size_t>(2, word.size() / 3) ||
            (!is_family && (has(its_name, name) || has(name, its_name))))
          near.emplace_back(distance,
                            edit_distance(section, its_section),
                            other);
        if (other.substr(0, other.rfind('/') + 1) ==
            path.substr(0, path.rfind('/') + 1))
          siblings.push_back(other);
      }
    // The order of the tuples is that of the names' distance, then of the
    // sections' distance, then of the alphabet, so that the suggestions are the
    // same on each machine.
    std::sort(near.begin(), near.end());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, near.size()); ++i)
      names.push_back(std::get<2>(near[i]));
    return !names.empty()   ? "; did you mean " + join(names, " or ") + "?" :
           siblings.empty() ? "" :
                              "; known are " + join(siblings, ", ");
  }
} // namespace Debond
