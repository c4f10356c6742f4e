// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/tolerances.h>
#include <debond/input/mesh_parameters.h>
#include <debond/mesh/field_value.h>

#include <filesystem>

namespace Debond
{
  namespace
  {
    /// Binds the first entries of an array; the default has two of them.
    template <typename Number>
    void
    bind_for_each_dimension(const std::string     &path,
                            std::array<Number, 3> &variable,
                            const Pattern         &pattern,
                            const std::string     &documentation,
                            const std::string     &units,
                            ParameterTable        &table)
    {
      // The dimension may stand further down in the scene, so that two or three
      // numbers are allowed here. check_box() compares them with it.
      table.declare(
        path,
        join({shortest_text(variable[0]), shortest_text(variable[1])}, ", "),
        Pattern("2 or 3 times " + pattern.description() +
                  ", separated by commas",
                [list = dealii::Patterns::List(pattern, 2, 3)](
                  const std::string &text) { return list.match(text); }),
        documentation,
        units,
        [&variable](const std::string &text) {
          const std::vector<std::string> words =
            dealii::Utilities::split_string_list(text, ',');
          for (std::size_t d = 0; d < words.size(); ++d)
            {
              double number;
              read_number(words[d], number);
              variable[d] = static_cast<Number>(number);
            }
        });
    }



    /// Checks that the lists have one value for each dimension.
    void
    check_box(const unsigned int dimension, ParameterTable &table)
    {
      for (const std::string path : {"Mesh/Lengths", "Mesh/Cells"})
        if (dealii::Utilities::split_string_list(table.get(path), ',').size() !=
            dimension)
          table.reject(
            path,
            "expected " + std::to_string(dimension) +
              " values for Dimension = " + std::to_string(dimension) +
              (path == "Mesh/Cells" ? "" : number_hint(table.get(path))),
            {"Dimension"});
    }
  } // namespace



  void
  bind_mesh(BodyParameters &body, ParameterTable &table)
  {
    using Source = BodyParameters::Source;
    table.bind_choice(
      "Mesh/Source",
      body.source,
      {{"box", Source::box},
       {"file", Source::file},
       {"generator", Source::generator}},
      "Where the mesh comes from: a box of these Lengths, a File, or a Generator. Quadrilaterals and hexahedra are crossed: cut into 4 triangles, 24 tetrahedra each");
    bind_for_each_dimension(
      "Mesh/Lengths",
      body.box.lengths,
      quantity(),
      "Edge lengths of the box (0, L_1) x (0, L_2) [x (0, L_3)], one for each dimension",
      "length",
      table);
    bind_for_each_dimension(
      "Mesh/Origin",
      body.box.origin,
      number(),
      "Where the box begins instead, one coordinate for each dimension, or two of them",
      "length",
      table);
    bind_for_each_dimension(
      "Mesh/Cells",
      body.box.cells,
      whole_number(1, 1000000),
      "Cells of the box along each edge, before each is cut into 4 triangles (24 tetrahedra)",
      "none",
      table);
    table.bind(
      "Mesh/Rotation",
      body.box.rotation,
      number("in [-360, 360]", [](double x) { return std::abs(x) <= 360.; }),
      "Turns the body about the origin in the x-y plane. The sides keep their names; loads are not turned",
      "degrees");
    table.bind(
      "Mesh/Cuts",
      body.cuts,
      Pattern("a text"),
      "Surfaces along which the body is cut into several: 'y = 2' is a line of the mesh (before the Rotation), 'y = 2 && x < 60' a part of it, and 'core | ring' is where these regions of a File meet, 'fault' a group of curves (in 3D of surfaces) inside it; more of them after commas. Their names are cut_1, cut_2, ..., those of their sides cut_1_low, cut_1_high, ..., at a group also fault, fault_low, fault_high; as a Contact boundary cut_1 glues the bodies to each other",
      "length");
    table.bind(
      "Mesh/Interfaces",
      body.interfaces,
      Pattern("a text"),
      "Where bodies of a File meet that have no nodes in common: 'a | b' are two boundaries, or two regions whose sides lie on each other; more of them after commas. Their meshes need not match. The nodes of the first side carry the jumps; it has to be covered by the other one and is best the finer one. Their names are interface_1, interface_2, ..., or NAME for 'NAME: a | b', and those of their sides NAME_high (the first one) and NAME_low; as a Contact boundary NAME glues the bodies to each other. Sides apart have the distance in the mesh as their gap");
    table.bind(
      "Mesh/File",
      body.file,
      Pattern("a text"),
      "A mesh, or a geometry to be meshed, in any format that Gmsh reads: .msh, .unv, .bdf, .geo, .step, .brep and others; its path is relative to the scene's folder. Physical groups of curves (in 3D: of surfaces) are the boundaries and those of surfaces (volumes) the regions that the scene can name, by their names or else their numbers; without groups the names of the solids in a .step file are the regions. Parts name boundaries without a group");
    table.bind(
      "Mesh/Scale",
      body.scale,
      quantity(),
      "What the lengths of the file are multiplied by. Those of .step files come in mm, whatever they are in there",
      "length per the file's");
    table.bind(
      "Mesh/Size",
      body.meshing.size,
      quantity(true),
      "How long the edges of cells are if the File is a geometry. 0 leaves it to the file, or to Gmsh. What makes more cells than there is memory for is refused",
      "length");
    table.bind(
      "Mesh/Generator",
      body.generator,
      Pattern("a text"),
      "A function of deal.II's GridGenerator, such as plate_with_a_hole. Its boundary numbers are the names of the boundaries. Curved sides are straight between vertices");
    table.bind(
      "Mesh/Arguments",
      body.arguments,
      text_with_numbers("a text"),
      "All arguments of the generator, separated by colons, coordinates by commas, as in '0, 0 : 1 : false'",
      "those of the generator");
    table.bind(
      "Mesh/Refinements",
      body.n_refinements,
      whole_number(0, 10),
      "How often the quadrilaterals or hexahedra of a file or a generator are halved in each direction before they are crossed");
  }



