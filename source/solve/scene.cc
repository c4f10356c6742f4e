// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/function.h>
#include <deal.II/base/timer.h>

#include <debond/base/number_text.h>
#include <debond/base/text.h>
#include <debond/check/error_estimate.h>
#include <debond/contact/field_value.h>
#include <debond/elasticity/temperature_load.h>
#include <debond/input/bad_input.h>
#include <debond/input/expression.h>
#include <debond/input/probe_parameters.h>
#include <debond/linear_algebra/eigen_view.h>
#include <debond/solve/displacement.h>
#include <debond/solve/scene.h>

#include <cmath>
#include <functional>

namespace Debond
{
  namespace
  {
    using Vector = dealii::Vector<double>;

    /// The sum of tractions on faces that have several names.
    template <int dim>
    class Sum : public dealii::Function<dim>
    {
    public:
      using Term = std::shared_ptr<const dealii::Function<dim>>;

      Sum(const Term &first, const Term &second)
        : dealii::Function<dim>(dim)
        , first(first)
        , second(second)
      {}

      double
      value(const dealii::Point<dim> &point,
            const unsigned int        component) const override
      {
        return first->value(point, component) + second->value(point, component);
      }

    private:
      const Term first;
      const Term second;
    };



    template <typename Id>
    void
    insert(const std::set<Id> &ids, std::set<Id> &all)
    {
      all.insert(ids.begin(), ids.end());
    }



    /// A piece of the body that cannot have what an entry says of it.
    class PieceError : public std::invalid_argument
    {
    public:
      PieceError(const std::string &entry, const std::string &message)
        : std::invalid_argument(message)
        , entry(entry)
      {}

