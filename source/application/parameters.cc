// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/application/expression.h>
#include <debond/application/parameters.h>
#include <debond/application/text.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace Debond
{
  namespace
  {
    const std::vector<std::string> sides =
      {"left", "right", "bottom", "top", "front", "back"};

    const std::string bundle_section   = "Solver/Euclidean bundle/";
    const std::string energy_section   = "Solver/Energy bundle/";
    const std::string majorise_section = "Solver/Majorise minimise/";
    const std::string proof_section    = "Solver/Proof/";

    const std::vector<std::string> search_names = {"automatic",
                                                   "none",
                                                   "quick",
                                                   "full"};



    /// The shortest text that reads back as the same number.
    std::string
    to_text(const double number)
    {
      std::array<char, 32> text;
      const auto           end =
        std::to_chars(text.data(), text.data() + text.size(), number).ptr;
      return {text.data(), end};
    }



    template <typename Container>
    std::string
    to_text(const Container &numbers, const unsigned int count)
    {
      std::vector<std::string> words;
      for (unsigned int i = 0; i < count; ++i)
        words.push_back(to_text(static_cast<double>(numbers[i])));
      return join(words, ", ");
    }



    bool
    is_constant_name(const std::string &name)
    {
      return !name.empty() && name != "x" && name != "y" && name != "z" &&
             std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
             std::all_of(name.begin(), name.end(), [](const unsigned char c) {
               return std::isalnum(c) != 0 || c == '_';
             });
    }



    template <int dim>
    void
    add_material_constants(const Material                &material,
                           std::map<std::string, double> &constants)
    {
      constants.emplace("E", material.young_modulus);
      constants.emplace("nu", material.poisson_ratio);
      constants.emplace("lambda", material.lame_lambda<dim>());
      constants.emplace("mu", material.shear_modulus());
    }



    /// Reads "a = 1, b = 2". Returns false if the text is not such a list.
    bool
    read_constants(const std::string             &text,
                   std::map<std::string, double> &constants)
    {
      for (const std::string &item :
           dealii::Utilities::split_string_list(text, ','))
        {
          const std::size_t equals = item.find('=');
          if (equals == std::string::npos)
            return false;
          const std::string name =
            dealii::Utilities::trim(item.substr(0, equals));
          double value;
          if (!is_constant_name(name) ||
              !read_number(dealii::Utilities::trim(item.substr(equals + 1)),
                           value) ||
              !constants.emplace(name, value).second)
            return false;
        }
      return true;
    }



    void
    declare_loads(ParameterTable &table)
    {
      const Pattern expression("nothing, or an expression for each component, "
                               "separated by ';'",
                               [](const std::string & /*value*/) {
                                 return true;
                               });
      table.declare(
        "Loads/Body force",
        "",
        expression,
        "The body force f_0 in global coordinates: expressions in x, y (and z in 3D) as muParser reads them; none if empty",
        "force per volume");
      for (const std::string &side : sides)
        table.declare("Loads/Traction " + side,
                      "",
                      expression,
                      "The traction f_2 on the side " + side +
                        ", as the body force",
                      "force per area");
      table.declare(
        "Loads/Constants",
        "",
        Pattern(
          "a list NAME=NUMBER, NAME=NUMBER, ... of names other than x, y and z",
          [](const std::string &value) {
            std::map<std::string, double> constants;
            return read_constants(value, constants);
          }),
        "Names that the expressions may use, such as 'q=0.69, L=0.4'. pi is known, and unless they are given here, so are the material's E, nu, lambda and mu (in plane stress the lambda of the plane problem)",
        "those that the expressions need");
    }



    void
    declare_bundle(ParameterTable &table)
    {
      const ProximalBundleParameters defaults;
      const auto                     declare = [&](const std::string &name,
                               const std::string &value,
                               const Pattern     &pattern,
                               const std::string &documentation,
                               const std::string &units) {
        table.declare(
          bundle_section + name, value, pattern, documentation, units);
      };

      declare("Proximal weight",
              to_text(defaults.u),
              positive_number(),
              "u_k, the weight of the proximal term u_k/2 |d|^2",
              "energy per squared length");
      declare(
        "Distance weight",
        to_text(defaults.gamma),
        number(">= 0", [](double x) { return x >= 0; }),
        "gamma, the weight of the distance in the subgradient locality measure",
        "energy per squared length");
      declare("Long step threshold",
              to_text(defaults.t_bar),
              number("in (0, 1]", [](double x) { return x > 0 && x <= 1; }),
              "t_bar, the step length below which a step is a short one",
              "none");
      declare(
        "Descent fraction",
        to_text(defaults.m_L),
        number("in (0, 0.5)", [](double x) { return x > 0 && x < 0.5; }),
        "m_L, the part of the predicted descent that a step has to reach, eq. (14)",
        "none");
      declare(
        "Slope fraction",
        to_text(defaults.m_R),
        number("in (0, 1)", [](double x) { return x > 0 && x < 1; }),
        "m_R, the part of the predicted slope that a new subgradient has to exceed, eq. (15); above the descent fraction m_L",
        "none");
      declare(
        "Line search",
        "minimum",
        one_of({"largest", "halving", "minimum"}),
        "Which step with (14) is taken: 'largest' in [0, 1] by bisection, as in the paper's text; 'halving', the first of 1, 1/2, 1/4, ...; 'minimum', on along these while the functional falls, then the minimum of a parabola",
        "none");
      declare(
        "Stop tolerance",
        to_text(defaults.epsilon_s),
        positive_number(),
        "epsilon_s: the method stops when the predicted descent is not above it, v_k >= -epsilon_s",
        "energy");
      declare("Bundle size",
              std::to_string(defaults.bundle_size),
              whole_number(2, 100000),
              "Subgradients that are kept before the bundle is emptied",
              "none");
      declare(
        "Maximum iterations",
        std::to_string(defaults.maximum_iterations),
        whole_number(1, 1000000000),
        "Iterations after which the method gives up; the program then returns 3",
        "none");
      declare(
        "Start",
        "zero",
        Pattern("zero or a path",
                [](const std::string &value) { return !value.empty(); }),
        "The first iterate: zero is the undeformed body; otherwise the path of the displacement.txt of a scene with the same mesh and boundary conditions",
        "none");
    }



    void
    declare_condensed_methods(ParameterTable &table)
    {
      const Parameters defaults;
      table.declare(
        energy_section + "Stop tolerance",
        to_text(defaults.energy_bundle.epsilon_s),
        positive_number(),
        "epsilon_s relative to the energy 1/2 <A u, u> that the body has without contact",
        "none");
      table.declare(
        energy_section + "Distance weight",
        to_text(defaults.energy_bundle.gamma),
        number(">= 0", [](double x) { return x >= 0; }),
        "gamma, the weight of the distance, measured in the energy norm, in the subgradient locality measure",
        "none");
      table.declare(energy_section + "Bundle size",
                    std::to_string(defaults.energy_bundle.bundle_size),
                    whole_number(2, 1000),
                    "Subgradients that are kept before the bundle is emptied",
                    "none");
      table.declare(
        energy_section + "Maximum iterations",
        std::to_string(defaults.energy_bundle.maximum_iterations),
        whole_number(1, 1000000),
        "Iterations after which the method gives up; the program then returns 3",
        "none");

      table.declare(
        majorise_section + "Stop tolerance",
        to_text(defaults.majorise_minimise.tolerance),
        positive_number(),
        "The optimality conditions hold to this part of the largest force on a contact node",
        "none");
      table.declare(
        majorise_section + "Maximum iterations",
        std::to_string(defaults.majorise_minimise.maximum_iterations),
        whole_number(1, 1000000),
        "Iterations after which the method gives up; the program then returns 3",
        "none");
    }



    void
    declare_which_minimum(ParameterTable &table)
    {
      const Parameters defaults;
      table.declare(
        "Solver/Search",
        search_names[0],
        one_of(search_names),
        "Whether a lower minimum than the one found is searched for by changing which bonds are broken, with a direct linear solver: quick starts from rest and from all bonds broken and moves the edges of the broken patches by a node, full moves them by up to four nodes and breaks, closes and splits patches; automatic is quick if the method is automatic, on coarser contact nodes if there are more than 200, and none otherwise",
        "none");
      table.declare(
        "Solver/Prove",
        "false",
        one_of({"true", "false"}),
        "Whether the result is proved to be the global minimum, or replaced by it, by branch and bound on the broken bonds. Needs a direct linear solver and nodal quadrature",
        "none");
      table.declare(
        proof_section + "Tolerance",
        to_text(defaults.proof.tolerance),
        positive_number(),
        "The gap between J and its lower bound that counts as a proof, relative to J",
        "none");
      table.declare(
        proof_section + "Maximum nodes",
        std::to_string(defaults.proof.maximum_nodes),
        whole_number(1, 1000000000),
        "Nodes of the branch and bound tree after which the proof ends with the gap that is left",
        "none");
      table.declare(
        proof_section + "Maximum time",
        to_text(defaults.proof.maximum_seconds),
        positive_number(),
        "Wall time after which the proof ends with the gap that is left",
        "seconds");
      table.declare(
        proof_section + "Threads",
        "available",
        Pattern("available, or a whole number from 1 to 64",
                [whole = whole_number(1, 64)](const std::string &text) {
                  return text == "available" || whole.match(text);
                }),
        "Nodes that are bounded at the same time, at most 8; available is one for each core. The result does not depend on it, but for limits of time",
        "none");
    }
  } // namespace



  BadInput::BadInput(const std::vector<std::string> &errors)
    : std::invalid_argument(join(errors, "\n"))
    , lines(errors)
  {}



  void
  declare_parameters(ParameterTable &table)
  {
    const Parameters defaults;

    table.declare("Dimension",
                  std::to_string(defaults.dimension),
                  whole_number(2, 3),
                  "Space dimension",
                  "none");

    table.declare(
      "Mesh/Lengths",
      to_text(defaults.box.lengths, defaults.dimension),
      one_for_each_dimension(positive_number()),
      "Edge lengths of the box (0, L_1) x (0, L_2) [x (0, L_3)], one for each dimension",
      "length");
    table.declare(
      "Mesh/Cells",
      to_text(defaults.box.cells, defaults.dimension),
      one_for_each_dimension(whole_number(1, 1000000)),
      "Cells along each edge, before each is cut into 4 triangles (24 tetrahedra)",
      "none");
    table.declare(
      "Mesh/Rotation",
      to_text(defaults.box.rotation),
      number("in [-360, 360]", [](double x) { return std::abs(x) <= 360.; }),
      "Turns the box about the origin in the x-y plane. The sides keep their names; loads are not turned",
      "degrees");

    table.declare("Material/Young modulus",
                  to_text(defaults.material.young_modulus),
                  positive_number(),
                  "E",
                  "force per area");
    table.declare(
      "Material/Poisson ratio",
      to_text(defaults.material.poisson_ratio),
      any_number(),
      "nu, in (-1, 1) in plane stress and in (-1, 0.5) in plane strain and 3D",
      "none");
    table.declare("Material/Hypothesis",
                  "plane stress",
                  one_of({"plane stress", "plane strain"}),
                  "How the plane body represents a solid one; not used in 3D",
                  "none");

    const Pattern side_list = list_of(sides);
    table.declare(
      "Boundary conditions/Clamped boundaries",
      "left, right",
      side_list,
      "Sides that form Gamma_D, where the displacement is zero. Sides: left and right have the smallest and largest x, bottom and top y, back and front z (3D only)",
      "none");
    table.declare(
      "Boundary conditions/Contact boundary",
      "bottom",
      side_list,
      "Sides that form Gamma_C, where the body rests on the foundation",
      "none");

    declare_loads(table);
    declare_load_path(table);

    table.declare(
      "Contact law/Law",
      defaults.law.name,
      one_of(law_names()),
      "The adhesive law: winkler is the paper's, with bonds that pull in proportion to the displacement and break at the threshold; none has no adhesion",
      "none");
    table.declare("Contact law/Bond stiffness",
                  to_text(defaults.law.bond_stiffness),
                  number(">= 0", [](double x) { return x >= 0; }),
                  "a",
                  "force per volume");
    table.declare("Contact law/Bond threshold",
                  to_text(defaults.law.bond_threshold),
                  positive_number(),
                  "M, the displacement at which bonds break",
                  "length");
    table.declare(
      "Contact law/Quadrature",
      "nodal",
      Pattern("nodal, midpoint, gauss N with N from 1 to 99, or exact",
              [](const std::string &value) {
                try
                  {
                    ContactQuadratureParameters::parse(value);
                    return true;
                  }
                catch (const std::invalid_argument &)
                  {
                    return false;
                  }
              }),
      "The quadrature of the adhesion energy on each face: at the vertices, at the midpoint, Gauss' rule with N points, at most 99 (in 3D for each direction, at most 7), or exact for the piecewise linear displacement, split at the kinks of the law",
      "none");
    table.declare(
      "Contact law/Tangential displacement",
      "fixed",
      one_of({"fixed", "free"}),
      "On the contact boundary: fixed is the paper's simplification u_tau = 0, free is sigma_tau = 0",
      "none");

    table.declare(
      "Solver/Method",
      "automatic",
      one_of({"automatic",
              "euclidean bundle",
              "energy bundle",
              "majorise minimise"}),
      "The minimiser: euclidean bundle is the paper's proximal bundle method; energy bundle is the same method on the normal displacements of the contact nodes alone, in the energy norm; majorise minimise fixes the branch of the law at each quadrature point in turn and is exact after finitely many steps; automatic chooses and says why",
      "none");
    table.declare(
      "Solver/Linear solver",
      "automatic",
      one_of({"automatic", "direct", "multigrid"}),
      "How the linear systems of energy bundle and majorise minimise are solved: direct factorises A once and goes on with the contact normals alone, multigrid (majorise minimise only) iterates on all unknowns, starting from the solutions on coarser meshes, and takes less memory in large scenes; automatic chooses by size and memory. euclidean bundle needs none",
      "none");
    table.declare(
      "Solver/Memory limit",
      "available",
      Pattern("available, or a number > 0",
              [](const std::string &text) {
                double limit;
                return text == "available" ||
                       (read_number(text, limit) && limit > 0.);
              }),
      "The memory that a scene may take by the program's estimate; available is what the system can give at the start",
      "GiB");
    table.declare(
      "Solver/Checkpoint interval",
      to_text(defaults.checkpoint_interval),
      number(">= 0", [](double x) { return x >= 0; }),
      "Wall time after which the bundle methods write their state again, into the file checkpoint in the output directory, and when they end without success; 'debond SCENE.prm --restart' goes on from it with the same iterates. 0 writes none",
      "seconds");
    declare_bundle(table);
    declare_condensed_methods(table);
    declare_which_minimum(table);

    table.declare(
      "Verification/Tolerance",
      to_text(defaults.verification_tolerance),
      positive_number(),
      "The program returns 3 if the equilibrium residual, the force imbalance (both relative to the forces) or the violation of the contact law of the result is larger, whatever the solver says",
      "none");

    table.declare(
      "Verification/Exact displacement",
      "",
      Pattern("nothing, or an expression for each component, separated by ';'",
              [](const std::string & /*value*/) { return true; }),
      "If the displacement is known, expressions for it with the names of the loads: the log and summary.json then have the relative errors of u in the norms of L2, H1 and the energy",
      "length");

    table.declare(
      "Output/Directory",
      "output/{scene}",
      Pattern("a path",
              [](const std::string &value) { return !value.empty(); }),
      "Where files are written, relative to the working directory; created if missing. {scene} stands for the name of the scene file without its ending",
      "none");
    const auto declare_switch = [&](const std::string &name,
                                    const std::string &documentation,
                                    const std::string &value = "true") {
      table.declare("Output/" + name,
                    value,
                    one_of({"true", "false"}),
                    documentation,
                    "none");
    };
    declare_switch("Body VTU", "Write body.vtu, for ParaView");
    declare_switch("Contact VTU", "Write contact.vtu, for ParaView");
    declare_switch("Contact profile",
                   "Write contact_profile.csv, a row for each contact node");
    declare_switch("History", "Write history.csv, a row for each iteration");
    declare_switch(
      "Displacement",
      "Write displacement.txt, all degrees of freedom, from which another run can start",
      "false");
    declare_switch("Load path plots",
                   "Draw load_path*.png and .svg with gnuplot; their data and "
                   "scripts are written without it as well");
    declare_switch(
      "Load path contact VTU",
      "Write load_path_contact.pvd, the contact boundary at each factor, for ParaView");
    declare_switch(
      "Load path body VTU",
      "Write load_path_body.pvd, the body at each factor, for ParaView",
      "false");
    declare_switch(
      "Machine details",
      "Whether the log has what differs between machines: revision, times, paths, progress, numbers of iterations and figures that only rounding and the stop tolerance decide. Without them logs can be compared");
  }



  void
  read_scene(const std::string &scene, ParameterTable &table)
  {
    std::ifstream input(scene);
    if (!input || std::filesystem::is_directory(scene))
      throw BadInput({scene + ": cannot be read as a scene file"});
    table.read(input, scene);
  }



  namespace
  {
    /// Checks that a list has one value for each dimension.
    void
    check_length(ParameterTable    &table,
                 const std::string &path,
                 const unsigned int dimension)
    {
      if (table.get_list(path).size() != dimension)
        table.reject(path,
                     "expected " + std::to_string(dimension) +
                       " values for Dimension = " + std::to_string(dimension),
                     {"Dimension"});
    }



    std::set<std::string>
    read_sides(ParameterTable    &table,
               const std::string &path,
               const unsigned int dimension)
    {
      const std::vector<std::string> names = table.get_list(path);
      for (const std::string &name : names)
        if (dimension == 2 && (name == "front" || name == "back"))
          table.reject(path,
                       "there is no side " + name + " in 2D",
                       {"Dimension"});
      return {names.begin(), names.end()};
    }



    /// The text of an expression for a vector, empty for none.
    template <int dim>
    std::string
    read_expression(ParameterTable                      &table,
                    const std::string                   &path,
                    const std::map<std::string, double> &constants)
    {
      const std::string expression = table.get(path);
      try
        {
          if (!expression.empty())
            make_function<dim>(expression, constants);
        }
      catch (const std::invalid_argument &error)
        {
          table.reject(path, error.what(), {"Dimension", "Loads/Constants"});
        }
      return expression;
    }



    template <int dim>
    LoadParameters
    read_loads(const Material &material, ParameterTable &table)
    {
      LoadParameters loads;
      read_constants(table.get("Loads/Constants"), loads.constants);
      add_material_constants<dim>(material, loads.constants);

      const auto read = [&](const std::string &path) {
        return read_expression<dim>(table, path, loads.constants);
      };
      loads.body_force = read("Loads/Body force");
      for (const std::string &side : sides)
        {
          const std::string path     = "Loads/Traction " + side;
          const std::string traction = read(path);
          if (traction.empty())
            continue;
          loads.tractions[side] = traction;
          if (dim == 2 && (side == "front" || side == "back"))
            table.reject(path,
                         "there is no side " + side + " in 2D",
                         {"Dimension"});
        }
      return loads;
    }



    void
    check_consistency(ParameterTable &table, const Parameters &parameters)
    {
      const unsigned int dimension = parameters.dimension;
      check_length(table, "Mesh/Lengths", dimension);
      check_length(table, "Mesh/Cells", dimension);

      try
        {
          if (dimension == 2)
            parameters.material.validate<2>();
          else
            parameters.material.validate<3>();
        }
      catch (const std::invalid_argument &error)
        {
          table.add_error("Material/Poisson ratio",
                          error.what(),
                          {"Dimension",
                           "Material/Young modulus",
                           "Material/Hypothesis"});
        }

      for (const std::string &side : parameters.contact_boundaries)
        if (parameters.clamped_boundaries.count(side) > 0)
          table.reject("Boundary conditions/Contact boundary",
                       "the side " + side +
                         " is clamped already, by Clamped boundaries",
                       {"Boundary conditions/Clamped boundaries"});

      if (!parameters.exact_displacement.empty() &&
          !parameters.load_path.factors.empty())
        table.reject("Verification/Exact displacement",
                     "belongs to the given loads, not to those of a load path",
                     {"Load path/Factors"});

      // The patterns leave only m_L < m_R to be checked.
      try
        {
          parameters.bundle.validate();
        }
      catch (const std::invalid_argument &error)
        {
          table.add_error(bundle_section + "Slope fraction",
                          error.what(),
                          {bundle_section + "Descent fraction"});
        }
    }



    std::string
    output_directory(const ParameterTable &table, const std::string &scene)
    {
      std::string       directory   = table.get("Output/Directory");
      const std::string placeholder = "{scene}";
      const std::string name = std::filesystem::path(scene).stem().string();
      for (std::size_t at = directory.find(placeholder);
           at != std::string::npos;
           at = directory.find(placeholder, at + name.size()))
        directory.replace(at, placeholder.size(), name);
      return directory;
    }
  } // namespace



  Parameters
  to_parameters(const std::string &scene, ParameterTable &table)
  {
    Parameters p;
    p.scene     = scene;
    p.dimension = table.get_unsigned("Dimension");

    const std::vector<std::string> lengths = table.get_list("Mesh/Lengths");
    for (std::size_t d = 0; d < lengths.size(); ++d)
      read_number(lengths[d], p.box.lengths[d]);
    const std::vector<std::string> cells = table.get_list("Mesh/Cells");
    for (std::size_t d = 0; d < cells.size(); ++d)
      p.box.cells[d] = static_cast<unsigned int>(std::stoul(cells[d]));
    p.box.rotation = table.get_double("Mesh/Rotation");

    p.material.young_modulus = table.get_double("Material/Young modulus");
    p.material.poisson_ratio = table.get_double("Material/Poisson ratio");
    p.material.hypothesis = table.get("Material/Hypothesis") == "plane stress" ?
                              Material::Hypothesis::plane_stress :
                              Material::Hypothesis::plane_strain;

    p.clamped_boundaries =
      read_sides(table, "Boundary conditions/Clamped boundaries", p.dimension);
    p.contact_boundaries =
      read_sides(table, "Boundary conditions/Contact boundary", p.dimension);
    p.tangential_displacement_fixed =
      table.get("Contact law/Tangential displacement") == "fixed";

    p.loads     = p.dimension == 2 ? read_loads<2>(p.material, table) :
                                     read_loads<3>(p.material, table);
    p.load_path = read_load_path(table);

    p.law.name           = table.get("Contact law/Law");
    p.law.bond_stiffness = table.get_double("Contact law/Bond stiffness");
    p.law.bond_threshold = table.get_double("Contact law/Bond threshold");
    p.quadrature_name    = table.get("Contact law/Quadrature");
    p.quadrature = ContactQuadratureParameters::parse(p.quadrature_name);

    p.method        = table.get("Solver/Method");
    p.linear_solver = table.get("Solver/Linear solver");
    if (table.get("Solver/Memory limit") != "available")
      p.memory_limit = table.get_double("Solver/Memory limit") * (1 << 30);
    p.checkpoint_interval = table.get_double("Solver/Checkpoint interval");
    p.bundle.u     = table.get_double(bundle_section + "Proximal weight");
    p.bundle.gamma = table.get_double(bundle_section + "Distance weight");
    p.bundle.t_bar = table.get_double(bundle_section + "Long step threshold");
    p.bundle.m_L   = table.get_double(bundle_section + "Descent fraction");
    p.bundle.m_R   = table.get_double(bundle_section + "Slope fraction");
    p.energy_bundle.epsilon_s =
      table.get_double(energy_section + "Stop tolerance");
    p.energy_bundle.gamma =
      table.get_double(energy_section + "Distance weight");
    p.energy_bundle.bundle_size =
      table.get_unsigned(energy_section + "Bundle size");
    p.energy_bundle.maximum_iterations =
      table.get_unsigned(energy_section + "Maximum iterations");
    p.majorise_minimise.tolerance =
      table.get_double(majorise_section + "Stop tolerance");
    p.majorise_minimise.maximum_iterations =
      table.get_unsigned(majorise_section + "Maximum iterations");
    const auto search = std::find(search_names.begin(),
                                  search_names.end(),
                                  table.get("Solver/Search"));
    p.search          = static_cast<BondSearchChoice>(
      std::distance(search_names.begin(), search));
    p.prove               = table.get_bool("Solver/Prove");
    p.proof.tolerance     = table.get_double(proof_section + "Tolerance");
    p.proof.maximum_nodes = table.get_unsigned(proof_section + "Maximum nodes");
    p.proof.maximum_seconds = table.get_double(proof_section + "Maximum time");
    p.proof.n_threads = table.get(proof_section + "Threads") == "available" ?
                          std::max(1u, std::thread::hardware_concurrency()) :
                          table.get_unsigned(proof_section + "Threads");
    p.bundle.line_search =
      parse_descent_rule(table.get(bundle_section + "Line search"));
    p.bundle.epsilon_s   = table.get_double(bundle_section + "Stop tolerance");
    p.bundle.bundle_size = table.get_unsigned(bundle_section + "Bundle size");
    p.bundle.maximum_iterations =
      table.get_unsigned(bundle_section + "Maximum iterations");
    const std::string start = table.get(bundle_section + "Start");
    p.start                 = start == "zero" ? "" : start;

    p.verification_tolerance = table.get_double("Verification/Tolerance");
    const std::string exact  = "Verification/Exact displacement";
    p.exact_displacement =
      p.dimension == 2 ? read_expression<2>(table, exact, p.loads.constants) :
                         read_expression<3>(table, exact, p.loads.constants);

    p.output.directory = output_directory(table, scene);
    // The effective scene names the directory itself, so that a second run of
    // it does not write elsewhere.
    table.assign("Output/Directory=" + p.output.directory);
    p.output.body_vtu         = table.get_bool("Output/Body VTU");
    p.output.contact_vtu      = table.get_bool("Output/Contact VTU");
    p.output.contact_profile  = table.get_bool("Output/Contact profile");
    p.output.history          = table.get_bool("Output/History");
    p.output.displacement     = table.get_bool("Output/Displacement");
    p.output.path_plots       = table.get_bool("Output/Load path plots");
    p.output.path_contact_vtu = table.get_bool("Output/Load path contact VTU");
    p.output.path_body_vtu    = table.get_bool("Output/Load path body VTU");
    p.output.machine_details  = table.get_bool("Output/Machine details");

    check_consistency(table, p);
    if (!table.errors().empty())
      throw BadInput(table.errors());

    std::ostringstream effective;
    table.print(effective, false);
    p.effective_scene = effective.str();
    p.values          = table.values();
    for (const auto &[path, unused] : p.values)
      p.locations[path] = table.location(path);
    return p;
  }
} // namespace Debond