  namespace
  {
    /// Throws EntryError where the condition has no value.
    template <int dim>
    std::function<bool(const dealii::Point<dim> &)>
    make_condition(const std::string &entry,
                   const std::string &expression,
                   const Constants   &constants)
    {
      // An expression that compares nothing is other than 0 nearly everywhere
      // and would contain all of the body.
      if (expression.find_first_of("<>=") == std::string::npos)
        throw std::invalid_argument("'" + dealii::Utilities::trim(expression) +
                                    "' compares nothing, as x > 0.1 does");
      // The condition is evaluated when the mesh is made. What is thrown then
      // names the entry, which the mesh does not know.
      return [entry, function = make_function<dim>(expression, constants, 1)](
               const dealii::Point<dim> &point) {
        try
          {
            return field_value(*function, point) != 0.;
          }
        catch (const std::invalid_argument &error)
          {
            throw EntryError(entry, error.what());
          }
      };
    }



    /// Throws std::invalid_argument if the text is no cut of this body.
    template <int dim>
    Cut<dim>
    make_cut(const Body<dim>   &body,
             const std::string &text,
             const double       degrees,
             const Constants   &constants)
    {
      // A cut is a group of faces, or a coordinate and a number, perhaps with a
      // condition behind &&, or two regions. An '=' tells which of the last two
      // it is. A group may lie on the outside by what its file has, if that is
      // open there.
      Cut<dim> cut;
      cut.text                     = text;
      cut.rotation                 = rotation_matrix<dim>(degrees);
      std::set<std::string> groups = body.boundaries();
      groups.insert(body.inner_groups.begin(), body.inner_groups.end());
      if (groups.count(text) > 0)
        {
          cut.group = text;
          return cut;
        }
      const std::size_t ampersands = text.find("&&");
      const std::string place_text = text.substr(0, ampersands);
      const bool        is_plane   = place_text.find('=') != std::string::npos;
      const auto        sides =
        dealii::Utilities::split_string_list(place_text, is_plane ? '=' : '|');
      if (sides.size() != 2)
        throw std::invalid_argument(
          text +
          " is neither a line of the mesh, as y = 2 or y = 2 && x < 60, "
          "nor two regions, as core | ring, nor a group of faces" +
          (groups.empty() ?
             "" :
             ", as " + join({groups.begin(), groups.end()}, ", ")));
      const std::size_t axis = std::string("xyz").substr(0, dim).find(sides[0]);
      double            place = 0.;
      if (!is_plane)
        {
          if (ampersands != std::string::npos)
            throw std::invalid_argument(
              text +
              ": the cut between two regions is where they meet, without "
              "a condition");
          cut.low  = sides[0];
          cut.high = sides[1];
          for (const std::string &side : sides)
            if (const auto regions = body.regions(); regions.count(side) == 0)
              throw std::invalid_argument(
                "the body has no region " + side +
                (regions.empty() ?
                   "" :
                   ", but " + join({regions.begin(), regions.end()}, ", ")));
          return cut;
        }
      if (axis >= dim || sides[0].size() != 1 ||
          !read_number(with_values(sides[1], constants), place))
        throw std::invalid_argument(text +
                                    ": expected a coordinate and a number");
      // Plane and condition are those of the body before it is turned. The
      // normal is turned with the body, and the centre of a face is turned back
      // for the condition. A face is on the plane if all of its vertices are,
      // but for the rounding of coordinates, which grows with their distance
      // from the origin.
      cut.normal = cut.rotation * dealii::Point<dim>::unit_vector(
                                    static_cast<unsigned int>(axis));
      std::function<bool(const dealii::Point<dim> &)> condition;
      if (ampersands != std::string::npos)
        condition = make_condition<dim>("Mesh/Cuts",
                                        text.substr(ampersands + 2),
                                        constants);
      cut.contains = [=, normal = cut.normal, rotation = cut.rotation](
                       const auto &face) {
        for (unsigned int v = 0; v < dim; ++v)
          if (std::abs(face->vertex(v) * normal - place) >
              Tolerance::same_coordinate *
                (face->diameter() + face->vertex(v).norm()))
            return false;
        return !condition || condition(dealii::Point<dim>(transpose(rotation) *
                                                          face->center()));
      };
      return cut;
    }



