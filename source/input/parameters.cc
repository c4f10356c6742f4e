// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/memory.h>
#include <debond/input/mesh_parameters.h>
#include <debond/input/parameters.h>
#include <debond/input/probe_parameters.h>

#include <boost/algorithm/string/predicate.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace Debond
{
  BadInput::BadInput(const std::vector<std::string> &errors)
    : std::invalid_argument(join(errors, "\n"))
    , lines(errors)
  {}



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



    void
    bind_boundaries(Parameters &p, ParameterTable &table)
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



    void
    bind_contact(Parameters &p, ParameterTable &table)
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
        {{"fixed", TangentialDisplacement::fixed},
         {"free", TangentialDisplacement::free},
         {"bonded", TangentialDisplacement::bonded}},
        "On the contact boundary: fixed is the paper's simplification u_tau = 0, free is sigma_tau = 0, bonded is bonds that bear shear as well, those of the law at the opening sqrt(p^2 + r |t|^2), p along the normal, t along the boundary and r = Bond shear stiffness / Bond stiffness");
      table.bind_family(
        "Contact law/Tangential displacement",
        p.tangential_displacements,
        one_of({"fixed", "free", "bonded"}),
        "u_tau on the contact boundary or part of this name, as above; vertices where it meets others are fixed if one of them is");
      const auto none_or = [](const Pattern &number) {
        return Pattern("nothing, or " + number.description(),
                       [number](const std::string &text) {
                         return text.empty() || number.match(text);
                       });
      };
      table.bind(
        "Contact law/Bond shear stiffness",
        p.shear.stiffness,
        none_or(quantity(true)),
        "The stiffness of bonds in shear, with Tangential displacement = bonded: a number, or nothing for that along the normal. Where there are no bonds there are none in shear; the Traction factor multiplies both",
        "force per volume");
      table.bind_choice(
        "Contact law/Bond failure",
        p.shear.breaks_separately,
        {{"common", false}, {"separate", true}},
        "How bonded ones break: common, in all directions at once with one fracture energy, or separate, along the normal and in shear each by itself");
      table.bind(
        "Contact law/Shear fracture energy",
        p.shear.energy,
        none_or(quantity()),
        "What it takes to break bonds in shear, with Bond failure = separate or a Mixed mode: the law in shear has the same form, with this energy and the Bond shear stiffness, so that its strength is the one that follows from these",
        "energy per area");
      const auto parse_mode = [](const std::string &text, double &exponent) {
        using MixedMode = ShearParameters::MixedMode;
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
        p.shear.mixed_mode_text,
        Pattern("none, benzeggagh-kenane ETA or power law ALPHA, with a number "
                "> 0",
                [parse_mode](const std::string &text) {
                  double unused;
                  return parse_mode(text, unused).has_value();
                }),
        "How the energy that breaks bonds in all directions at once depends on the part m of shear in what they store, between Fracture energy G_I and Shear fracture energy G_II: G_I + (G_II - G_I) m^ETA, or ((1 - m)^ALPHA / G_I^ALPHA + m^ALPHA / G_II^ALPHA)^(-1/ALPHA). Such bonds have no energy to minimise; along a load path each step has one with m of the step before",
        "none",
        [&p, parse_mode](const std::string &text) {
          p.shear.mixed_mode      = *parse_mode(text, p.shear.exponent);
          p.shear.mixed_mode_text = text;
        });
    }

  } // namespace



  SceneTable::SceneTable(CompanionEntries *const companion)
    : companion(companion)
  {
    bind_constants(constants, *this);
    bind("Dimension", p.dimension, whole_number(2, 3), "Space dimension");
    bind_choice(
      "Symmetry",
      p.symmetry,
      {{"none", Symmetry::none}, {"axis", Symmetry::axis}},
      "With axis the plane mesh is half of a section of a body of revolution: x is the distance from its axis, on which nodes are held along x, and y is along the axis. Forces, energies and areas are those of the whole circle");
    bind_mesh(body, *this);
    bind(
      "Mesh/Degree",
      p.degree,
      whole_number(1, 2),
      "Degree of the displacement on each triangle or tetrahedron: linear, as in the paper, or quadratic, which has a much smaller error for as many unknowns and no locking; it needs Contact law/Quadrature = gauss N");
    bind_parts(parts, *this);
    bind_probes(p.probes, *this);
    bind_material(p.materials, *this);
    bind_boundaries(p, *this);
    bind_loads(p.loads, *this);
    bind_load_path(p.load_path, *this);
    laws.bind(*this);
    bind_supports(p.supports, *this);
    bind_contact(p, *this);
    bind_solver(p.solver, *this);
    bind_accuracy(p.accuracy, p.verification, *this);
    if (companion != nullptr)
      companion->bind(*this);
    bind_output(p.output, *this);
  }



  void
  SceneTable::evaluate()
  {
    p.loads.constants = body.meshing.constants = constants_of(*this);
    // A misspelt constant has no effect, however a study varies it.
    for (const auto &[name, unused] : p.loads.constants)
      {
        const bool  in_section = is_set("Constants/" + name);
        std::size_t n_uses     = 0;
        for (const auto &[path, place] : locations())
          if (is_set(path))
            n_uses += n_words(name, get(path));
        if (n_uses == (in_section ? 0 : 1))
          idle_constants.insert(name);
      }
    take_values([this](const std::string &text) {
      return with_values(text, p.loads.constants);
    });
  }



  void
  read_scene(const std::string &scene, ParameterTable &table)
  {
    // Output goes into folders of this name.
    const std::string name = std::filesystem::path(scene).stem().string();
    if (printable(scene) != scene || name == "." || name == "..")
      throw BadInput({scene + ": no scene may have this name"});
    std::error_code error;
    if (!std::filesystem::exists(scene, error))
      throw BadInput({scene + ": there is no such file"});
    std::ifstream input(scene);
    if (!input || std::filesystem::is_directory(scene) ||
        std::filesystem::is_character_file(scene))
      throw BadInput({scene + ": cannot be read as a scene file"});
    if (input.peek() >= 0xfe)
      throw BadInput({scene + ": this is UTF-16; save it as UTF-8"});
    const std::string ending = std::filesystem::path(scene).extension();
    if (input.peek() == '{' || ending == ".json")
      throw BadInput({scene + ": this is JSON; a scene is a .prm file, as "
                              "debond --print-parameters prints it"});
    for (const std::string mesh : {".geo",
                                   ".msh",
                                   ".step",
                                   ".stp",
                                   ".stl",
                                   ".unv",
                                   ".inp",
                                   ".vtu",
                                   ".brep"})
      if (boost::iequals(ending, mesh))
        throw BadInput(
          {scene +
           ": this is a mesh or a geometry; a scene (.prm) has it as Mesh/File, with Mesh/Source = file"});
    table.read(input, scene);
  }



  namespace
  {
    void
    check_boundaries(Parameters &p, ParameterTable &table)
    {
      const std::string clamped = "Boundary conditions/Clamped boundaries";
      const std::string contact = "Boundary conditions/Contact boundary";
      // Without a body there is an error already.
      if (p.body)
        {
          const std::set<std::string> known = p.body->boundaries();
          join_names(table.get(clamped), known, p.clamped_boundaries);
          join_names(table.get(contact), known, p.contact_boundaries);
          join_names(table.get("Boundary conditions/Roller boundaries"),
                     known,
                     p.supports.rollers);
          check_names(clamped, p.clamped_boundaries, *p.body, table);
          check_names(contact, p.contact_boundaries, *p.body, table);
          for (const SurfaceLoad &load : p.loads.on_boundaries())
            check_names(load.entry(), {load.boundary}, *p.body, table);
        }

      for (const std::string &side : p.contact_boundaries)
        if (p.clamped_boundaries.count(side) > 0)
          table.reject(contact,
                       "the side " + side +
                         " is clamped already, by Clamped boundaries",
                       {clamped});
    }



    /// Checks bonds that vary, as the scene gives them, and the names in
    /// entries that contact boundaries have of their own.
    void
    check_bonds(const Parameters &p, ParameterTable &table)
    {
      for (const auto &[path, unused] : table.locations())
        for (const std::string name : {"Bond stiffness",
                                       "Bond threshold",
                                       "Bond strength",
                                       "Fracture energy",
                                       "Traction factor",
                                       "Tangential displacement"})
          if (const std::string entry = "Contact law/" + name;
              boost::starts_with(path + ' ', entry + ' ') && table.is_set(path))
            {
              if (p.body && path != entry && !table.get(path).empty())
                check_names(path,
                            {path.substr(entry.size() + 1)},
                            *p.body,
                            table);
              if (name != "Tangential displacement")
                check_expression(path,
                                 table.get(path),
                                 p.dimension,
                                 1,
                                 p.loads.constants,
                                 table);
            }
      using Rule = ContactQuadratureParameters::Rule;
      if (p.load_path.arc && p.degree == 1 && p.quadrature.rule != Rule::nodal)
        table.reject("Load path/Arc",
                     "needs Contact law/Quadrature = nodal, which gives each "
                     "node a bond of its own",
                     {"Contact law/Quadrature"});
    }



    /// Entries that cannot be together with what @p others say, and why.
    using Refusals = std::vector<std::tuple<bool, std::string, std::string>>;

    void
    refuse(const Refusals                 &refusals,
           const std::vector<std::string> &others,
           ParameterTable                 &table)
    {
      for (const auto &[is_set, entry, reason] : refusals)
        if (is_set)
          table.reject(entry, reason, others);
    }



    /// Refuses what a body of revolution cannot have. Its material is that of
    /// the solid, as in plane strain.
    void
    check_symmetry(Parameters &p, ParameterTable &table)
    {
      if (p.symmetry == Symmetry::none)
        return;
      if (p.dimension != 2)
        table.reject("Dimension", "Symmetry = axis needs 2", {"Symmetry"});
      p.materials.everywhere.hypothesis = Material::Hypothesis::plane_strain;
    }



    /// Notes entries that the run does not look at.
    void
    note_entries_without_effect(const Parameters            &p,
                                const BodyParameters        &body,
                                const std::set<std::string> &idle_constants,
                                ParameterTable              &table)
    {
      const std::string method =
        "Solver/Method is " + to_string(p.solver.method);
      const bool is_euclidean =
        p.solver.method == SolverMethod::euclidean_bundle;
      const bool is_energy    = p.solver.method == SolverMethod::energy_bundle;
      const bool has_path     = !p.load_path.factors.empty();
      const bool has_branches = has_path && p.load_path.bonds_heal &&
                                p.load_path.global_branch != GlobalBranch::none;
      const bool    searches = has_path ? has_branches : p.solver.searches();
      const bool    is_cold  = !p.materials.expands();
      std::ifstream file(
        boost::ends_with(body.file, ".geo") ? table.get("Mesh/File") : "");
      const std::string geometry(std::istreambuf_iterator<char>(file), {});
      for (const std::string &name : idle_constants)
        if (n_words(name, geometry) == 0)
          table.notes.push_back("no effect of the constant " + name +
                                ": nothing uses it");
      const auto is_given = [&table](const std::string &beginning) {
        for (const auto &[path, unused] : table.locations())
          if (boost::starts_with(path, beginning) && table.is_set(path))
            return true;
        return false;
      };
      // The defaults are the paper's, for a strip of its length.
      const bool is_own =
        body.source != BodyParameters::Source::box ||
        body.box.lengths[0] != BodyParameters().box.lengths[0];
      if (is_own && !is_given("Material/Young"))
        table.notes.push_back("the Young modulus is the default one, 69 GPa");
      if ((is_own || table.is_set("Material/Young modulus")) &&
          !p.contact_boundaries.empty() && p.law.name == "winkler" &&
          !is_given("Contact law/Bond") &&
          !is_given("Contact law/Fracture energy"))
        table.notes.push_back(
          "the bonds are the default ones, 69 GPa/m up to 0.002 m: is the scene "
          "in m and GPa?");
      for (const auto &[is_idle, reason, entries] :
           std::vector<std::tuple<bool, std::string, std::string>>{
             {body.source != BodyParameters::Source::box,
              "Mesh/Source is not box",
              "Mesh/Lengths, Mesh/Cells"},
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
             {!has_path,
              "there is no load path",
              "Load path/, Output/Load path"},
             {has_path && !has_branches,
              "the load path has no global branch",
              "Solver/Search"},
             {!searches && !p.solver.prove && !p.solver.has_other_proof,
              "nothing is proved",
              "Solver/Proof/"},
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



    /// Refuses entries that cannot be together with quadratic displacements.
    void
    check_degree(const Parameters &p, ParameterTable &table)
    {
      if (p.degree == 1)
        return;
      using Rule = ContactQuadratureParameters::Rule;
      const std::string no_bonds =
        "needs a bond for each node, which Mesh/Degree = 2 has not";
      refuse({{p.quadrature.rule != Rule::gauss,
               "Contact law/Quadrature",
               "Mesh/Degree = 2 needs gauss N, N from 1 to " +
                 std::string(p.dimension == 2 ? "99" : "7")},
              {p.solver.prove, "Solver/Prove", no_bonds},
              {p.load_path.arc, "Load path/Arc", no_bonds}},
             {"Mesh/Degree"},
             table);
    }



    /// Refuses entries that are for bonds that break at once.
    void
    check_softening(const Parameters &p, ParameterTable &table)
    {
      const bool gains =
        std::any_of(p.law.pieces.begin(),
                    p.law.pieces.end(),
                    [](const EnergyPiece &piece) { return piece.slope > 0.; });
      if (gains && !p.load_path.bonds_heal)
        table.reject("Load path/Bonds heal",
                     "false needs tractions that never rise more than in "
                     "proportion to the opening: bonds that close along the "
                     "secant would give back more than they took",
                     {"Contact law/Law"});
      if (p.law.pieces.empty() || !AdhesiveLaw(p.law.pieces).softens())
        return;
      const std::string quadratic =
        "needs a law of straight lines, not Law = exponential";
      const bool decays =
        !AdhesiveLaw(p.law.pieces).pieces().is_piecewise_quadratic();
      refuse(
        {{p.solver.prove && decays, "Solver/Prove", quadratic},
         {p.load_path.global_branch == GlobalBranch::prove && decays,
          "Load path/Global branch",
          quadratic},
         {p.load_path.arc && decays, "Load path/Arc", quadratic},
         {p.load_path.arc && !p.load_path.bonds_heal,
          "Load path/Arc",
          "needs Load path/Bonds heal = true with bonds that soften, as what "
          "unloads does not come back on the same curve"}},
        {"Contact law/Law"},
        table);
    }



    /// Checks bonds that shear, and refuses what has no meaning with them.
    void
    check_shear(Parameters &p, ParameterTable &table)
    {
      const std::string tangential = "Contact law/Tangential displacement";
      const std::string failure    = "Contact law/Bond failure";
      const std::string energy     = "Contact law/Shear fracture energy";
      const std::string mode       = "Contact law/Mixed mode";
      p.shear.is_somewhere =
        p.tangential_displacement == TangentialDisplacement::bonded;
      for (const auto &[unused, word] : p.tangential_displacements)
        p.shear.is_somewhere = p.shear.is_somewhere || word == "bonded";
      if (!p.shear.is_somewhere)
        {
          table.without_effect("Contact law/Bond shear stiffness, " + failure +
                                 ", " + energy + ", " + mode,
                               "bonds bear no shear",
                               tangential);
          return;
        }
      const bool has_mode =
        p.shear.mixed_mode != ShearParameters::MixedMode::none;
      if ((p.shear.breaks_separately || has_mode) == p.shear.energy.empty())
        table.reject(energy,
                     "goes with Bond failure = separate or a Mixed mode, which "
                     "need it",
                     {failure, mode});
      if (p.law.pieces.empty())
        return;
      const PiecewiseEnergy pieces(p.law.pieces);
      const bool            breaks_at_once =
        pieces.size() == 1 || (pieces.size() == 2 && pieces[1].is_flat());
      refuse(
        {{pieces[0].slope != 0. ||
            (pieces[0].curvature == 0. && pieces.size() > 1),
          tangential,
          "bonded needs bonds that are springs at first"},
         {p.shear.breaks_separately && std::isinf(pieces.largest_value()),
          failure,
          "separate needs bonds that break"},
         {has_mode && std::isinf(pieces.largest_value()),
          mode,
          "needs bonds that break"},
         {has_mode && p.shear.breaks_separately,
          mode,
          "is for Bond failure = common"},
         {has_mode && (p.load_path.factors.empty() || p.load_path.bonds_heal),
          mode,
          "has no energy to minimise but step by step: it needs a load "
          "path with Bonds heal = false"},
         {p.load_path.arc,
          "Load path/Arc",
          "needs bonds along the normal alone: in shear the path of a "
          "bond has no corners, but is curved"},
         {p.solver.prove && !breaks_at_once,
          "Solver/Prove",
          "needs Law = winkler where bonds shear"},
         {p.load_path.global_branch == GlobalBranch::prove && !breaks_at_once,
          "Load path/Global branch",
          "needs Law = winkler where bonds shear, to prove it"}},
        {tangential},
        table);
    }



    void
    check_exact_displacement(const Parameters &p, ParameterTable &table)
    {
      const std::string path = "Verification/Exact displacement";
      check_expression(path,
                       p.verification.exact_displacement,
                       p.dimension,
                       p.dimension,
                       p.loads.constants,
                       table);
      if (!p.verification.exact_displacement.empty() &&
          !p.load_path.factors.empty())
        table.reject(path,
                     "belongs to the given loads, not to those of a load path",
                     {"Load path/Factors"});
    }



    /// Refuses entries that cannot be together with meshes that are refined.
    void
    check_accuracy(const Parameters &p, ParameterTable &table)
    {
      if (p.accuracy.is_adaptive() &&
          p.solver.method == SolverMethod::euclidean_bundle)
        table.reject("Solver/Method",
                     "meshes that are refined need automatic, energy bundle or "
                     "majorise minimise",
                     {"Accuracy/Target", "Accuracy/Maximum unknowns"});
    }
  } // namespace



  Parameters
  SceneTable::parameters(const std::string &scene)
  {
    const Stage stage("mesh");
    p.scene = scene;
    check_symmetry(p, *this);
    complete_loads(p.dimension, p.materials.everywhere, p.loads, *this);
    complete_load_path(p.loads, p.supports, p.load_path, *this);
    body.meshing.memory = memory_left(p.solver.memory_limit);
    p.body =
      make_body(scene, p.dimension, body, parts, p.loads.constants, *this);
    check_bonds(p, *this);
    p.law = laws.make_law(*this);
    complete_output(scene, p.output, *this);

    // What depends on more than one entry.
    check_solver(p.solver, *this);
    check_boundaries(p, *this);
    // Without a body there is an error already.
    if (p.body)
      {
        check_supports(
          p.supports, *p.body, p.dimension, p.loads.constants, *this);
        check_material(p.dimension, p.materials, p.body->regions(), *this);
        check_probes(p.probes,
                     p.dimension,
                     p.body->boundaries(),
                     p.body->regions(),
                     *this);
      }
    check_degree(p, *this);
    check_softening(p, *this);
    check_shear(p, *this);
    check_exact_displacement(p, *this);
    check_accuracy(p, *this);
    if (companion != nullptr)
      companion->check(p, *this);
    note_entries_without_effect(p, body, idle_constants, *this);
    if (!errors.empty())
      throw BadInput(errors);

    p.notes = notes;
    std::ostringstream effective;
    print(effective, false);
    p.effective_scene = effective.str();
    p.locations       = locations();
    return p;
  }
} // namespace Debond
