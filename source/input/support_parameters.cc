// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/input/load_parameters.h>
#include <debond/input/support_parameters.h>

#include <algorithm>

namespace Debond
{
  void
  bind_supports(SupportParameters &supports, ParameterTable &table)
  {
    table.bind(
      "Boundary conditions/Roller boundaries",
      supports.rollers,
      "Flat boundaries where the normal displacement alone is zero: rollers, or planes of symmetry with the other half of the body behind them");
    table.bind_family(
      "Boundary conditions/Displacement",
      supports.displacements,
      Pattern(
        "nothing, or for each component 'free' or an expression, separated by ';'"),
      "The displacement of the boundary of this name in global coordinates, such as 'free; 0.001'; expressions as in Loads. Where it meets a flat contact boundary with Tangential displacement = fixed, it is along the normal of that. A load path's factors multiply it",
      "length");
    const Pattern     direction("nothing, or components separated by ';'");
    const std::string of_direction =
      "The direction of the foundation's normal, out of the body, such as '0; -1' for a sphere on a plane, expressions as in Loads of any length: u_nu, gap and bonds are along it in place of the body's own normal";
    table.bind("Boundary conditions/Foundation normal",
               supports.normal,
               direction,
               of_direction,
               "none");
    table.bind_family("Boundary conditions/Foundation normal",
                      supports.normals,
                      direction,
                      of_direction +
                        "; of the contact boundary or part of this name",
                      "none");
    const Pattern     gap("nothing, or an expression");
    const std::string documentation =
      "The distance g between the body at rest and the foundation, an expression as in Loads: u_nu <= g, and bonds are stretched by g - u_nu. Negative where the body is too large for its place (press fit)";
    table.bind(
      "Contact law/Initial gap", supports.gap, gap, documentation, "length");
    table.bind_family("Contact law/Initial gap",
                      supports.gaps,
                      gap,
                      documentation +
                        "; of the contact boundary or part of this name",
                      "length");
  }



  DisplacementText::DisplacementText(const std::string &text)
  {
    // Free components are no expressions. 0 stands for them, so that all
    // components can be parsed as one function, and the flags say which of its
    // values are prescribed.
    for (const std::string &word :
         dealii::Utilities::split_string_list(text, ';'))
      {
        is_prescribed.push_back(word != "free");
        expressions += (is_prescribed.size() == 1 ? "" : "; ") +
                       (is_prescribed.back() ? word : "0");
      }
  }



  void
  check_supports(const SupportParameters &supports,
                 const BodyDescription   &body,
                 const unsigned int       dimension,
                 const Constants         &constants,
                 ParameterTable          &table)
  {
    check_names("Boundary conditions/Roller boundaries",
                supports.rollers,
                body,
                table);
    // A displacement that prescribes nothing is refused: a support was meant
    // that is not there.
    for (const auto &[name, text] : supports.displacements)
      {
        const std::string path = "Boundary conditions/Displacement " + name;
        check_names(path, {name}, body, table);
        const DisplacementText components(text);
        check_expression(
          path, components.expressions, dimension, dimension, constants, table);
        if (std::none_of(components.is_prescribed.begin(),
                         components.is_prescribed.end(),
                         [](const bool is_prescribed) {
                           return is_prescribed;
                         }))
          table.reject(path, "all components are free: leave it out");
      }
    // Gap and normal have a text for the whole contact boundary and others for
    // boundaries or parts of it. Either of them may be wrong without the other
    // one.
    const auto check_all = [&](const std::string                        &entry,
                               const std::string                        &text,
                               const std::map<std::string, std::string> &own,
                               const unsigned int n_components) {
      check_expression(entry, text, dimension, n_components, constants, table);
      for (const auto &[name, expression] : own)
        {
          const std::string path = entry + ' ' + name;
          check_names(path, {name}, body, table);
          check_expression(
            path, expression, dimension, n_components, constants, table);
        }
    };
    check_all("Contact law/Initial gap", supports.gap, supports.gaps, 1);
    check_all("Boundary conditions/Foundation normal",
              supports.normal,
              supports.normals,
              dimension);
  }
} // namespace Debond
