// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/timer.h>

#include <debond/base/instantiate.h>
#include <debond/elasticity/temperature_load.h>
#include <debond/input/bad_input.h>
#include <debond/input/probe_parameters.h>
#include <debond/mesh/distributed_mesh.h>
#include <debond/mesh/owned_cells.h>
#include <debond/solve/minimum/displacement.h>
#include <debond/solve/scene/scene.h>
#include <debond/solve/scene/scene_conditions.h>
#include <debond/solve/scene/scene_loads.h>

#include <boost/serialization/set.hpp>

namespace Debond
{
  namespace
  {
    /// With fewer unknowns two ranks take about twice the processor time of
    /// one, or more, so that they are no faster (doc/notes/speed.md).
    constexpr unsigned int worth_ranks = 100000;



    /// Throws std::invalid_argument if the file has no displacement that the
    /// problem admits.
    template <int dim>
    DofVector
    read_start(const std::string &file_name, const ElasticProblem<dim> &problem)
    {
      // The start has to be a w of this scene: zero where displacements are
      // prescribed, and with s <= 0 at all contact nodes.
      const DofVector u = read_displacement(file_name, problem.unknowns());
      bool            admissible = true;
      for (unsigned int i = 0; i < problem.unknowns().n_dofs(); ++i)
        admissible =
          admissible && (u(i) == 0. || !problem.unknowns().is_constrained(i));
      if (!admissible || !problem.unknowns().contact().is_admissible(u))
        throw std::invalid_argument(
          file_name + " does not satisfy the scene's boundary conditions");
      return u;
    }
  } // namespace



  template <int dim>
  Scene<dim>::Scene(const ProblemParameters         &given,
                    std::shared_ptr<const Body<dim>> body,
                    const std::string               &start,
                    const MPI_Comm                   ranks)
    : given(given)
    , elastic_body(std::move(body))
    , body_materials(given.materials.everywhere)
  {
    dealii::Timer timer;
    std::string   entry = "Mesh/Source"; // that errors belong to
    // What is wrong shows deep inside mesh, elasticity and bonds, which do not
    // know where in the file an entry is. They name the entry if they know it;
    // otherwise the error belongs to the step that was under way. Which of
    // several entries the user has given, and in which line, is found out here.
    const auto describe = [&](const std::invalid_argument &error) {
      if (entry == "Mesh/Source" && !elastic_body->cuts.empty())
        entry = "Mesh/Cuts";
      if (const auto *own = dynamic_cast<const EntryError *>(&error))
        entry = own->entry;
      if (const auto *support = dynamic_cast<const SupportError *>(&error);
          support != nullptr && given.locations.count(entry) == 0)
        entry = given.supports.rollers.count(support->name) > 0 ?
                  "Boundary conditions/Roller boundaries" :
                  "Boundary conditions/Clamped boundaries";
      if (const auto *bonds = dynamic_cast<const BondFieldError *>(&error))
        {
          // Bonds that soften have their threshold from the strength.
          if (entry == "Contact law/Bond stiffness")
            entry = given.law.stiffness_entry;
          else if (entry == "Contact law/Bond threshold" &&
                   !given.law.energy.empty())
            entry = "Contact law/Bond strength";
          if (const std::string own = entry + ' ' + bonds->boundary;
              given.locations.count(own) > 0)
            entry = own;
        }
      return given.locations.at(entry) + ": " + entry + ": " + error.what();
    };
    // An error on one rank alone has to end the others as well, which would
    // wait for its messages.
    on_all_ranks(ranks, [&]() {
      try
        {
          add_problem(ranks, entry);
          entry = "Contact law/Quadrature";
          add_contact();
          entry = "Solver/Euclidean bundle/Start";
          add_start(start);
        }
      catch (const std::invalid_argument &error)
        {
          if (dynamic_cast<const ErrorElsewhere *>(&error) != nullptr)
            throw;
          throw BadInput({describe(error)});
        }
    });
    add_notes();
    seconds_for_assembly = timer.wall_time() - seconds_for_mesh;
  }



