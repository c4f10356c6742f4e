// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/instantiate.h>
#include <debond/base/tolerances.h>
#include <debond/input/contact_parameters.h>
#include <debond/mesh/field_value.h>
#include <debond/solve/scene/scene_conditions.h>

#include <numeric>

namespace Debond
{
  namespace
  {
    template <typename Id>
    void
    insert(const std::set<Id> &ids, std::set<Id> &all)
    {
      all.insert(ids.begin(), ids.end());
    }



    /// Calls @p function(name, id) for the faces of contact boundaries for
    /// which something is set by entries, @p entries by their names.
    template <typename Function>
    void
    for_contact_boundaries(const ProblemParameters                  &given,
                           const std::map<std::string, std::string> &entries,
                           const BoundaryConditions                 &conditions,
                           const Function                           &function)
    {
      const std::set<std::string> &in_contact = given.contact_boundaries;
      // A face may have one value only, while pieces with names may overlap.
      std::map<dealii::types::boundary_id, std::string> taken;
      for (const auto &[name, entry] : entries)
        for (const dealii::types::boundary_id id : conditions.names.at(name))
          {
            if (conditions.contact.count(id) == 0)
              throw EntryError(entry,
                               name + " is not in contact, but " +
                                 join({in_contact.begin(), in_contact.end()},
                                      ", "));
            const auto [other, is_first] = taken.emplace(id, name);
            if (!is_first)
              throw EntryError(entry,
                               name + " overlaps " + other->second +
                                 ", for which it is set as well");
            function(name, id);
          }
    }



    /// The entries of a family, by the names of boundaries.
    std::map<std::string, std::string>
    entries_of(const std::string                        &family,
               const std::map<std::string, std::string> &texts)
    {
      std::map<std::string, std::string> entries;
      for (const auto &[name, unused] : texts)
        entries[name] = family + ' ' + name;
      return entries;
    }



    /// The entries of friction with their names: the bound and the coefficient.
    std::array<std::pair<std::string, const FrictionParameters::Entry *>, 2>
    entries_of_friction(const ProblemParameters &given)
    {
      return {
        {{"Contact law/Friction bound", &given.friction.bound},
         {"Contact law/Friction coefficient", &given.friction.coefficient}}};
    }



    /// Components that a scene prescribes, "free" for those that it does not.
    template <int dim>
    PrescribedDisplacement<dim>
    prescribed_displacement(const std::string &name,
                            const std::string &text,
                            const Constants   &constants)
    {
      PrescribedDisplacement<dim> result;
      const DisplacementText      components(text);
      result.name   = name;
      result.values = make_function<dim>(components.expressions, constants);
      for (unsigned int d = 0; d < dim; ++d)
        result.components[d] = components.is_prescribed[d];
      return result;
    }
  } // namespace



