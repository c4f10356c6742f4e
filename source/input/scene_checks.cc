// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/contact_parameters.h>
#include <debond/input/mesh_parameters.h>
#include <debond/input/probe_parameters.h>
#include <debond/input/scene_checks.h>

#include <boost/algorithm/string/predicate.hpp>

namespace Debond
{
  namespace
  {
    void
    check_boundaries(Parameters &p, ParameterTable &table)
    {
      // A comma separates names in these lists, and may be a part of one. Only
      // the body knows its names, so that they are put together here and not
      // when the entry is read.
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

      // On a clamped side all displacements are known, and nothing remains for
      // contact to decide.
      for (const std::string &side : p.contact_boundaries)
        if (p.clamped_boundaries.count(side) > 0)
          table.reject(contact,
                       "the side " + side +
                         " is clamped already, by Clamped boundaries",
                       {clamped});
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



    /// Refuses entries that cannot be together with quadratic displacements.
    void
    check_degree(const Parameters &p, ParameterTable &table)
    {
      if (p.degree == 1)
        return;
      // With quadratic displacements the unknowns of the contact boundary are
      // coefficients. A bond belongs to a point of the quadrature and its
      // opening depends on several of them, so that no single unknown tells
      // whether it is broken.
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
      // On a piece the traction at the opening p is curvature p - slope. With a
      // slope above 0 it rises more than in proportion to the opening.
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
      // From here on it is about bonds that soften. Proof and arc need pieces
      // on which the traction is a straight line, which a traction that decays
      // does not have.
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
          "unloads does not come back on the same curve"},
         {p.load_path.arc && p.law.is_by_stiffness,
          "Load path/Arc",
          "needs bonds that soften in the same way everywhere"}},
        {"Contact law/Law"},
        table);
    }



    /// Whether bonds are not springs that break at once.
    bool
    breaks_not_at_once(const Parameters &p)
    {
      if (p.law.pieces.empty())
        return false;
      const PiecewiseEnergy pieces(p.law.pieces);
      return pieces.size() > 2 || (pieces.size() == 2 && !pieces[1].is_flat());
    }



    /// Checks bonds that shear, and refuses what has no meaning with them.
    void
    check_shear(Parameters &p, ParameterTable &table)
    {
      // Whether bonds shear anywhere depends on entries of all contact
      // boundaries. It is found out here for everything that is read later.
      const std::string tangential = "Contact law/Tangential displacement";
      const std::string failure    = "Contact law/Bond failure";
      const std::string energy     = "Contact law/Shear fracture energy";
      const std::string mode       = "Contact law/Mixed mode";
      const std::string strength   = "Contact law/Bond shear strength";
      p.shear.is_somewhere =
        p.tangential_displacement == TangentialDisplacement::bonded;
      for (const auto &[unused, word] : p.tangential_displacements)
        p.shear.is_somewhere =
          p.shear.is_somewhere ||
          tangential_named(word) == TangentialDisplacement::bonded;
      // Entries for shear are refused and not only noted: who gives them
      // expects bonds that bear shear.
      if (!p.shear.is_somewhere)
        {
          table.without_effect("Contact law/Bond shear stiffness, " + failure +
                                 ", " + energy + ", " + mode + ", " + strength +
                                 ", Contact law/Failure criterion",
                               "bonds bear no shear",
                               tangential);
          return;
        }
      const bool has_mode = p.shear.mixed_mode != MixedMode::none;
      // The energy is needed in two cases and has no meaning in all others, so
      // that one condition finds both mistakes.
      if ((p.shear.breaks_separately || has_mode) == p.shear.energy.empty())
        table.reject(energy,
                     "goes with Bond failure = separate or a Mixed mode, which "
                     "need it",
                     {failure, mode});
      if (p.law.pieces.empty())
        return;
      if (!p.shear.strength.empty() &&
          (!has_mode ||
           (p.law.name != "bilinear" && p.law.name != "exponential")))
        table.reject(strength,
                     "is for a Mixed mode of Law = bilinear or exponential; "
                     "elsewhere it follows from stiffness and energy",
                     {mode, "Contact law/Law"});
      if (p.shear.strength.empty())
        table.without_effect("Contact law/Failure criterion",
                             "there is no Bond shear strength");
      // Bonds that shear have to be springs at first, which is a straight piece
      // through the origin. Bonds that break at once have one such piece, and a
      // flat one behind it at most.
      const PiecewiseEnergy pieces(p.law.pieces);
      const bool            breaks_at_once = !breaks_not_at_once(p);
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
          "needs Law = winkler where bonds shear, to prove it"},
         {p.load_path.global_branch == GlobalBranch::prove && has_mode,
          "Load path/Global branch",
          "is for Contact law/Mixed mode = none, if it is prove: with an energy "
          "that depends on the mode there is no least J"}},
        {tangential},
        table);
    }



    /// Refuses what cannot be together with friction.
    void
    check_friction(const Parameters &p, ParameterTable &table)
    {
      if (!p.friction.is_somewhere())
        {
          table.without_effect("Contact law/Friction acts",
                               "there is no friction");
          return;
        }
      if (p.friction.is_of_damage &&
          (p.load_path.factors.empty() || p.load_path.bonds_heal))
        table.reject("Contact law/Friction acts",
                     "needs a load path with Bonds heal = false for damage",
                     {"Load path/Bonds heal", "Load path/Factors"});
      // The entry that the scene has.
      const auto name_of = [](const std::string               &word,
                              const FrictionParameters::Entry &own) {
        return "Contact law/Friction " + word +
               (own.everywhere.empty() ? ' ' + own.boundaries.begin()->first :
                                         "");
      };
      const std::string entry =
        p.friction.bound.empty() ?
          name_of("coefficient", p.friction.coefficient) :
          name_of("bound", p.friction.bound);
      using Rule = ContactQuadratureParameters::Rule;
      // What is quadratic has another rule for bonds, and friction of its own.
      refuse({{p.degree == 1 && p.quadrature.rule != Rule::nodal,
               entry,
               "needs Contact law/Quadrature = nodal, with which one node "
               "slides at a time"}},
             {"Contact law/Quadrature"},
             table);
      // Fixed everywhere is the default, which gives way to friction; a
      // boundary that is fixed by its name has none.
      for (const auto &[word, own] :
           {std::make_pair("bound", &p.friction.bound),
            std::make_pair("coefficient", &p.friction.coefficient)})
        for (const auto &[name, unused] : own->boundaries)
          if (const auto word_of = p.tangential_displacements.find(name);
              word_of != p.tangential_displacements.end() &&
              word_of->second == "fixed")
            table.reject(words("Contact law/Friction ", word, ' ', name),
                         "is for what can slide",
                         {"Contact law/Tangential displacement " + name});
      if (!p.friction.coefficient.empty() && p.load_path.factors.empty())
        table.reject(name_of("coefficient", p.friction.coefficient),
                     "needs a load path, as what slides depends on how the "
                     "loads grow: Load path/Factors = 1 is one step from rest",
                     {"Load path/Factors"});
      refuse(
        {{p.load_path.arc, "Load path/Arc", "is for bodies without friction"},
         {p.solver.prove && breaks_not_at_once(p),
          "Solver/Prove",
          "needs Law = winkler, or none, with friction"},
         {p.load_path.global_branch == GlobalBranch::prove,
          "Load path/Global branch",
          "is for bodies without friction, if it is prove"},
         {p.solver.method == SolverMethod::euclidean_bundle ||
            p.solver.method == SolverMethod::energy_bundle,
          "Solver/Method",
          "has to be majorise minimise with friction"}},
        {entry},
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



  void
  check_bonds(const Parameters &p, ParameterTable &table)
  {
    // The laws bind these entries, but know neither the body nor the constants;
    // names and expressions are therefore checked here, of those entries that
    // the scene sets. The blank behind a path and an entry lets an entry match
    // itself and those with the name of a boundary behind it, and no other one
    // that begins like it.
    for (const auto &[path, unused] : table.locations())
      for (const std::string name : {"Bond stiffness",
                                     "Bond threshold",
                                     "Bond strength",
                                     "Fracture energy",
                                     "Traction factor",
                                     "Bond shear stiffness",
                                     "Bond shear strength",
                                     "Shear fracture energy",
                                     "Friction bound",
                                     "Friction coefficient",
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
    // A node has a bond of its own only with nodal quadrature. For quadratic
    // displacements check_degree() refuses the arc.
    using Rule = ContactQuadratureParameters::Rule;
    if (p.load_path.arc && p.degree == 1 && p.quadrature.rule != Rule::nodal)
      table.reject("Load path/Arc",
                   "needs Contact law/Quadrature = nodal, which gives each "
                   "node a bond of its own",
                   {"Contact law/Quadrature"});
  }



  void
  check_symmetry(Parameters &p, ParameterTable &table)
  {
    if (p.symmetry == Symmetry::none)
      return;
    if (p.dimension != 2)
      table.reject("Dimension", "Symmetry = axis needs 2", {"Symmetry"});
    // The entry Material/Hypothesis is not asked for: the material is that of
    // the solid, which it has in plane strain.
    p.materials.everywhere.hypothesis = Material::Hypothesis::plane_strain;
  }



  void
  check_scene(Parameters &p, ParameterTable &table)
  {
    // Each check is made whatever those before it have found, so that the user
    // gets all mistakes at once. reject() leaves out what only follows from an
    // entry that is wrong itself.
    check_solver(p.solver, table);
    p.solver.proof.keeps_record = p.output.proof;
    check_boundaries(p, table);
    // Without a body there is an error already.
    if (p.body)
      {
        check_supports(
          p.supports, *p.body, p.dimension, p.loads.constants, table);
        check_material(p.dimension, p.materials, p.body->regions(), table);
        check_probes(p.probes,
                     p.dimension,
                     p.body->boundaries(),
                     p.body->regions(),
                     table);
      }
    check_degree(p, table);
    check_softening(p, table);
    check_shear(p, table);
    check_friction(p, table);
    check_exact_displacement(p, table);
    check_accuracy(p, table);
  }
} // namespace Debond
