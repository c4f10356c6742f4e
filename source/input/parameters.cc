// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/number_text.h>
#include <debond/base/text.h>
#include <debond/input/mesh_parameters.h>
#include <debond/input/parameters.h>
#include <debond/input/solver_parameters.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace Debond
{
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

    declare_mesh(table);

    table.declare("Material/Young modulus",
                  shortest_text(defaults.material.young_modulus),
                  quantity(),
                  "E",
                  "force per area");
    table.declare(
      "Material/Poisson ratio",
      shortest_text(defaults.material.poisson_ratio),
      any_number(),
      "nu, in (-1, 1) in plane stress and in (-1, 0.5) in plane strain and 3D",
      "none");
    table.declare("Material/Hypothesis",
                  "plane stress",
                  one_of({"plane stress", "plane strain"}),
                  "How the plane body represents a solid one; not used in 3D",
                  "none");

    table.declare(
      "Boundary conditions/Clamped boundaries",
      "left, right",
      list_of_names(),
      "Boundaries that form Gamma_D, where the displacement is zero. Of a box: left and right have the smallest and largest x, bottom and top y, back and front z (3D only)",
      "none");
    table.declare(
      "Boundary conditions/Contact boundary",
      "bottom",
      list_of_names(),
      "Boundaries that form Gamma_C, where the body rests on the foundation",
      "none");

    declare_loads(table);
    declare_load_path(table);

    declare_laws(table);
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

    declare_solver(table);

    table.declare(
      "Verification/Tolerance",
      shortest_text(defaults.verification_tolerance),
      positive_number(),
      "The program returns 3 if the equilibrium residual, the force imbalance (both relative to the forces) or the violation of the contact law of the result is larger, whatever the solver says",
      "none");

    table.declare(
      "Verification/Exact displacement",
      "",
      vector_expression(),
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
    std::error_code error;
    if (!std::filesystem::exists(scene, error))
      throw BadInput({scene + ": there is no such file"});
    std::ifstream input(scene);
    if (!input || std::filesystem::is_directory(scene))
      throw BadInput({scene + ": cannot be read as a scene file"});
    table.read(input, scene);
  }



  namespace
  {
    /// Checks that the body has boundaries of these names.
    void
    check_boundaries(ParameterTable              &table,
                     const std::string           &path,
                     const std::set<std::string> &names,
                     const std::set<std::string> &boundaries)
    {
      const std::vector<std::string> known(boundaries.begin(),
                                           boundaries.end());
      for (const std::string &name : names)
        if (boundaries.count(name) == 0)
          table.reject(path,
                       "the body has no boundary " + name + ", but " +
                         join(known, ", "));
    }



    void
    check_boundaries(ParameterTable &table, const Parameters &parameters)
    {
      const std::set<std::string> boundaries = parameters.body->boundaries();
      check_boundaries(table,
                       "Boundary conditions/Clamped boundaries",
                       parameters.clamped_boundaries,
                       boundaries);
      check_boundaries(table,
                       "Boundary conditions/Contact boundary",
                       parameters.contact_boundaries,
                       boundaries);
      for (const auto &[name, unused] : parameters.loads.tractions)
        check_boundaries(table, "Loads/Traction " + name, {name}, boundaries);
    }



    void
    check_consistency(ParameterTable &table, const Parameters &parameters)
    {
      // Otherwise there is an error already.
      if (parameters.body)
        check_boundaries(table, parameters);

      try
        {
          if (parameters.dimension == 2)
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

    p.body = read_body(scene, p.dimension, table);

    p.material.young_modulus = table.get_double("Material/Young modulus");
    p.material.poisson_ratio = table.get_double("Material/Poisson ratio");
    p.material.hypothesis = table.get("Material/Hypothesis") == "plane stress" ?
                              Material::Hypothesis::plane_stress :
                              Material::Hypothesis::plane_strain;

    const auto names = [&table](const std::string &path) {
      const std::vector<std::string> list = table.get_list(path);
      return std::set<std::string>(list.begin(), list.end());
    };
    p.clamped_boundaries = names("Boundary conditions/Clamped boundaries");
    p.contact_boundaries = names("Boundary conditions/Contact boundary");
    p.tangential_displacement_fixed =
      table.get("Contact law/Tangential displacement") == "fixed";

    p.loads     = read_loads(p.dimension, p.material, table);
    p.load_path = read_load_path(table);

    p.law             = read_law(table);
    p.quadrature_name = table.get("Contact law/Quadrature");
    p.quadrature      = ContactQuadratureParameters::parse(p.quadrature_name);

    read_solver(table, p);
    p.verification_tolerance = table.get_double("Verification/Tolerance");
    const std::string exact  = "Verification/Exact displacement";
    p.exact_displacement =
      read_expression(table, exact, p.dimension, p.loads.constants);

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