    /// Throws std::invalid_argument if the text is no interface of this body.
    /// @p number: in the order of all.
    Interface
    make_interface(const BodyDescription &body,
                   const std::string     &text,
                   const std::size_t      number)
    {
      const std::set<std::string> boundaries = body.boundaries();
      std::set<std::string>       known      = body.regions();
      known.insert(boundaries.begin(), boundaries.end());
      std::vector<std::string> sides =
        dealii::Utilities::split_string_list(text, '|');
      // Parts of other programs have colons in their own names, as bolt:2.
      std::string       name  = "interface_" + std::to_string(number);
      const std::size_t colon = text.find(':');
      if (sides.size() == 2 && colon != std::string::npos &&
          known.count(sides[0]) == 0)
        {
          name = dealii::Utilities::trim(text.substr(0, colon));
          sides[0] =
            dealii::Utilities::trim(sides[0].substr(sides[0].find(':') + 1));
        }
      if (sides.size() != 2 || name.empty())
        throw std::invalid_argument(
          text + " is not two sides, as plate | foot or NAME: plate | foot");
      for (const std::string &side : sides)
        if (known.count(side) == 0)
          throw std::invalid_argument(
            "the body has no boundary or region " + side +
            (known.empty() ?
               "" :
               ", but " + join({known.begin(), known.end()}, ", ")));
      Interface interface {
        name, sides[0], sides[1]
      };
      for (const char *ending : {"", "_high", "_low"})
        if (known.count(interface.name + ending) > 0)
          throw std::invalid_argument("the body has a piece " + interface.name +
                                      ending +
                                      ": give the interface another name, as "
                                      "in NAME: " +
                                      join(sides, " | "));
      return interface;
    }