  BoundaryConditions
  make_conditions(const ProblemParameters &given, const PieceNames &names)
  {
    const BoundaryNames &boundaries = names.boundaries;
    BoundaryConditions   conditions;
    // Names become sets of ids, since one face may belong to several pieces.
    for (const std::string &name : given.clamped_boundaries)
      insert(boundaries.at(name), conditions.clamped);
    for (const std::string &name : given.contact_boundaries)
      insert(boundaries.at(name), conditions.contact);
    conditions.names    = boundaries;
    conditions.symmetry = given.symmetry;
    for (const std::string &name : names.interfaces)
      {
        // Without a contact condition on both sides of a cut the two bodies
        // would move through each other.
        const auto &sides = boundaries.at(name);
        if (!std::includes(conditions.contact.begin(),
                           conditions.contact.end(),
                           sides.begin(),
                           sides.end()))
          throw EntryError("Boundary conditions/Contact boundary",
                           "the bodies on both sides of " + name +
                             " could go through each other: it has to have " +
                             name +
                             ", which is both sides; bonds are left out by " +
                             (given.law.is_by_stiffness ?
                                "Bond stiffness " + name + " = 0" :
                                "a Traction factor that is 0 there"));
        conditions.interfaces.push_back(
          {name, boundaries.at(name + "_high"), boundaries.at(name + "_low")});
        insert(boundaries.at(name + "_high"), conditions.high_sides);
        insert(boundaries.at(name + "_low"), conditions.low_sides);
      }
    // Bonds without stiffness, or whose first piece is no spring, bear no shear
    // and leave the body free to slide. Then the displacement along the
    // boundary needs no unknowns of the contact problem.
    const auto or_free = [&](const TangentialDisplacement wanted) {
      double     stiffness;
      const bool is_none =
        given.law.pieces[0].curvature == 0. ||
        (given.shear.stiffness.boundaries.empty() &&
         read_number(given.shear.stiffness.everywhere, stiffness) &&
         stiffness == 0.);
      return wanted == TangentialDisplacement::bonded && is_none ?
               TangentialDisplacement::free :
               wanted;
    };
    conditions.tangential_displacement = or_free(given.tangential_displacement);
    // A boundary with an entry of its own has that in place of what holds for
    // all.
    const auto &own = given.tangential_displacements;
    for_contact_boundaries(
      given,
      entries_of("Contact law/Tangential displacement", own),
      conditions,
      [&](const std::string &name, const dealii::types::boundary_id id) {
        conditions.own_tangential_displacements[id] =
          or_free(tangential_named(own.at(name)));
      });
    // Friction resists what slides: where nothing else is said, all may.
    // A boundary that is fixed by its name has none.
    const auto add_friction = [&](const dealii::types::boundary_id id) {
      const auto named = conditions.own_tangential_displacements.find(id);
      if (named != conditions.own_tangential_displacements.end() &&
          named->second == TangentialDisplacement::fixed)
        return;
      conditions.with_friction.insert(id);
      if (conditions.fixes_tangential(id))
        conditions.own_tangential_displacements[id] =
          TangentialDisplacement::free;
    };
    for (const auto &[entry, texts] : entries_of_friction(given))
      {
        if (!texts->everywhere.empty())
          for (const dealii::types::boundary_id id : conditions.contact)
            add_friction(id);
        for_contact_boundaries(given,
                               entries_of(entry, texts->boundaries),
                               conditions,
                               [&](const std::string &,
                                   const dealii::types::boundary_id id) {
                                 add_friction(id);
                               });
      }
    return conditions;
  }



  ByRegion<Material>
  make_materials(const MaterialParameters &parameters,
                 const RegionNames        &regions)
  {
    ByRegion<Material> materials(parameters.everywhere);
    // Regions may overlap, so that a name stands for several ids of the mesh,
    // one for each combination of regions. Each id may have one material only.
    std::map<dealii::types::material_id, std::string> taken;
    for (const auto &[name, material] : parameters.of_regions())
      for (const dealii::types::material_id id : regions.at(name))
        {
          const auto [other, is_first] = taken.emplace(id, name);
          if (!is_first)
            throw EntryError(parameters.entry_of(name),
                             "the region overlaps " + other->second +
                               ", which has a material of its own as well");
          materials.set(id, material);
        }
    return materials;
  }



  template <int dim>
  Supports<dim>
  make_supports(const ProblemParameters  &given,
                const BoundaryConditions &conditions)
  {
    const BoundaryNames &boundaries = conditions.names;
    const Constants     &constants  = given.loads.constants;
    Supports<dim>        supports;
    // Clamps are conditions on boundaries; all other supports are values of
    // components, or of the normal one for rollers.
    for (const auto &[name, text] : given.supports.displacements)
      {
        supports.displacements.push_back(
          prescribed_displacement<dim>(name, text, constants));
        supports.displacements.back().boundaries = boundaries.at(name);
      }
    for (const std::string &name : given.supports.rollers)
      supports.displacements.push_back({name, boundaries.at(name), true});
    // What all contact boundaries have comes first, and those with an entry of
    // their own replace it.
    const auto add = [&](const std::string                        &entry,
                         const std::string                        &text,
                         const std::map<std::string, std::string> &own,
                         const unsigned int                        n_components,
                         auto                                     &fields) {
      // Cuts have no foundation whose direction an entry without a name could
      // mean, but gaps.
      if (!text.empty())
        for (const dealii::types::boundary_id id : conditions.contact)
          if (n_components == 1 || (conditions.high_sides.count(id) == 0 &&
                                    conditions.low_sides.count(id) == 0))
            fields[id] = {"",
                          make_function<dim>(text, constants, n_components)};
      if (!text.empty() && fields.empty() && !conditions.contact.empty())
        throw EntryError(entry,
                         "is that of foundations, and all contact boundaries "
                         "are between bodies: " +
                           entry.substr(entry.find('/') + 1) +
                           " NAME is for the one of this name");
      for_contact_boundaries(given,
                             entries_of(entry, own),
                             conditions,
                             [&](const std::string               &name,
                                 const dealii::types::boundary_id id) {
                               fields[id] = {name,
                                             make_function<dim>(own.at(name),
                                                                constants,
                                                                n_components)};
                             });
    };
    add("Contact law/Initial gap",
        given.supports.gap,
        given.supports.gaps,
        1,
        supports.gaps);
    add("Boundary conditions/Foundation normal",
        given.supports.normal,
        given.supports.normals,
        dim,
        supports.normals);
    return supports;
  }



