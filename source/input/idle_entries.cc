// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/idle_entries.h>

#include <boost/algorithm/string/predicate.hpp>

#include <fstream>
#include <iterator>
#include <regex>

namespace Debond
{
  namespace
  {
    /// Returns how often the text has this word.
    std::size_t
    n_words(const std::string &word, const std::string &text)
    {
      const std::regex pattern("\\b" + word + "\\b");
      return std::distance(
        std::sregex_iterator(text.begin(), text.end(), pattern), {});
    }
  } // namespace



  std::set<std::string>
  idle_constants(const std::map<std::string, double> &constants,
                 const ParameterTable                &table)
  {
    // A constant is used if its name is a word of a text that the scene sets.
    // In Loads/Constants its definition is such a text itself, which counts
    // once; in the section Constants the name is in the path and not in the
    // text.
    std::set<std::string> idle;
    for (const auto &[name, unused] : constants)
      {
        const bool  in_section = table.is_set("Constants/" + name);
        std::size_t n_uses     = 0;
        for (const auto &[path, place] : table.locations())
          if (table.is_set(path))
            n_uses += n_words(name, table.get(path));
        if (n_uses == (in_section ? 0 : 1))
          idle.insert(name);
      }
    return idle;
  }



  void
  note_entries_without_effect(const Parameters            &p,
                              const BodyParameters        &body,
                              const std::set<std::string> &idle_constants,
                              ParameterTable              &table)
  {
    // A path searches by its global branch and a single load by the solver. A
    // geometry may use constants in DefineConstant, which only its text shows.
    const std::string method = "Solver/Method is " + to_string(p.solver.method);
    const bool is_euclidean = p.solver.method == SolverMethod::euclidean_bundle;
    const bool is_energy    = p.solver.method == SolverMethod::energy_bundle;
    const bool has_path     = !p.load_path.factors.empty();
    const bool has_branches =
      has_path && p.load_path.global_branch != GlobalBranch::none;
    const bool    searches = has_path ? has_branches : p.solver.searches();
    const bool    is_cold  = !p.materials.expands();
    std::ifstream file(
      boost::ends_with(body.file, ".geo") ? table.get("Mesh/File") : "");
    const std::string geometry(std::istreambuf_iterator<char>(file), {});
    for (const std::string &name : idle_constants)
      if (n_words(name, geometry) == 0)
        table.notes.push_back("no effect of the constant " + name +
                              ": nothing uses it");
    // An entry counts as given if the scene sets one whose path begins like
    // this, also that of a region or a boundary.
    const auto is_given = [&table](const std::string &beginning) {
      for (const auto &[path, unused] : table.locations())
        if (boost::starts_with(path, beginning) && table.is_set(path))
          return true;
      return false;
    };
    // The defaults are the paper's, for a strip of its length.
    const bool is_own = body.source != BodyParameters::Source::box ||
                        body.box.lengths[0] != BodyParameters().box.lengths[0];
    if (is_own && !is_given("Material/Young"))
      table.notes.push_back("the Young modulus is the default one, 69 GPa");
    if ((is_own || table.is_set("Material/Young modulus")) &&
        !p.contact_boundaries.empty() && p.law.is_by_stiffness &&
        !is_given("Contact law/Bond") &&
        !is_given("Contact law/Fracture energy"))
      table.notes.push_back(
        "the bonds are the default ones, 69 GPa/m up to 0.002 m: is the scene "
        "in m and GPa?");
    // Each line says when entries have no effect, why, and which they are; a
    // path that ends in '/' is a section. They are noted and not refused,
    // because the scene is solved in the same way without them.
    for (const auto &[is_idle, reason, entries] :
         std::vector<std::tuple<bool, std::string, std::string>>{
           {body.source != BodyParameters::Source::box,
            "Mesh/Source is not box",
            "Mesh/Lengths, Mesh/Cells, Mesh/Origin"},
           {p.dimension == 3, "Dimension is 3", "Material/Hypothesis"},
           {p.loads.temperature_change.empty(),
            "there is no Loads/Temperature change",
            "Material/Thermal expansion"},
           {is_cold,
            "there is no Material/Thermal expansion",
            "Loads/Temperature change"},
           {p.contact_boundaries.empty(),
            "there is no Contact boundary",
            "Contact law/, Boundary conditions/Foundation normal"},
           {!has_path, "there is no load path", "Load path/, Output/Load path"},
           {has_path && !p.load_path.moves_only(),
            "Displacement factors alone have to change for it",
            "Load path/Resolve"},
           {has_path && !has_branches,
            "the load path has no global branch",
            "Solver/Search"},
           {!searches && !p.solver.prove && !p.solver.has_other_proof,
            "nothing is proved",
            "Solver/Proof/"},
           {!p.solver.prove && !p.solver.has_other_proof,
            "nothing is proved",
            "Output/Proof"},
           {!is_euclidean, method, "Solver/Euclidean bundle/"},
           {!is_energy, method, "Solver/Energy bundle/"},
           {is_euclidean,
            method,
            "Solver/Linear solver, Solver/Majorise minimise/"},
           {is_energy && !searches && !p.solver.prove,
            method,
            "Solver/Majorise minimise/"}})
      if (is_idle)
        table.without_effect(entries, reason);
  }
} // namespace Debond