    /// Throws std::invalid_argument if the text is no part of this body.
    template <int dim>
    Part<dim>
    make_part(const Body<dim>   &body,
              const std::string &name,
              const std::string &text,
              const Constants   &constants)
    {
      // Another piece of the same name would make the name ambiguous wherever
      // it stands.
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
              words("the body itself has no boundary ",
                    part.boundary,
                    ", but ",
                    join({boundaries.begin(), boundaries.end()}, ", "),
                    boundaries.empty() ? "" : " and ",
                    whole_boundary,
                    ", which is all of it"));
        }
      part.contains =
        make_condition<dim>("Parts/" + name,
                            is_of_boundary ? text.substr(colon + 1) : text,
                            constants);
      return part;
    }



    /// The body with its cuts, parts and interfaces; its own errors belong to
    /// the @p entry.
    template <int dim>
    std::shared_ptr<BodyDescription>
    make_body_with_pieces(const BodyParameters                     &parameters,
                          const std::map<std::string, std::string> &parts,
                          const Constants                          &constants,
                          const std::string                        &entry,
                          ParameterTable                           &table)
    {
      // Errors of body, cuts and parts are collected, each at its entry. A
      // mistake in one part does not hide those in others.
      const auto attempt = [&table](const std::string              &at,
                                    const std::vector<std::string> &others,
                                    const auto                     &action) {
        try
          {
            action();
          }
        catch (const std::invalid_argument &error)
          {
            table.reject(at, error.what(), others);
          }
      };
      std::shared_ptr<Body<dim>> body;
      attempt(entry, {"Mesh/Source"}, [&]() {
        body = make_body<dim>(parameters);
      });
      if (!body)
        return nullptr;
      attempt("Mesh/Cuts", {"Dimension"}, [&]() {
        // `body` is null as long as there are cuts to make, and remains so if
        // one of them is none.
        const auto cut = std::exchange(body, nullptr);
        for (const std::string &text :
             dealii::Utilities::split_string_list(parameters.cuts, ','))
          {
            cut->cuts.push_back(
              make_cut(*cut, text, parameters.box.rotation, constants));
            cut->cuts.back().name = "cut_" + std::to_string(cut->cuts.size());
          }
        body = cut;
      });
      // Names of boundaries would be wrong after a cut that is none.
      if (!body)
        return nullptr;
      std::vector<Part<dim>> made;
      for (const auto &part : parts)
        attempt("Parts/" + part.first, {"Dimension"}, [&]() {
          made.push_back(make_part(*body, part.first, part.second, constants));
        });
      body->parts = made;
      attempt("Mesh/Interfaces", {"Dimension"}, [&]() {
        for (const std::string &text :
             dealii::Utilities::split_string_list(parameters.interfaces, ','))
          body->interfaces.push_back(
            make_interface(*body, text, body->interfaces.size() + 1));
      });
      return body;
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



  std::shared_ptr<BodyDescription>
  make_body(const std::string                        &scene,
            const unsigned int                        dimension,
            BodyParameters                            parameters,
            const std::map<std::string, std::string> &parts,
            const Constants                          &constants,
            ParameterTable                           &table)
  {
    // Errors of the body belong to the entry that the source needs. A file or a
    // generator without a name is refused here, since there is no body to look
    // at then.
    using Source             = BodyParameters::Source;
    const Source      source = parameters.source;
    const std::string entry  = source == Source::file      ? "Mesh/File" :
                               source == Source::generator ? "Mesh/Generator" :
                                                             "Mesh/Source";
    if (source == Source::box)
      check_box(dimension, table);
    else if (table.get(entry).empty())
      {
        table.reject(entry,
                     "Source = " + table.get("Mesh/Source") + " needs one",
                     {"Mesh/Source"});
        return nullptr;
      }
    // The path of a file is relative to the folder of the scene, wherever the
    // program was started.
    if (source == Source::file)
      {
        namespace fs    = std::filesystem;
        parameters.file = (fs::path(scene).parent_path() / parameters.file)
                            .lexically_normal()
                            .string();
        // The effective scene lies in another folder.
        table.derive(entry, fs::absolute(parameters.file).string(), entry);
      }

    // Entries of another source are refused and not only noted: a scene with
    // the name of a file and without Source = file would be solved on a box.
    const auto idle = [&table](const std::string &entries,
                               const std::string &reason) {
      table.without_effect(entries, reason, "Mesh/Source");
    };
    if (source != Source::file)
      idle("Mesh/File, Mesh/Scale, Mesh/Size", "this belongs to Source = file");
    if (source != Source::generator)
      idle("Mesh/Generator, Mesh/Arguments",
           "this belongs to Source = generator");
    if (source == Source::box)
      idle("Mesh/Refinements, Mesh/Interfaces",
           "a box has its Cells, and is one body");
    return dimension == 2 ? make_body_with_pieces<2>(
                              parameters, parts, constants, entry, table) :
                            make_body_with_pieces<3>(
                              parameters, parts, constants, entry, table);
  }
} // namespace Debond
