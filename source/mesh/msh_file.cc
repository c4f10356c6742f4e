// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/mesh/msh_file.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace Debond
{
  namespace
  {
    /// The lines of a file that are not blank, and the numbers on them.
    class MshLines
    {
    public:
      MshLines(std::istream &input, const std::string &name)
        : input(input)
        , name(name)
      {}

      /// Goes to the next line, false at the end of the file.
      bool
      next()
      {
        while (std::getline(input, text))
          {
            ++number;
            const std::size_t first = text.find_first_not_of(" \t\r");
            if (first == std::string::npos)
              continue;
            text =
              text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
            words.clear();
            words.str(text);
            return true;
          }
        return false;
      }

      /// Goes to the next line of @p section.
      void
      next_of(const std::string &section)
      {
        if (!next())
          fail("the file ends within " + section);
        if (text[0] == '$')
          fail(text + " stands before all of " + section + " was read");
      }

      /// The next number of the line.
      template <typename Number>
      Number
      read(const std::string &what)
      {
        Number value;
        if (!(words >> value))
          fail("expected " + what + " in \"" + text + "\"");
        return value;
      }

      /// Of a list whose end the file says.
      std::size_t
      read_count(const std::string &what)
      {
        const long long count = read<long long>("the number of " + what);
        if (count < 0)
          fail("the number of " + what + " is negative");
        return static_cast<std::size_t>(count);
      }

      [[noreturn]] void
      fail(const std::string &message) const
      {
        throw std::invalid_argument(name + ":" + std::to_string(number) + ": " +
                                    message);
      }

      std::string  text;
      unsigned int number = 0;

    private:
      std::istream      &input;
      const std::string &name;
      std::istringstream words;
    };



    struct ElementKind
    {
      int          dimension;
      unsigned int n_vertices;
    };



    class MshReader
    {
    public:
      MshReader(std::istream &input, const std::string &name)
        : lines(input, name)
      {}

      MshFile
      read()
      {
        read_format();
        bool has_nodes = false, has_elements = false;
        while (lines.next())
          {
            const std::string section = lines.text;
            if (section[0] != '$')
              lines.fail("expected a section, such as $Nodes");
            if (section == "$PartitionedEntities")
              lines.fail("partitioned meshes are not read");
            if (section == "$PhysicalNames")
              read_names();
            else if (section == "$Entities" && is_version_4)
              read_entities();
            else if (section == "$Nodes")
              {
                is_version_4 ? read_nodes_4() : read_nodes_2();
                has_nodes = true;
              }
            else if (section == "$Elements")
              {
                if (!has_nodes)
                  lines.fail("$Elements stands before $Nodes");
                is_version_4 ? read_elements_4() : read_elements_2();
                has_elements = true;
              }
            skip_to_end(section);
          }
        if (!has_elements)
          lines.fail("the file has no $Elements");
        return std::move(file);
      }

    private:
      void
      read_format()
      {
        if (!lines.next() || lines.text != "$MeshFormat")
          lines.fail("this is no Gmsh file, which begins with $MeshFormat");
        lines.next_of("$MeshFormat");
        const auto version = lines.read<std::string>("a version");
        const auto type    = lines.read<int>("a file type");
        if (type != 0)
          lines.fail("the file is binary; save it as ASCII, with "
                     "Mesh.Binary = 0");
        if (version != "2.2" && version != "4.1")
          lines.fail("the version " + version +
                     " of the format is not read, but 2.2 and 4.1; this makes "
                     "one: gmsh old.msh -0 -o new.msh -format msh41");
        is_version_4 = version == "4.1";
        skip_to_end("$MeshFormat");
      }

      void
      skip_to_end(const std::string &section)
      {
        const std::string end    = "$End" + section.substr(1);
        std::size_t       n_more = 0;
        for (; lines.text != end; ++n_more)
          if (!lines.next())
            lines.fail("the file ends within " + section);
        if (n_more > 1 && (section == "$Nodes" || section == "$Elements"))
          lines.fail(
            section + " says that it has " +
            std::to_string(section == "$Nodes" ? file.vertices.size() :
                                                 file.elements.size()) +
            ", but " + std::to_string(n_more - 1) + " more lines follow");
      }

      void
      read_names()
      {
        lines.next_of("$PhysicalNames");
        const std::size_t n = lines.read_count("names");
        for (std::size_t i = 0; i < n; ++i)
          {
            lines.next_of("$PhysicalNames");
            const auto        dimension = lines.read<int>("a dimension");
            const auto        group     = lines.read<int>("a physical group");
            const std::size_t first     = lines.text.find('"');
            const std::size_t last      = lines.text.rfind('"');
            if (first == last)
              lines.fail("expected a name in quotation marks");
            file.names[{dimension, group}] =
              lines.text.substr(first + 1, last - first - 1);
          }
      }

      void
      read_entities()
      {
        lines.next_of("$Entities");
        std::array<std::size_t, 4> n;
        for (std::size_t &count : n)
          count = lines.read_count("entities");
        for (int d = 0; d < 4; ++d)
          for (std::size_t i = 0; i < n[static_cast<std::size_t>(d)]; ++i)
            {
              lines.next_of("$Entities");
              const auto tag = lines.read<int>("the tag of an entity");
              for (unsigned int c = 0; c < (d == 0 ? 3 : 6); ++c)
                lines.read<std::string>("a coordinate");
              const std::size_t n_groups = lines.read_count("physical groups");
              for (std::size_t k = 0; k < n_groups; ++k)
                // The sign says how the entity is oriented.
                entity_groups[{d, tag}].insert(
                  std::abs(lines.read<int>("a physical group")));
            }
      }

      void
      add_vertex(const long tag)
      {
        std::array<double, 3> vertex;
        for (double &coordinate : vertex)
          {
            // Not as a number: streams do not know nan and inf.
            const auto word = lines.read<std::string>("a coordinate");
            char      *end  = nullptr;
            coordinate      = std::strtod(word.c_str(), &end);
            if (*end != '\0' || !std::isfinite(coordinate))
              lines.fail("the coordinate " + word + " is no finite number");
          }
        if (!index_of
               .emplace(tag, static_cast<unsigned int>(file.vertices.size()))
               .second)
          lines.fail("there are two nodes " + std::to_string(tag));
        file.vertices.push_back(vertex);
      }

      void
      read_nodes_2()
      {
        lines.next_of("$Nodes");
        const std::size_t n = lines.read_count("nodes");
        for (std::size_t i = 0; i < n; ++i)
          {
            lines.next_of("$Nodes");
            add_vertex(lines.read<long>("the tag of a node"));
          }
      }

      void
      read_nodes_4()
      {
        lines.next_of("$Nodes");
        const std::size_t n_blocks = lines.read_count("blocks of nodes");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            lines.next_of("$Nodes");
            lines.read<int>("the dimension of an entity");
            lines.read<int>("the tag of an entity");
            lines.read<int>("whether nodes have parameters");
            const std::size_t n = lines.read_count("nodes");
            std::vector<long> tags;
            for (std::size_t i = 0; i < n; ++i)
              {
                lines.next_of("$Nodes");
                tags.push_back(lines.read<long>("the tag of a node"));
              }
            for (const long tag : tags)
              {
                lines.next_of("$Nodes");
                add_vertex(tag);
              }
          }
      }

      ElementKind
      kind_of(const int type) const
      {
        switch (type)
          {
            case MshFile::point:
              return {0, 1};
            case MshFile::line:
              return {1, 2};
            case MshFile::triangle:
              return {2, 3};
            case MshFile::quadrilateral:
              return {2, 4};
            case MshFile::tetrahedron:
              return {3, 4};
            case MshFile::hexahedron:
              return {3, 8};
            case MshFile::prism:
              return {3, 6};
            case MshFile::pyramid:
              return {3, 5};
            default:
              lines.fail("elements of type " + std::to_string(type) +
                         " are not read; those of second order become those "
                         "of first with Mesh.ElementOrder = 1");
          }
      }

      void
      add_element(const int type, const std::set<int> &groups)
      {
        const ElementKind kind    = kind_of(type);
        MshFile::Element  element = {lines.number,
                                     static_cast<MshFile::ElementType>(type),
                                     {},
                                     groups};
        for (unsigned int v = 0; v < kind.n_vertices; ++v)
          {
            const auto tag    = lines.read<long>("the tag of a node");
            const auto vertex = index_of.find(tag);
            if (vertex == index_of.end())
              lines.fail("there is no node " + std::to_string(tag));
            element.vertices.push_back(vertex->second);
          }
        file.elements.push_back(std::move(element));
      }

      void
      read_elements_2()
      {
        lines.next_of("$Elements");
        const std::size_t n = lines.read_count("elements");
        for (std::size_t i = 0; i < n; ++i)
          {
            lines.next_of("$Elements");
            lines.read<long>("the tag of an element");
            const auto        type = lines.read<int>("the type of an element");
            const std::size_t n_tags = lines.read_count("tags of the element");
            std::set<int>     groups;
            for (std::size_t k = 0; k < n_tags; ++k)
              {
                const auto tag = lines.read<int>("a tag of the element");
                if (k == 0 && tag != 0)
                  groups.insert(std::abs(tag));
              }
            add_element(type, groups);
          }
      }

      void
      read_elements_4()
      {
        lines.next_of("$Elements");
        const std::size_t n_blocks = lines.read_count("blocks of elements");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            lines.next_of("$Elements");
            const auto dimension =
              lines.read<int>("the dimension of an entity");
            const auto tag  = lines.read<int>("the tag of an entity");
            const auto type = lines.read<int>("the type of the elements");
            if (kind_of(type).dimension != dimension)
              lines.fail("elements of type " + std::to_string(type) +
                         " do not have the dimension of their entity, " +
                         std::to_string(dimension));
            const std::size_t   n      = lines.read_count("elements");
            const auto          entity = entity_groups.find({dimension, tag});
            const std::set<int> groups =
              entity != entity_groups.end() ? entity->second : std::set<int>();
            for (std::size_t i = 0; i < n; ++i)
              {
                lines.next_of("$Elements");
                lines.read<long>("the tag of an element");
                add_element(type, groups);
              }
          }
      }

      MshLines lines;
      bool     is_version_4 = false;
      MshFile  file;

      /// By the tags of the file.
      std::unordered_map<long, unsigned int>       index_of;
      std::map<std::pair<int, int>, std::set<int>> entity_groups;
    };
  } // namespace



  MshFile
  read_msh(std::istream &input, const std::string &name)
  {
    return MshReader(input, name).read();
  }
} // namespace Debond
