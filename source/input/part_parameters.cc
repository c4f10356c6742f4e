// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/text.h>
#include <debond/contact/field_value.h>
#include <debond/input/expression.h>
#include <debond/input/part_parameters.h>
#include <debond/mesh/body.h>

#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// Throws PartError where the condition has no value.
    template <int dim>
    std::function<bool(const dealii::Point<dim> &)>
    make_condition(const std::string                   &part,
                   const std::string                   &expression,
                   const std::map<std::string, double> &constants)
    {
      return [part, function = make_function<dim>(expression, constants, 1)](
               const dealii::Point<dim> &point) {
        try
          {
            return field_value(*function, point) != 0.;
          }
        catch (const std::invalid_argument &error)
          {
            throw PartError(part, error.what());
          }
      };
    }



    /// Throws std::invalid_argument if the text is no part of this body.
    template <int dim>
    Part<dim>
    make_part(const Body<dim>                     &body,
              const std::string                   &name,
              const std::string                   &text,
              const std::map<std::string, double> &constants)
    {
      const std::set<std::string> boundaries = body.boundaries();
      if (boundaries.count(name) > 0 || body.regions().count(name) > 0)
        throw std::invalid_argument("the body has a piece of this name");

      // A colon may also belong to muParser's "condition ? a : b".
      const std::size_t colon = text.find(':');
      const bool        is_of_boundary =
        colon != std::string::npos && text.find('?') > colon;
      Part<dim> part;
      part.name = name;
      if (is_of_boundary)
        {
          part.boundary = dealii::Utilities::trim(text.substr(0, colon));
          if (boundaries.count(part.boundary) == 0 &&
              part.boundary != whole_boundary)
            throw std::invalid_argument(
              words("the body has no boundary ",
                    part.boundary,
                    ", but ",
                    join({boundaries.begin(), boundaries.end()}, ", "),
                    boundaries.empty() ? "" : " and ",
                    whole_boundary,
                    ", which is all of it"));
        }
      part.contains =
        make_condition<dim>(name,
                            is_of_boundary ? text.substr(colon + 1) : text,
                            constants);
      return part;
    }



    template <int dim>
    void
    make_parts(BodyDescription                          &description,
               const std::map<std::string, std::string> &texts,
               const std::map<std::string, double>      &constants,
               ParameterTable                           &table)
    {
      auto                  &body = dynamic_cast<Body<dim> &>(description);
      std::vector<Part<dim>> parts;
      for (const auto &[name, text] : texts)
        try
          {
            parts.push_back(make_part(body, name, text, constants));
          }
        catch (const std::invalid_argument &error)
          {
            table.reject("Parts/" + name,
                         error.what(),
                         {"Dimension", "Loads/Constants"});
          }
      body.parts = parts;
    }
  } // namespace



  void
  bind_parts(std::map<std::string, std::string> &parts, ParameterTable &table)
  {
    table.bind_family(
      "Parts/",
      parts,
      Pattern("an expression, or the name of a boundary, a colon and an "
              "expression"),
      "A piece of a boundary or of the body, by a condition on x, y (and z in 3D) such as 'bottom: x > 0.05' or 'y > 0.02'; its name can stand wherever that of a boundary (a region) can. 'boundary: y < 1e-6' is of all outer faces, which need no name of their own. Faces (cells) belong to it if their centre does");
  }



  void
  add_parts(BodyDescription                          &body,
            const std::map<std::string, std::string> &parts,
            const unsigned int                        dimension,
            const std::map<std::string, double>      &constants,
            ParameterTable                           &table)
  {
    if (dimension == 2)
      make_parts<2>(body, parts, constants, table);
    else
      make_parts<3>(body, parts, constants, table);
  }
} // namespace Debond