  namespace
  {
    /// How the bonds of a scene bear shear.
    ShearBonds
    shear_bonds(const ProblemParameters  &given,
                const BoundaryConditions &conditions)
    {
      // Of laws that are given by a Traction factor the numbers grow with it.
      ShearBonds shear;
      shear.is_relative  = !given.law.is_by_stiffness;
      shear.are_separate = given.shear.breaks_separately;
      shear.mixed_mode   = given.shear.mixed_mode;
      shear.exponent     = given.shear.exponent;
      shear.criterion    = given.shear.criterion;
      // What holds everywhere first, then in its place what a boundary has of
      // its own.
      const std::vector<std::tuple<std::string,
                                   const ShearParameters::Entry *,
                                   std::optional<double> ShearNumbers::*>>
             entries = {{"Contact law/Bond shear stiffness",
                         &given.shear.stiffness,
                         &ShearNumbers::stiffness},
                        {"Contact law/Bond shear strength",
                         &given.shear.strength,
                         &ShearNumbers::strength},
                        {"Contact law/Shear fracture energy",
                         &given.shear.energy,
                         &ShearNumbers::energy}};
      double number;
      for (const dealii::types::boundary_id id : conditions.contact)
        if (conditions.tangential(id) == TangentialDisplacement::bonded)
          for (const auto &[unused, entry, member] : entries)
            if (ShearNumbers &numbers = shear.boundaries[id];
                read_number(entry->everywhere, number))
              numbers.*member = number;
      for (const auto &[path, entry, member] : entries)
        for_contact_boundaries(
          given,
          entries_of(path, entry->boundaries),
          conditions,
          [&, path = path, entry = entry, member = member](
            const std::string &name, const dealii::types::boundary_id id) {
            const auto numbers = shear.boundaries.find(id);
            if (numbers == shear.boundaries.end())
              throw EntryError(path + ' ' + name, "bonds bear no shear there");
            read_number(entry->boundaries.at(name), number);
            numbers->second.*member = number;
            if (member == &ShearNumbers::energy)
              numbers->second.boundary = name;
          });
      // Where nothing shears there is no mode, whatever the entry says.
      if (shear.boundaries.empty())
        shear.mixed_mode = MixedMode::none;
      const bool needs_energy =
        shear.are_separate || shear.mixed_mode != MixedMode::none;
      for (const auto &[id, numbers] : shear.boundaries)
        if (needs_energy && !numbers.energy)
          throw EntryError("Contact law/Shear fracture energy",
                           "there has to be one for all boundaries whose bonds "
                           "shear, or for each");
      return shear;
    }
  } // namespace