  template <int dim>
  void
  Scene<dim>::add_problem(const MPI_Comm ranks, std::string &entry)
  {
    dealii::Timer timer;
    // Names of boundaries, regions and parts are known by the body; here they
    // become ids on the mesh that these ranks share.
    const PieceNames names = [&]() {
      const Stage          stage("mesh");
      DistributedMesh<dim> mesh = make_distributed_mesh(*elastic_body, ranks);
      triangulation             = std::move(mesh.triangulation);
      return mesh.names;
    }();
    const BoundaryNames &boundaries = names.boundaries;
    body_notes                      = names.notes;
    seconds_for_mesh                = timer.wall_time();

    const Stage stage("assembly");
    entry = "Boundary conditions/Clamped boundaries";
    // Supports decide the unknowns, and these the pattern of A; loads and
    // materials only its entries. The entry is the one that an error of the
    // next step most likely belongs to, such as a free rigid motion to the
    // clamped boundaries.
    boundary_conditions = make_conditions(given, names);
    body_supports       = make_supports<dim>(given, boundary_conditions);
    elastic_problem     = std::make_unique<ElasticProblem<dim>>(*triangulation,
                                                            boundary_conditions,
                                                            body_supports,
                                                            given.degree);
    check_held_vertices(elastic_problem->unknowns(),
                        displacement_factors(given.load_path));
    entry                                   = "Material/Poisson ratio";
    const std::set<std::string> &dead_loads = given.load_path.dead_loads;
    const auto                   loads_of   = [&](const bool dead) {
      return make_loads<dim>(given.loads,
                             dead_loads,
                             dead,
                             given.symmetry,
                             boundaries,
                             *triangulation);
    };
    body_loads      = loads_of(false);
    body_dead_loads = loads_of(true);
    body_materials  = make_materials(given.materials, names.regions);
    // Extreme ratios of moduli are refused instead of solved wrongly. The
    // extremes of the whole body are those of all ranks.
    std::set<double> moduli;
    for (const auto &cell : owned_cells(*triangulation))
      for (const double modulus :
           body_materials(cell->material_id()).extreme_moduli())
        moduli.insert(modulus);
    for (const std::set<double> &of_rank :
         dealii::Utilities::MPI::all_gather(ranks, moduli))
      moduli.insert(of_rank.begin(), of_rank.end());
    // At nodes between parts the forces of both are in one sum, of whose 16
    // digits the softer one has four.
    if (!moduli.empty() && *moduli.rbegin() > 1e12 * *moduli.begin())
      throw EntryError("Material/Young modulus",
                       words("moduli of ",
                             *moduli.begin(),
                             " and ",
                             *moduli.rbegin(),
                             " in one body are more than 1e12 apart, too far "
                             "for double precision; what is 1e6 times as stiff "
                             "as the rest is as good as rigid"));
    elastic_problem->assemble(body_materials, body_loads, body_dead_loads);
    // The least force that is resolved is a part of the largest nodal force, of
    // loads or of what supports prescribe, at any factor of the path. Both are
    // linear in their factor, so that the extreme factors decide. What gaps
    // make of the body's stiffness is left out: no force has to be small beside
    // that.
    std::vector<double> factors = given.load_path.factors;
    if (factors.empty())
      factors = {1.};
    const auto [least, largest] =
      std::minmax_element(factors.begin(), factors.end());
    for (const double factor : {*least, *largest})
      resolved_force = std::max(
        resolved_force,
        elastic_problem->fields().applied_nodal_forces(factor).linfty_norm());
    DofVector of_supports = elastic_problem->load({0., 1.});
    of_supports -= elastic_problem->load(0.);
    for (const double factor : displacement_factors(given.load_path))
      resolved_force =
        std::max(resolved_force, std::abs(factor) * of_supports.linfty_norm());
    resolved_force *= Tolerance::negligible_force;
    // Means over all pieces with a name are reported for every scene, probes if
    // it asks for them.
    piece_means  = Probes<dim>(elastic_problem->unknowns(),
                              names,
                              means_of_pieces<dim>(names));
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
        // The paper starts from zero displacement. Over a gap, rest means that
        // the contact nodes are as far above the foundation as the gap is wide.
        const ContactSpace<dim> &contact =
          elastic_problem->unknowns().contact();
        first_iterate.reinit(elastic_problem->unknowns().n_dofs());
        contact.add(contact.at_rest(), first_iterate);
      }
    else
      first_iterate = read_start(file, *elastic_problem);
  }



  template <int dim>
  void
  Scene<dim>::add_notes()
  {
    const ContactBoundary<dim> &boundary = contact_boundary();
    if (boundary.nodes.empty() && boundary.held_vertices.empty() &&
        !boundary_conditions.contact.empty())
      body_notes.push_back(
        "the contact boundary has no contact node, and contact and bonds "
        "decide nothing: all its vertices are held by supports, or as corners "
        "by fixed tangential displacements. A finer mesh has others, and "
        "Contact law/Tangential displacement = free does not hold corners");
    // A load where the displacement is given is often meant for another place.
    std::set<dealii::types::boundary_id> held = boundary_conditions.clamped;
    for (const auto &[name, text] : given.supports.displacements)
      if (text.find("free") == std::string::npos)
        {
          const auto &ids = boundary_conditions.names.at(name);
          held.insert(ids.begin(), ids.end());
        }
    for (const SurfaceLoad &load : given.loads.on_boundaries())
      if (const std::set<dealii::types::boundary_id> &ids =
            boundary_conditions.names.at(load.boundary);
          load.expression.find_first_not_of("0;. ") != std::string::npos &&
          std::includes(held.begin(), held.end(), ids.begin(), ids.end()))
        body_notes.push_back("no effect of " + load.entry() +
                             ": the displacement is given there");
    body_notes.insert(body_notes.end(),
                      elastic_problem->load_notes().begin(),
                      elastic_problem->load_notes().end());
    if (const unsigned int n = number_of_ranks(ranks());
        n > 1 && n_unknowns() < worth_ranks)
      body_notes.push_back(words(n,
                                 " ranks take longer than one for ",
                                 n_unknowns(),
                                 " unknowns: they pay from about ",
                                 worth_ranks,
                                 " on"));
    if (n_unknowns() == 0)
      body_notes.push_back("no vertex is free, so that there is nothing to "
                           "solve: J is that of the prescribed displacements");
  }



  template <int dim>
  void
  Scene<dim>::add_contact()
  {
    // The law as pieces, the quadrature of int j_1(v_nu) over Gamma_C, and, if
    // bonds vary, their scales at its points together make Phi(s).
    adhesive_law = std::make_unique<AdhesiveLaw>(given.law.pieces);
    quadrature =
      std::make_unique<ContactQuadrature<dim>>(given.quadrature, given.degree);
    if (given.law.has_field() || boundary_conditions.has_shear())
      bond_field =
        make_bond_field<dim>(given, *adhesive_law, boundary_conditions);
    adhesion_integral = std::make_unique<AdhesionIntegral<dim>>(
      contact_boundary(), *adhesive_law, *quadrature, bond_field.get());
    if (given.friction.is_somewhere())
      adhesion_integral->set_friction(
        make_friction(given, boundary_conditions, contact_boundary()));
    if (const unsigned int n = adhesion_integral->friction().n_moved; n > 0)
      body_notes.push_back(
        words("friction is left out at ",
              n,
              n == 1 ? " node" : " nodes",
              " that supports move along the boundary: reactions and what is "
              "dissipated lack its part there, which is less on finer meshes"));
    // Bonds that vary are expressions, which may be wrong at points that the
    // solve does not ask for but the estimate of the error does. They are
    // evaluated there now, so that the error comes before the solve.
    if (bond_field)
      {
        const Loads<dim> none;
        estimate_error<dim>({*elastic_problem,
                             *adhesion_integral,
                             boundary_conditions,
                             body_supports,
                             none},
                            DofVector(elastic_problem->unknowns().n_dofs()),
                            0.);
      }
    // The functional of the paper on all unknowns, for its bundle method;
    // condensed methods make theirs of S and g.
    const auto &dofs = elastic_problem->unknowns().contact().dofs();
    energy           = std::make_unique<Functional>(
      [this](DofVector &dst, const DofVector &src) {
        elastic_problem->vmult(dst, src);
      },
      elastic_problem->load(),
      std::vector<unsigned int>(dofs.begin(), dofs.end()),
      *adhesion_integral);
  }



  DEBOND_INSTANTIATE_CLASS(Scene);
} // namespace Debond
