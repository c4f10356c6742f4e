// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/bad_input.h>
#include <debond/input/load_parameters.h>

#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cmath>
#include <regex>

namespace Debond
{
  namespace
  {
    template <int dim>
    void
    add_material_constants(const Material &material, Constants &constants)
    {
      // An orthotropic material has no such numbers. emplace() keeps constants
      // of the scene that have these names.
      if (material.orthotropy)
        return;
      constants.emplace("E", material.young_modulus);
      constants.emplace("nu", material.poisson_ratio);
      constants.emplace("lambda", material.lame_lambda<dim>());
      constants.emplace("mu", material.shear_modulus());
    }



    const std::string constants_section = "Constants/";
    const std::string constants_list    = "Loads/Constants";

    // These names have a meaning in expressions or in other entries. A longer
    // name may begin with them.
    const std::string name_of_constant =
      "(?!([xyz]|free|true|false)\\b)[A-Za-z_]\\w*";



    /// Says whether a force is the same everywhere, as one without a place is.
    template <int dim>
    bool
    is_constant(const std::string &expression, const Constants &constants)
    {
      // The values at two points are compared. The second one has odd
      // coordinates, at which an expression of the place is the same as at the
      // origin only by chance.
      const auto         force = make_function<dim>(expression, constants);
      dealii::Point<dim> elsewhere;
      for (unsigned int d = 0; d < dim; ++d)
        elsewhere[d] = 0.71 + 0.13 * d;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double at_origin = force->value(dealii::Point<dim>(), d);
          if (!std::isfinite(at_origin) ||
              at_origin != force->value(elsewhere, d))
            return false;
        }
      return true;
    }
  } // namespace



  std::vector<SurfaceLoad>
  LoadParameters::on_boundaries() const
  {
    std::vector<SurfaceLoad> result;
    const auto add = [&result](const std::string &kind, const auto &loads) {
      for (const auto &[boundary, expression] : loads)
        result.push_back({kind, boundary, expression});
    };
    add("Traction", tractions);
    add("Pressure", pressures);
    add("Force", forces);
    return result;
  }



  void
  bind_loads(LoadParameters &loads, ParameterTable &table)
  {
    const Pattern expression = vector_expression();
    table.bind(
      "Loads/Body force",
      loads.body_force,
      expression,
      "The body force f_0 in global coordinates: expressions in x, y (and z in 3D) as muParser reads them; none if empty",
      "force per volume");
    const std::string traction = "The traction f_2 on the ";
    table.bind_family("Loads/Traction",
                      loads.tractions,
                      expression,
                      traction + "boundary of this name",
                      "force per area");
    // These members have an entry in each scene that is printed; all other
    // names are entries once the scene gives them.
    for (const std::string side :
         {"left", "right", "bottom", "top", "front", "back"})
      table.declare_member("Loads/Traction " + side,
                           traction + "side " + side + ", as the body force");
    table.bind_family(
      "Loads/Pressure",
      loads.pressures,
      Pattern("nothing, or an expression"),
      "The pressure on the boundary of this name, along its normal: a positive one presses on the body, with the traction -p n",
      "force per area");
    table.bind_family(
      "Loads/Force",
      loads.forces,
      expression,
      "The total force on the boundary of this name, spread evenly over it: an expression without x, y and z for each component. Of a plane body per thickness",
      "force, in 2D per length");
    table.bind(
      "Loads/Temperature change",
      loads.temperature_change,
      Pattern("nothing, or an expression"),
      "The change of temperature from the state without stresses, an expression as in the body force; see Material/Thermal expansion",
      "temperature");
  }



  void
  bind_constants(std::map<std::string, std::string> &texts,
                 ParameterTable                     &table)
  {
    table.bind_family(
      constants_section,
      texts,
      Pattern("a number, or an expression of other constants"),
      "A constant of this name, which numbers and expressions of all entries may use, such as 'Lengths = 2*a, a'; the DefineConstant of a .geo file takes it too. pi is known, and in expressions of the place, unless they are given here, the material's E, nu, lambda and mu (in plane stress the lambda of the plane problem)",
      "those that the entries need");
    const std::regex list("(\\s*" + name_of_constant +
                          "\\s*=[^=,]+(,(?!$)|$))*");
    table.declare(
      constants_list,
      "",
      Pattern("a list NAME=NUMBER, NAME=NUMBER, ... of names other than x, y "
              "and z",
              [list](const std::string &text) {
                return std::regex_match(text, list);
              }),
      "Constants in one line, such as 'q=0.69, L=0.4', beside those of the section Constants",
      "those that the entries need",
      [](const std::string &) {});
  }



  Constants
  constants_of(const ParameterTable &table)
  {
    // Constants come from a list in one entry and from the entries of a
    // section. A name that is in both is refused, since neither comes after the
    // other. Errors are thrown at once and not collected: without the constants
    // each entry that uses them would be an error too.
    using dealii::Utilities::split_string_list;
    std::map<std::string, std::string> texts, entries;
    for (const std::string &item :
         split_string_list(table.get(constants_list), ','))
      if (const auto parts = split_string_list(item, '='); parts.size() == 2)
        {
          entries[parts[0]] = constants_list;
          texts[parts[0]]   = parts[1];
        }
    const auto locations = table.locations();
    const auto error_of  = [&](const std::string &name,
                              const std::string &reason) {
      const std::string &entry = entries.at(name);
      return BadInput({words(locations.at(entry),
                             ": ",
                             entry,
                             " = ",
                             table.get(entry),
                             ": ",
                             reason)});
    };
    for (const auto &[path, unused] : locations)
      if (boost::starts_with(path, constants_section))
        {
          const std::string name = path.substr(constants_section.size());
          const bool is_first    = entries.insert_or_assign(name, path).second;
          texts[name]            = table.get(path);
          if (!is_first)
            throw error_of(name, "it is in Loads/Constants too");
        }
    for (const auto &[name, unused] : entries)
      if (!std::regex_match(name, std::regex(name_of_constant)))
        throw error_of(
          name,
          "the name of a constant has letters, digits and _, begins with no digit, and is not x, y, z, free, true or false");
    try
      {
        return evaluate_constants(texts);
      }
    catch (const EntryError &error)
      {
        throw error_of(error.entry, error.what());
      }
  }



  void
  join_names(const std::string           &list,
             const std::set<std::string> &known,
             std::set<std::string>       &names)
  {
    // Names are compared with the same blanks at their commas. Commas at both
    // ends keep one from being found within a longer one.
    const auto spaced = [](const std::string &text) {
      return ", " +
             join(dealii::Utilities::split_string_list(text, ','), ", ") + ",";
    };
    for (const std::string &name : known)
      if (name.find(',') != std::string::npos &&
          spaced(list).find(spaced(name)) != std::string::npos)
        {
          for (const std::string &piece :
               dealii::Utilities::split_string_list(name, ','))
            names.erase(piece);
          names.insert(name);
        }
  }



  void
  check_names(const std::string           &path,
              const std::set<std::string> &names,
              const BodyDescription       &body,
              ParameterTable              &table)
  {
    const std::set<std::string>    boundaries = body.boundaries();
    const std::vector<std::string> known(boundaries.begin(), boundaries.end());
    // How to name boundaries is said once.
    const bool is_said =
      std::any_of(table.errors.begin(),
                  table.errors.end(),
                  [](const std::string &error) {
                    return error.find("Physical Curve") != std::string::npos;
                  });
    // A part that is set but is no boundary was refused itself and needs no
    // second message. The words tell what the body has instead, and if the name
    // is that of something else, what that is.
    for (const std::string &name : names)
      if (boundaries.count(name) == 0 &&
          (body.regions().count(name) > 0 || !table.is_set("Parts/" + name)))
        table.reject(
          path,
          "the body has no boundary " + name +
            (!known.empty() ?
               ", but " + join(known, ", ") :
             is_said ?
               "" :
               "; physical groups of curves, in 3D of surfaces, are the boundaries, and its file has none: make them in Gmsh, such as Physical Curve(\"left\") = {4}, or name faces here by Parts, such as boundary: y < 1e-6") +
            (body.inner_groups.count(name) > 0 ?
               "; the group of this name lies inside the body or away from it; what is to come off there is cut along it, by Mesh/Cuts = " +
                 name :
             body.regions().count(name) > 0 ?
               "; the region of this name is a piece of the body, where Parts has pieces of a boundary, such as bottom: x < 1" :
               ""));
  }



  void
  check_expression(const std::string &path,
                   const std::string &expression,
                   const unsigned int dimension,
                   const unsigned int n_components,
                   const Constants   &constants,
                   ParameterTable    &table)
  {
    if (expression.empty())
      return;
    // The function is made only to see whether it can be made: this parses the
    // expression.
    try
      {
        if (dimension == 2)
          make_function<2>(expression, constants, n_components);
        else
          make_function<3>(expression, constants, n_components);
      }
    catch (const std::invalid_argument &error)
      {
        table.reject(path, error.what(), {"Dimension"});
      }
  }



  void
  complete_loads(const unsigned int dimension,
                 const Material    &material,
                 LoadParameters    &loads,
                 ParameterTable    &table)
  {
    // The constants of the material depend on the dimension, the lambda of
    // plane stress being that of the plane problem.
    if (dimension == 2)
      add_material_constants<2>(material, loads.constants);
    else
      add_material_constants<3>(material, loads.constants);

    check_expression("Loads/Body force",
                     loads.body_force,
                     dimension,
                     dimension,
                     loads.constants,
                     table);
    check_expression("Loads/Temperature change",
                     loads.temperature_change,
                     dimension,
                     1,
                     loads.constants,
                     table);
    for (const SurfaceLoad &load : loads.on_boundaries())
      check_expression(load.entry(),
                       load.expression,
                       dimension,
                       load.n_components(dimension),
                       loads.constants,
                       table);
    // A total force is spread evenly, so that it can have no place.
    for (const auto &[boundary, force] : loads.forces)
      try
        {
          if (!(dimension == 2 ? is_constant<2>(force, loads.constants) :
                                 is_constant<3>(force, loads.constants)))
            table.reject("Loads/Force " + boundary,
                         "a total force is finite and the same everywhere; "
                         "Loads/Traction takes expressions of the place");
        }
      catch (const std::invalid_argument &)
        {
          // check_expression() has said so.
        }
  }
} // namespace Debond