  template <int dim>
  std::unique_ptr<BondField<dim>>
  make_bond_field(const ProblemParameters  &given,
                  const AdhesiveLaw        &law,
                  const BoundaryConditions &conditions)
  {
    // A number is made a constant function: parsed expressions cost much more
    // at each point, and most bonds differ by boundary only.
    using Field      = typename BondField<dim>::Field;
    using Bonds      = typename BondField<dim>::Bonds;
    const auto field = [&](const std::string &text) -> Field {
      if (text.empty())
        return nullptr;
      if (double number; read_number(text, number))
        return std::make_shared<const dealii::Functions::ConstantFunction<dim>>(
          number);
      return make_function<dim>(text, given.loads.constants, 1);
    };
    std::map<std::string, std::string> entries;
    std::map<std::string, Bonds>       bonds;
    // The functions of a boundary with bonds of its own, by its name; ids of
    // the mesh get them below, when it is known that no two of these boundaries
    // overlap.
    for (const auto &[name, texts] : given.law.boundaries)
      {
        bonds[name] = {name,
                       field(texts.stiffness),
                       field(texts.threshold),
                       field(texts.energy)};
        // Errors name an entry that the scene has for the boundary, that of the
        // stiffness first.
        for (const std::string entry : {"Bond stiffness",
                                        "Bond threshold",
                                        "Bond strength",
                                        "Fracture energy"})
          if (const std::string path = "Contact law/" + entry + ' ' + name;
              given.locations.count(path) > 0)
            entries.emplace(name, path);
      }
    std::map<dealii::types::boundary_id, Bonds> boundaries;
    for_contact_boundaries(given,
                           entries,
                           conditions,
                           [&](const std::string               &name,
                               const dealii::types::boundary_id id) {
                             boundaries[id] = bonds[name];
                           });
    return std::make_unique<BondField<dim>>(law,
                                            Bonds{"",
                                                  field(given.law.stiffness),
                                                  field(given.law.threshold),
                                                  field(given.law.energy)},
                                            boundaries,
                                            shear_bonds(given, conditions));
  }



  namespace
  {
    /// A number of friction on all unknowns of the contact boundary, 0 where it
    /// has none, by @p weight(face, k) times what the entry says at vertex k.
    template <int dim, typename Weight>
    Eigen::VectorXd
    on_unknowns(const std::string               &entry,
                const FrictionParameters::Entry &texts,
                const ProblemParameters         &given,
                const BoundaryConditions        &conditions,
                const ContactBoundary<dim>      &boundary,
                const Weight                    &weight)
    {
      // By boundary, its entry and its expression: those with a name replace
      // what holds everywhere.
      using Field =
        std::pair<std::string, std::shared_ptr<const dealii::Function<dim>>>;
      std::map<dealii::types::boundary_id, Field> fields;
      const auto make = [&](const std::string &text) {
        return make_function<dim>(text, given.loads.constants, 1);
      };
      if (!texts.everywhere.empty())
        for (const dealii::types::boundary_id id : conditions.contact)
          fields[id] = {entry, make(texts.everywhere)};
      for (const auto &[name, text] : texts.boundaries)
        for (const dealii::types::boundary_id id : conditions.names.at(name))
          fields[id] = {entry + ' ' + name, make(text)};
      Eigen::VectorXd result = Eigen::VectorXd::Zero(boundary.n_unknowns());
      const auto      add    = [&](const auto &tangents, const double value) {
        for (const auto &tangent : tangents)
          if (!tangent.is_held)
            result(tangent.index) += value;
      };
      for (const auto &face : boundary.faces)
        if (const auto found = fields.find(face.id); found != fields.end())
          for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
            try
              {
                const auto add_at = [&](const auto &at) {
                  add(at.tangents,
                      weight(face, k) *
                        nonnegative_value(*found->second.second, at.position));
                };
                // It is wrong to be negative where nothing is unknown, too.
                if (k < dim)
                  nonnegative_value(*found->second.second, face.vertices[k]);
                // Where nothing is unknown along the boundary nothing slides.
                if (!face.is_held(k))
                  add_at(boundary.nodes[face.node(k)]);
                else if (!boundary.held_vertices.empty())
                  add_at(boundary.held_vertices[face.held_at(k)]);
              }
            catch (const std::invalid_argument &error)
              {
                throw EntryError(found->second.first, error.what());
              }
      return result;
    }
  } // namespace



