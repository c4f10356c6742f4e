// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/number_text.h>
#include <debond/base/text.h>
#include <debond/input/mesh_parameters.h>
#include <debond/mesh/make_body.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    template <typename Container>
    std::string
    to_text(const Container &numbers, const unsigned int count)
    {
      std::vector<std::string> words;
      for (unsigned int i = 0; i < count; ++i)
        words.push_back(shortest_text(static_cast<double>(numbers[i])));
      return join(words, ", ");
    }



    Pattern
    any_text()
    {
      return Pattern("a text", [](const std::string &) { return true; });
    }



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



    void
    read_box(const unsigned int dimension,
             ParameterTable    &table,
             BoxParameters     &box)
    {
      check_length(table, "Mesh/Lengths", dimension);
      check_length(table, "Mesh/Cells", dimension);
      const std::vector<std::string> lengths = table.get_list("Mesh/Lengths");
      for (std::size_t d = 0; d < lengths.size(); ++d)
        read_number(lengths[d], box.lengths[d]);
      const std::vector<std::string> cells = table.get_list("Mesh/Cells");
      for (std::size_t d = 0; d < cells.size(); ++d)
        box.cells[d] = static_cast<unsigned int>(std::stoul(cells[d]));
      box.rotation = table.get_double("Mesh/Rotation");
    }



    /// Where a scene finds a file: relative to its own folder.
    std::string
    beside(const std::string &scene, const std::string &file)
    {
      return (std::filesystem::path(scene).parent_path() / file)
        .lexically_normal()
        .string();
    }
  } // namespace



  void
  declare_mesh(ParameterTable &table)
  {
    const BodyParameters defaults;

    table.declare(
      "Mesh/Source",
      "box",
      one_of({"box", "file", "generator"}),
      "Where the mesh comes from: a box of these Lengths, a File, or a Generator. Quadrilaterals and hexahedra are crossed: cut into 4 triangles, 24 tetrahedra each",
      "none");
    table.declare(
      "Mesh/Lengths",
      to_text(defaults.box.lengths, 2),
      one_for_each_dimension(quantity()),
      "Edge lengths of the box (0, L_1) x (0, L_2) [x (0, L_3)], one for each dimension",
      "length");
    table.declare(
      "Mesh/Cells",
      to_text(defaults.box.cells, 2),
      one_for_each_dimension(whole_number(1, 1000000)),
      "Cells of the box along each edge, before each is cut into 4 triangles (24 tetrahedra)",
      "none");
    table.declare(
      "Mesh/Rotation",
      shortest_text(defaults.box.rotation),
      number("in [-360, 360]", [](double x) { return std::abs(x) <= 360.; }),
      "Turns the box about the origin in the x-y plane. The sides keep their names; loads are not turned",
      "degrees");
    table.declare(
      "Mesh/File",
      "",
      any_text(),
      "A Gmsh file in ASCII, version 2.2 or 4.1; its path is relative to the scene's folder. Physical groups of curves (in 3D: of surfaces) are the boundaries and those of surfaces (volumes) the regions that the scene can name, by their names or else their numbers",
      "none");
    table.declare("Mesh/Scale",
                  shortest_text(defaults.scale),
                  quantity(),
                  "What the lengths of the file are multiplied by",
                  "length per the file's");
    table.declare(
      "Mesh/Generator",
      "",
      any_text(),
      "A function of deal.II's GridGenerator, such as plate_with_a_hole. Its boundary numbers are the names of the boundaries. Curved sides are straight between vertices",
      "none");
    table.declare(
      "Mesh/Arguments",
      "",
      any_text(),
      "All arguments of the generator, separated by colons, coordinates by commas, as in '0, 0 : 1 : false'",
      "those of the generator");
    table.declare(
      "Mesh/Refinements",
      std::to_string(defaults.n_refinements),
      whole_number(0, 10),
      "How often the quadrilaterals or hexahedra of a file or a generator are halved in each direction before they are crossed",
      "none");
  }



  std::shared_ptr<const BodyDescription>
  read_body(const std::string &scene,
            const unsigned int dimension,
            ParameterTable    &table)
  {
    using Source = BodyParameters::Source;
    BodyParameters    body;
    const std::string source = table.get("Mesh/Source");
    body.file                = table.get("Mesh/File");
    body.scale               = table.get_double("Mesh/Scale");
    body.generator           = table.get("Mesh/Generator");
    body.arguments           = table.get("Mesh/Arguments");
    body.n_refinements       = table.get_unsigned("Mesh/Refinements");

    std::string entry = "Mesh/Source"; // that errors belong to
    if (source == "file")
      {
        body.source = Source::file;
        entry       = "Mesh/File";
        if (body.file.empty())
          {
            table.reject(entry, "Source = file needs one", {"Mesh/Source"});
            return nullptr;
          }
        body.file = beside(scene, body.file);
        // The effective scene lies in another folder.
        table.assign("Mesh/File=" +
                     std::filesystem::absolute(body.file).string());
      }
    else if (source == "generator")
      {
        body.source = Source::generator;
        entry       = "Mesh/Generator";
        if (body.generator.empty())
          {
            table.reject(entry,
                         "Source = generator needs one",
                         {"Mesh/Source"});
            return nullptr;
          }
      }
    else
      read_box(dimension, table, body.box);

    const auto belongs_to = [&](const std::string &path,
                                const bool         is_given,
                                const std::string &other) {
      if (is_given && source != other)
        table.reject(path,
                     "this belongs to Source = " + other,
                     {"Mesh/Source"});
    };
    belongs_to("Mesh/File", !table.get("Mesh/File").empty(), "file");
    belongs_to("Mesh/Scale", body.scale != 1., "file");
    belongs_to("Mesh/Generator", !body.generator.empty(), "generator");
    belongs_to("Mesh/Arguments", !body.arguments.empty(), "generator");
    if (body.n_refinements > 0 && body.source == Source::box)
      table.reject("Mesh/Refinements", "a box has its Cells", {"Mesh/Source"});

    try
      {
        return make_body(dimension, body);
      }
    catch (const std::invalid_argument &error)
      {
        table.add_error(entry, error.what(), {"Mesh/Source"});
        return nullptr;
      }
  }
} // namespace Debond