      const std::string entry;
    };



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
      std::map<dealii::types::boundary_id, std::string> taken;
      for (const auto &[name, entry] : entries)
        for (const dealii::types::boundary_id id : conditions.names.at(name))
          {
            if (conditions.contact.count(id) == 0)
              throw PieceError(entry,
                               name + " is not in contact, but " +
                                 join({in_contact.begin(), in_contact.end()},
                                      ", "));
            const auto [other, is_first] = taken.emplace(id, name);
            if (!is_first)
              throw PieceError(entry,
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



    BoundaryConditions
    make_conditions(const ProblemParameters &given,
                    const BoundaryNames     &boundaries)
    {
      BoundaryConditions conditions;
      for (const std::string &name : given.clamped_boundaries)
        insert(boundaries.at(name), conditions.clamped);
      for (const std::string &name : given.contact_boundaries)
        insert(boundaries.at(name), conditions.contact);
      conditions.names = boundaries;
      conditions.tangential_displacement_fixed =
        given.tangential_displacement_fixed;
      const auto &own = given.tangential_displacements;
      for_contact_boundaries(
        given,
        entries_of("Contact law/Tangential displacement", own),
        conditions,
        [&](const std::string &name, const dealii::types::boundary_id id) {
          if ((own.at(name) == "fixed") !=
              conditions.tangential_displacement_fixed)
            conditions.tangential_exceptions.insert(id);
        });
      return conditions;
    }



    ByRegion<Material>
    make_materials(const MaterialParameters &parameters,
                   const RegionNames        &regions)
    {
      ByRegion<Material> materials(parameters.everywhere);
      std::map<dealii::types::material_id, std::string> taken;
      for (const auto &[name, material] : parameters.of_regions())
        for (const dealii::types::material_id id : regions.at(name))
          {
            const auto [other, is_first] = taken.emplace(id, name);
            if (!is_first)
              throw PieceError(parameters.entry_of(name),
                               "the region overlaps " + other->second +
                                 ", which has a material of its own as well");
            materials.set(id, material);
          }
      return materials;
    }



    /// The entry of a traction on faces of this id.
    std::string
    traction_entry(const LoadParameters            &loads,
                   const BoundaryNames             &boundaries,
                   const dealii::types::boundary_id id)
    {
      for (const auto &[name, unused] : loads.tractions)
        if (boundaries.at(name).count(id) > 0)
          return "Loads/Traction " + name;
      throw std::logic_error("There is no traction on this boundary.");
    }



    /// The dead ones or the others.
    template <int dim>
    Loads<dim>
    make_loads(const LoadParameters        &parameters,
               const std::set<std::string> &dead_loads,
               const bool                   wants_dead,
               const BoundaryNames         &boundaries)
    {
      const auto is_wanted = [&](const std::string &name) {
        return wants_dead == (dead_loads.count(name) > 0);
      };
      Loads<dim> loads;
      loads.boundary_names = boundaries;
      if (!parameters.body_force.empty() && is_wanted("body force"))
        loads.body_force =
          make_function<dim>(parameters.body_force, parameters.constants);
      if (!parameters.temperature_change.empty() && !wants_dead)
        loads.temperature_change =
          make_function<dim>(parameters.temperature_change,
                             parameters.constants,
                             1);
      for (const auto &[name, expression] : parameters.tractions)
        for (const dealii::types::boundary_id id : boundaries.at(name))
          {
            if (!is_wanted(name))
              continue;
            const std::shared_ptr<const dealii::Function<dim>> added =
              make_function<dim>(expression, parameters.constants);
            auto &traction = loads.tractions[id];
            traction       = traction ?
                               std::make_shared<const Sum<dim>>(traction, added) :
                               added;
          }
      return loads;
    }



    /// Components that a scene prescribes, "free" for those that it does not.
    template <int dim>
    PrescribedDisplacement<dim>
    prescribed_displacement(const std::string                   &name,
                            const std::string                   &text,
                            const std::map<std::string, double> &constants)
    {
      PrescribedDisplacement<dim> result;
      const DisplacementText      components(text);
      result.name   = name;
      result.values = make_function<dim>(components.expressions, constants);
      for (unsigned int d = 0; d < dim; ++d)
        result.components[d] = components.is_prescribed[d];
      return result;
    }



    template <int dim>
    Supports<dim>
    make_supports(const ProblemParameters  &given,
                  const BoundaryConditions &conditions)
    {
      const BoundaryNames                 &boundaries = conditions.names;
      const std::map<std::string, double> &constants  = given.loads.constants;
      Supports<dim>                        supports;
      for (const auto &[name, text] : given.supports.displacements)
        {
          supports.displacements.push_back(
            prescribed_displacement<dim>(name, text, constants));
          supports.displacements.back().boundaries = boundaries.at(name);
        }
      for (const std::string &name : given.supports.all_rollers())
        supports.displacements.push_back({name, boundaries.at(name), true});
      if (!given.supports.gap.empty())
        for (const dealii::types::boundary_id id : conditions.contact)
          supports.gaps[id] = {
            "", make_function<dim>(given.supports.gap, constants, 1)};
      const auto &own = given.supports.gaps;
      for_contact_boundaries(
        given,
        entries_of("Contact law/Initial gap", own),
        conditions,
        [&](const std::string &name, const dealii::types::boundary_id id) {
          supports.gaps[id] = {name,
                               make_function<dim>(own.at(name), constants, 1)};
        });
      return supports;
    }



    template <int dim>
    std::unique_ptr<BondField<dim>>
    make_bond_field(const ProblemParameters  &given,
                    const AdhesiveLaw        &law,
                    const BoundaryConditions &conditions)
    {
      using Field      = typename BondField<dim>::Field;
      using Bonds      = typename BondField<dim>::Bonds;
      const auto field = [&](const std::string &text) -> Field {
        if (text.empty())
          return nullptr;
        if (double number; read_number(text, number))
          return std::make_shared<
            const dealii::Functions::ConstantFunction<dim>>(number);
        return make_function<dim>(text, given.loads.constants, 1);
      };
      std::map<std::string, std::string> entries;
      std::map<std::string, Bonds>       bonds;
      for (const auto &[name, texts] : given.law.boundaries)
        {
          bonds[name] = {name, field(texts.stiffness), field(texts.threshold)};
          for (const std::string entry : {"Bond stiffness", "Bond threshold"})
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
      return std::make_unique<BondField<dim>>(law.curvature(0.),
                                              law.bond_threshold(),
                                              Bonds{"",
                                                    field(given.law.stiffness),
                                                    field(given.law.threshold)},
                                              boundaries);
    }



    /// At all steps.
    std::vector<double>
    displacement_factors(const LoadPathParameters &load_path)
    {
      std::vector<double> factors;
      for (unsigned int k = 0; k < load_path.factors.size(); ++k)
        factors.push_back(load_path.at(k).displacements);
      return factors.empty() ? std::vector<double>{1.} : factors;
    }



    /// Throws SupportError if a support pushes a vertex into the foundation.
    template <int dim>
    void
    check_held_vertices(const ElasticUnknowns<dim> &unknowns,
                        const std::vector<double>  &load_factors)
    {
      constexpr double rounding = 1e-12;
      for (const auto &vertex : unknowns.contact().boundary().held_vertices)
        for (const double factor : load_factors)
          {
            const double normal = factor * vertex.normal_displacement;
            if (normal - vertex.gap >
                rounding * (std::abs(normal) + vertex.gap))
              throw SupportError(SupportError::Subject::displacement,
                                 unknowns.support_names().at(vertex.support),
                                 "it pushes the body into the foundation at " +
                                   point_text(vertex.position));
          }
    }



    /// Throws std::invalid_argument if the file has no displacement that the
    /// problem admits.
    template <int dim>
    dealii::Vector<double>
    read_start(const std::string &file_name, const ElasticProblem<dim> &problem)
    {
      const dealii::Vector<double> u =
        read_displacement(file_name, problem.unknowns().n_dofs());
      bool admissible = true;
      for (unsigned int i = 0; i < problem.unknowns().n_dofs(); ++i)
        admissible =
          admissible && (u(i) == 0. || !problem.unknowns().is_constrained(i));
      if (!admissible || !problem.unknowns().contact().is_admissible(u))
        throw std::invalid_argument(
          file_name + " does not satisfy the scene's boundary conditions");
      return u;
    }



    std::string
    entry_of(const SupportError &error, const SupportParameters &supports)
    {
      switch (error.subject)
        {
          case SupportError::Subject::roller:
            return supports.rollers.count(error.name) > 0 ?
                     "Boundary conditions/Roller boundaries" :
                     "Boundary conditions/Symmetry boundaries";
          case SupportError::Subject::gap:
            return error.name.empty() ? "Contact law/Initial gap" :
                                        "Contact law/Initial gap " + error.name;
          default:
            return "Boundary conditions/Displacement " + error.name;
        }
    }
  } // namespace



  template <int dim>
  Scene<dim>::Scene(const ProblemParameters &given,
                    const MatrixStorage      storage,
                    const std::string       &start)
    : Scene(given,
            std::dynamic_pointer_cast<const Body<dim>>(given.body),
            storage,
            start)
  {}



  template <int dim>
  Scene<dim>::Scene(const ProblemParameters         &given,
                    std::shared_ptr<const Body<dim>> body,
                    const MatrixStorage              storage,
                    const std::string               &start)
    : Scene(given, std::move(body), storage, start, nullptr, MPI_COMM_NULL)
  {}



  template <int dim>
  Scene<dim>::Scene(const ProblemParameters             &given,
                    std::shared_ptr<const BoxPiece<dim>> piece,
                    const MPI_Comm                       ranks)
    : Scene(given, piece, MatrixStorage::serial, "", piece.get(), ranks)
  {}



  template <int dim>
  Scene<dim>::Scene(const ProblemParameters         &given,
                    std::shared_ptr<const Body<dim>> body,
                    const MatrixStorage              storage,
                    const std::string               &start,
                    const BoxPiece<dim>             *box_piece,
                    const MPI_Comm                   ranks)
    : given(given)
    , elastic_body(std::move(body))
    , body_materials(given.materials.everywhere)
  {
    BoundaryNames boundaries;
    dealii::Timer timer;
    std::string   entry = "Mesh/Lengths"; // that errors belong to
    // Returns what is wrong.
    const auto attempt = [&](const std::function<void()> &action) {
      try
        {
          action();
          return std::string();
        }
      catch (const std::invalid_argument &error)
        {
          if (const auto *load = dynamic_cast<const LoadError *>(&error))
            entry = load->boundary ?
                      traction_entry(given.loads, boundaries, *load->boundary) :
                      "Loads/Body force";
          if (dynamic_cast<const TemperatureError *>(&error) != nullptr)
            entry = "Loads/Temperature change";
          if (const auto *piece = dynamic_cast<const PieceError *>(&error))
            entry = piece->entry;
          if (const auto *part = dynamic_cast<const PartError *>(&error))
            entry = "Parts/" + part->part;
          if (const auto *support = dynamic_cast<const SupportError *>(&error))
            entry = entry_of(*support, given.supports);
          if (const auto *probe = dynamic_cast<const ProbeError *>(&error))
            entry = "Probes/" + probe->probe;
          if (const auto *bonds = dynamic_cast<const BondFieldError *>(&error))
            {
              const std::string everywhere = bonds->is_threshold ?
                                               "Contact law/Bond threshold" :
                                               "Contact law/Bond stiffness";
              entry                        = everywhere + ' ' + bonds->boundary;
              if (given.locations.count(entry) == 0)
                entry = everywhere;
            }
          return given.locations.at(entry) + ": " + entry + ": " + error.what();
        }
    };

    const auto throw_error_of_any = [&](const std::string &own_error) {
      std::vector<std::string> errors = {own_error};
      if (box_piece != nullptr)
        errors = dealii::Utilities::MPI::all_gather(ranks, own_error);
      for (const std::string &error : errors)
        if (!error.empty())
          throw BadInput({error});
    };

    throw_error_of_any(
      attempt([&]() { add_problem(storage, box_piece, boundaries, entry); }));
    if (box_piece != nullptr)
      problem_piece =
        std::make_unique<const ProblemPiece<dim>>(*box_piece,
                                                  elastic_problem->unknowns(),
                                                  ranks);
    throw_error_of_any(attempt([&]() {
      entry = "Contact law/Quadrature";
      add_contact(storage);
      entry = "Solver/Euclidean bundle/Start";
      add_start(start);
    }));
    seconds_for_assembly = timer.wall_time() - seconds_for_mesh;
  }



  template <int dim>
  void
  Scene<dim>::add_problem(const MatrixStorage  storage,
                          const BoxPiece<dim> *box_piece,
                          BoundaryNames       &boundaries,
                          std::string         &entry)
  {
    dealii::Timer    timer;
    const PieceNames names = elastic_body->make_mesh(triangulation);
    boundaries             = names.boundaries;
    body_notes             = names.notes;
    seconds_for_mesh       = timer.wall_time();

    entry               = "Boundary conditions/Clamped boundaries";
    boundary_conditions = make_conditions(given, boundaries);
    body_supports       = make_supports<dim>(given, boundary_conditions);
    elastic_problem     = std::make_unique<ElasticProblem<dim>>(
      triangulation,
      boundary_conditions,
      body_supports,
      given.degree,
      box_piece == nullptr ? std::vector<unsigned int>() :
                                 node_order(*box_piece, triangulation));
    check_held_vertices(elastic_problem->unknowns(),
                        displacement_factors(given.load_path));
    entry                                   = "Material/Poisson ratio";
    const std::set<std::string> &dead_loads = given.load_path.dead_loads;
    body_loads = make_loads<dim>(given.loads, dead_loads, false, boundaries);
    body_dead_loads =
      make_loads<dim>(given.loads, dead_loads, true, boundaries);
    if (box_piece != nullptr)
      for (const auto &[side, id] : box_sides<dim>())
        body_loads.n_faces[id] = body_dead_loads.n_faces[id] =
          box_piece->n_faces_on(side);
    body_materials = make_materials(given.materials, names.regions);
    elastic_problem->assemble(body_materials,
                              body_loads,
                              storage,
                              body_dead_loads);
    piece_means = Probes<dim>(elastic_problem->unknowns(),
                              names,
                              means_of_pieces<dim>(names));
    if (box_piece == nullptr)
      named_probes = Probes<dim>(elastic_problem->unknowns(),
                                 names,
                                 make_probes<dim>(given.probes));
  }



  template <int dim>
  void
  Scene<dim>::add_start(const std::string &file)
  {
    if (file.empty())
      {
        const ContactSpace<dim> &contact =
          elastic_problem->unknowns().contact();
        first_iterate.reinit(elastic_problem->unknowns().n_dofs());
        contact.add_normal(eigen_view(contact.at_rest()), first_iterate);
      }
    else
      first_iterate = read_start(file, *elastic_problem);
  }



  template <int dim>
  void
  Scene<dim>::add_contact(const MatrixStorage storage)
  {
    adhesive_law = std::make_unique<AdhesiveLaw>(given.law.branches);
    quadrature   = std::make_unique<ContactQuadrature<dim>>(given.quadrature,
                                                          adhesive_law->kinks(),
                                                          given.degree);
    if (given.law.has_field())
      bond_field =
        make_bond_field<dim>(given, *adhesive_law, boundary_conditions);
    adhesion_integral = std::make_unique<AdhesionIntegral<dim>>(
      contact_boundary(), *adhesive_law, *quadrature, bond_field.get());
    // Asks for the bonds at points of its own, where they may be wrong.
    if (bond_field)
      estimate_error(*elastic_problem,
                     *adhesion_integral,
                     boundary_conditions,
                     body_supports,
                     Loads<dim>(),
                     Vector(elastic_problem->unknowns().n_dofs()),
                     0.);
    if (problem_piece)
      return;
    const auto make_functional = [this](const auto &A) {
      using MatrixType = std::decay_t<decltype(A)>;
      energy           = std::make_unique<Functional<dim, MatrixType, Vector>>(
        A,
        elastic_problem->load(),
        elastic_problem->unknowns().contact(),
        *adhesion_integral);
    };
    if (storage == MatrixStorage::serial)
      make_functional(elastic_problem->matrix());
    else
      make_functional(elastic_problem->trilinos_matrix());
  }



  template <int dim>
  const ProblemParameters &
  Scene<dim>::parameters() const
  {
    return given;
  }



  template <int dim>
  const Body<dim> &
  Scene<dim>::body() const
  {
    return *elastic_body;
  }



  template <int dim>
  const ElasticProblem<dim> &
  Scene<dim>::problem() const
  {
    return *elastic_problem;
  }



  template <int dim>
  const BoundaryConditions &
  Scene<dim>::conditions() const
  {
    return boundary_conditions;
  }



  template <int dim>
  const Supports<dim> &
  Scene<dim>::supports() const
  {
    return body_supports;
  }



  template <int dim>
  const ByRegion<Material> &
  Scene<dim>::materials() const
  {
    return body_materials;
  }



  template <int dim>
  const Loads<dim> &
  Scene<dim>::loads() const
  {
    return body_loads;
  }



  template <int dim>
  const Loads<dim> &
  Scene<dim>::dead_loads() const
  {
    return body_dead_loads;
  }



  template <int dim>
  const AdhesiveLaw &
  Scene<dim>::law() const
  {
    return *adhesive_law;
  }



  template <int dim>
  const AdhesionIntegral<dim> &
  Scene<dim>::adhesion() const
  {
    return *adhesion_integral;
  }



  template <int dim>
  const Objective<dealii::Vector<double>> &
  Scene<dim>::functional() const
  {
    return *energy;
  }



  template <int dim>
  const dealii::Vector<double> &
  Scene<dim>::start() const
  {
    return first_iterate;
  }



  template <int dim>
  const Probes<dim> &
  Scene<dim>::probes() const
  {
    return named_probes;
  }



  template <int dim>
  const Probes<dim> &
  Scene<dim>::means() const
  {
    return piece_means;
  }



  template <int dim>
  const std::vector<std::string> &
  Scene<dim>::notes() const
  {
    return body_notes;
  }



  template <int dim>
  const ProblemPiece<dim> *
  Scene<dim>::piece() const
  {
    return problem_piece.get();
  }



  template <int dim>
  const ContactBoundary<dim> &
  Scene<dim>::contact_boundary() const
  {
    return problem_piece ? problem_piece->boundary() :
                           elastic_problem->unknowns().contact().boundary();
  }



  template <int dim>
  dealii::Vector<double>
  Scene<dim>::contact_trace(const dealii::Vector<double> &u) const
  {
    return problem_piece ? problem_piece->trace(u) :
                           elastic_problem->unknowns().contact().trace(u);
  }



  template <int dim>
  unsigned int
  Scene<dim>::n_cells() const
  {
    return problem_piece ? static_cast<unsigned int>(elastic_body->n_cells()) :
                           triangulation.n_active_cells();
  }



  template <int dim>
  unsigned int
  Scene<dim>::n_unknowns() const
  {
    const ElasticUnknowns<dim> &unknowns = elastic_problem->unknowns();
    if (!problem_piece)
      return unknowns.n_free_dofs();
    unsigned int own = 0;
    for (const auto &[begin, end] : problem_piece->nodes().own_ranges())
      for (unsigned int i = begin * dim; i < end * dim; ++i)
        own += !unknowns.is_constrained(i);
    return dealii::Utilities::MPI::sum(own,
                                       problem_piece->nodes().communicator());
  }



  template <int dim>
  double
  Scene<dim>::mesh_seconds() const
  {
    return seconds_for_mesh;
  }



  template <int dim>
  double
  Scene<dim>::assembly_seconds() const
  {
    return seconds_for_assembly;
  }



  template class Scene<2>;
  template class Scene<3>;
} // namespace Debond