  template <int dim>
  Friction
  make_friction(const ProblemParameters    &given,
                const BoundaryConditions   &conditions,
                const ContactBoundary<dim> &boundary)
  {
    if (!given.friction.is_somewhere())
      return {};
    const auto entries = entries_of_friction(given);
    // Each vertex has the integral of its basis function times the bound there:
    // the trapezoidal rule, with which one unknown slides at a time. So has
    // each coefficient of quadratic displacements, whose basis functions are
    // not negative, so that the sum is exact where all slides one way, and no
    // less than the integral elsewhere. Its coefficient of friction is the mean
    // of those of its faces.
    Friction result;
    result.bound = on_unknowns(entries[0].first,
                               *entries[0].second,
                               given,
                               conditions,
                               boundary,
                               [&](const auto &face, const unsigned int k) {
                                 return boundary.integral(face, k);
                               });
    result.coefficient =
      on_unknowns(entries[1].first,
                  *entries[1].second,
                  given,
                  conditions,
                  boundary,
                  [&](const auto &face, const unsigned int k) {
                    return face.is_held(k) ?
                             0. :
                             boundary.integral(face, k) /
                               boundary.nodes[face.node(k)].measure;
                  });
    result.is_of_damage = given.friction.is_of_damage;
    std::set<unsigned int> moved;
    for (const auto &face : boundary.faces)
      if (conditions.with_friction.count(face.id) > 0)
        for (unsigned int k = 0; k < boundary.n_face_nodes(); ++k)
          if (!face.is_held(k))
            for (const auto &tangent : boundary.nodes[face.node(k)].tangents)
              if (tangent.is_held &&
                  boundary.held_vertices[tangent.index].normal_displacement !=
                    0.)
                moved.insert(face.node(k));
    result.n_moved = static_cast<unsigned int>(moved.size());
    result.node.assign(boundary.n_unknowns(),
                       dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < boundary.nodes.size(); ++i)
      for (const auto &tangent : boundary.nodes[i].tangents)
        if (!tangent.is_held)
          result.node[tangent.index] = i;
    // Along both tangents of a vertex of a solid it is one force.
    if constexpr (dim == 3)
      {
        result.partner.resize(boundary.n_unknowns());
        std::iota(result.partner.begin(), result.partner.end(), 0);
        const auto join = [&](const auto &tangents) {
          if (tangents.size() == 2 && !tangents[0].is_held &&
              !tangents[1].is_held)
            {
              result.partner[tangents[0].index] = tangents[1].index;
              result.partner[tangents[1].index] = tangents[0].index;
            }
        };
        for (const auto &node : boundary.nodes)
          join(node.tangents);
        for (const auto &vertex : boundary.held_vertices)
          join(vertex.tangents);
      }
    return result;
  }



  std::vector<double>
  displacement_factors(const LoadPathParameters &load_path)
  {
    std::vector<double> factors;
    for (unsigned int k = 0; k < load_path.factors.size(); ++k)
      factors.push_back(load_path.at(k).displacements);
    // Without a path there is the whole load, whose factor is 1.
    return factors.empty() ? std::vector<double>{1.} : factors;
  }



  template <int dim>
  void
  check_held_vertices(const ElasticUnknowns<dim> &unknowns,
                      const std::vector<double>  &load_factors)
  {
    // A vertex whose normal displacement is prescribed is no contact node, so s
    // <= 0 has to hold for it at all factors by the data. Values that are zero
    // by cancellation are as wrong as others are, hence a tolerance relative to
    // the largest of them.
    const ContactBoundary<dim> &boundary = unknowns.contact().boundary();
    double                      largest  = 0.;
    for (const auto &node : boundary.nodes)
      largest = std::max(largest, std::abs(node.gap));
    for (const auto &vertex : boundary.held_vertices)
      largest = std::max(
        {largest, std::abs(vertex.gap), std::abs(vertex.normal_displacement)});
    for (const auto &vertex : boundary.held_vertices)
      for (const double factor : load_factors)
        {
          const double normal = factor * vertex.normal_displacement;
          // A displacement along a tangent cannot penetrate, and the normal one
          // may come to the gap but for rounding.
          if (vertex.is_tangential ||
              normal - vertex.gap <=
                Tolerance::rounding_of_data * (1. + std::abs(factor)) * largest)
            continue;
          if (vertex.normal_displacement == 0.)
            throw SupportError(SupportError::Subject::gap,
                               "",
                               "it is negative where the body is held, at " +
                                 point_text(vertex.position));
          throw SupportError(SupportError::Subject::displacement,
                             unknowns.support_names().at(vertex.support),
                             (vertex.low_support <
                                  unknowns.support_names().size() ?
                                "supports push the bodies into each other at " :
                                "it pushes the body into the foundation at ") +
                               point_text(vertex.position));
        }
  }



  DEBOND_INSTANTIATE(make_supports);
  DEBOND_INSTANTIATE(make_bond_field);
  DEBOND_INSTANTIATE(make_friction);
  DEBOND_INSTANTIATE(check_held_vertices);
} // namespace Debond
