// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/text.h>
#include <debond/mesh/gmsh_file.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <fcntl.h>
#include <gmsh.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace boost::serialization
{
  template <typename Archive>
  void
  serialize(Archive                    &archive,
            Debond::GmshFile::Elements &elements,
            unsigned int /*version*/)
  {
    archive &elements.dimension &elements.order &elements.n_corners &elements
      .tags &elements.corners &elements.groups;
  }

  template <typename Archive>
  void
  serialize(Archive &archive, Debond::GmshFile &file, unsigned int /*version*/)
  {
    archive &file.is_geometry &file.nodes &file.coordinates &file.elements;
  }
} // namespace boost::serialization

namespace Debond
{
  namespace
  {
    /// What Gmsh does not tell of a file.
    struct FileText
    {
      double version  = 0.; ///< of .msh
      bool   has_mark = false;

      /// Of version 2.0, where some files have the groups' dimensions and some
      /// have not, by dimension (or -1) and group.
      std::map<std::pair<int, int>, std::string> names;
    };

    /// Throws if there are more elements in ASCII than the file says, which
    /// Gmsh would leave out.
    FileText
    look_into(const std::string &file_name)
    {
      std::ifstream input = open_plain_file(file_name);
      if (!input)
        throw std::invalid_argument(file_name + " cannot be read");
      FileText    text;
      std::string line, section;
      std::size_t n_lines = 0, n_blocks = 0, n_elements = 0;
      std::getline(input, line);
      text.has_mark = line.rfind("\xef\xbb\xbf", 0) == 0;
      if (text.has_mark)
        line.erase(0, 3);
      bool is_text = !line.empty() && line[0] == '$';
      for (; is_text; is_text = is_text && std::getline(input, line))
        {
          line.erase(line.find_last_not_of(" \t\r") + 1);
          if (line.empty())
            continue;
          const std::size_t  quote = line.find('"');
          std::istringstream numbers(line.substr(0, quote));
          if (line[0] == '$')
            {
              if ((section == "$Elements" || section == "$ELM") &&
                  n_lines > 1 + n_blocks + n_elements)
                throw std::invalid_argument(
                  words(file_name,
                        ": ",
                        section,
                        " says that it has ",
                        n_elements,
                        ", but ",
                        n_lines - 1 - n_blocks - n_elements,
                        " more lines follow"));
              section = line;
              n_lines = 0;
              if (section == "$NOD" || section == "$NO")
                text.version = 1.;
            }
          else if (n_lines++ == 0 && section == "$MeshFormat")
            {
              int is_binary = 0;
              numbers >> text.version >> is_binary;
              is_text = is_binary == 0;
            }
          else if (n_lines == 1 && text.version >= 4.)
            numbers >> n_blocks >> n_elements;
          else if (n_lines == 1)
            numbers >> n_elements;
          else if (section == "$PhysicalNames" && text.version == 2. &&
                   quote != std::string::npos)
            {
              int dimension = -1, group = 0, second = 0;
              numbers >> group;
              if (numbers >> second)
                dimension = std::exchange(group, second);
              text.names[{dimension, group}] =
                line.substr(quote + 1, line.rfind('"') - quote - 1);
            }
        }
      return text;
    }



    /// What Gmsh has had to say, as an "Error" or a "Warning".
    std::string
    messages_of_gmsh(const std::string &kind)
    {
      std::vector<std::string> log, found;
      gmsh::logger::get(log);
      for (const std::string &line : log)
        if (line.rfind(kind + ": ", 0) == 0)
          found.push_back(printable(line.substr(kind.size() + 2)));
      return join(found, "; ");
    }



    /// Has Gmsh read a file, or mesh its geometry. Throws
    /// std::invalid_argument, or what Gmsh throws.
    GmshFile
    read_by_gmsh(const std::string &file_name,
                 const bool         is_old,
                 const int          dim,
                 const double       size)
    {
      gmsh::initialize(0, nullptr, false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::logger::start();
      // Gmsh knows groups of entities. In old files elements of one entity may
      // be in several groups: Gmsh is to take the groups for entities.
      gmsh::option::setNumber("Mesh.SwitchElementTags", is_old ? 1 : 0);
      gmsh::open(file_name);
      // It loses groups then, and goes on.
      const std::string warnings = messages_of_gmsh("Warning");
      if (warnings.find("not found in the Brep") != std::string::npos)
        throw std::invalid_argument(
          "Gmsh does not understand the file's entities, each of which has to "
          "be a line: " +
          warnings);
      if (gmsh::model::getDimension() > dim)
        throw std::invalid_argument(
          "a body in 3D, but the scene has Dimension = 2");
      GmshFile            file;
      std::vector<double> unused;
      gmsh::model::mesh::getNodes(file.nodes, file.coordinates, unused);
      file.is_geometry = file.nodes.empty();
      if (!file.is_geometry && size > 0.)
        throw std::invalid_argument(
          "the file has a mesh, where Size is for geometries");
      if (file.is_geometry && size > 0.)
        for (const char *option : {"Mesh.MeshSizeMin", "Mesh.MeshSizeMax"})
          gmsh::option::setNumber(option, size);
      if (file.is_geometry)
        gmsh::model::mesh::generate(dim);
      else
        gmsh::model::mesh::unpartition();
      gmsh::model::mesh::getNodes(file.nodes, file.coordinates, unused);

      gmsh::vectorpair entities;
      gmsh::model::getEntities(entities);
      for (const auto &[dimension, entity] : entities)
        {
          if (dimension < dim - 1)
            continue;
          std::vector<int> numbers = {entity};
          if (!is_old)
            gmsh::model::getPhysicalGroupsForEntity(dimension, entity, numbers);
          std::map<int, std::string> groups;
          for (const int number : numbers)
            if (const int group = std::abs(number); group != 0)
              gmsh::model::getPhysicalName(dimension, group, groups[group]);

          std::vector<int>                      types;
          std::vector<std::vector<std::size_t>> tags, nodes;
          gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
          for (std::size_t k = 0; k < types.size(); ++k)
            {
              GmshFile::Elements elements = {
                dimension, 1, 0, tags[k], {}, groups};
              std::string name;
              int         same_dimension, n_nodes;
              gmsh::model::mesh::getElementProperties(types[k],
                                                      name,
                                                      same_dimension,
                                                      elements.order,
                                                      n_nodes,
                                                      unused,
                                                      elements.n_corners);
              for (std::size_t e = 0; e < tags[k].size(); ++e)
                elements.corners.insert(elements.corners.end(),
                                        nodes[k].begin() + e * n_nodes,
                                        nodes[k].begin() + e * n_nodes +
                                          elements.n_corners);
              file.elements.push_back(std::move(elements));
            }
        }
      return file;
    }



    /// Writes an error, or an empty one and what Gmsh has read, to a pipe.
    void
    send_what_gmsh_reads(std::FILE *const   pipe,
                         const std::string &file_name,
                         const bool         is_old,
                         const int          dim,
                         const double       size)
    {
      GmshFile    file;
      std::string error;
      try
        {
          file = read_by_gmsh(file_name, is_old, dim, size);
        }
      catch (const std::invalid_argument &exception)
        {
          error = exception.what();
        }
      catch (...)
        {
          const std::string said = messages_of_gmsh("Error");
          error = "Gmsh does not read this" + (said.empty() ? "" : ": " + said);
        }
      std::ostringstream              text;
      boost::archive::binary_oarchive archive(text);
      archive << error << file;
      const std::string bytes = text.str();
      std::fwrite(bytes.data(), 1, bytes.size(), pipe);
      std::fflush(pipe);
    }
  } // namespace



  GmshFile
  read_gmsh_file(const std::string &file_name, const int dim, const double size)
  {
    const FileText text   = look_into(file_name);
    const bool     is_old = text.version > 0. && text.version < 4.;
    // Gmsh does not know files that begin with a byte order mark.
    std::filesystem::path copy;
    if (text.has_mark)
      {
        copy = std::filesystem::temp_directory_path() /
               ("debond-" + std::to_string(getpid()) +
                std::filesystem::path(file_name).extension().string());
        std::ifstream input(file_name, std::ios::binary);
        input.seekg(3);
        std::ofstream(copy, std::ios::binary) << input.rdbuf();
      }

    // Gmsh crashes on some broken files, and it changes the locale, the
    // environment and the number of threads: it gets a process of its own.
    int         ends[2];
    const pid_t child = pipe(ends) == 0 ? fork() : -1;
    if (child < 0)
      throw std::runtime_error("there is no process for Gmsh");
    if (child == 0)
      {
        for (const int number :
             {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGINT, SIGTERM})
          std::signal(number, SIG_DFL);
        // It prints in spite of what it was told.
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        send_what_gmsh_reads(fdopen(ends[1], "wb"),
                             text.has_mark ? copy.string() : file_name,
                             is_old,
                             dim,
                             size);
        _exit(0);
      }
    close(ends[1]);
    std::string       bytes;
    std::vector<char> buffer(1 << 16);
    std::FILE *const  input = fdopen(ends[0], "rb");
    while (const std::size_t n =
             std::fread(buffer.data(), 1, buffer.size(), input))
      bytes.append(buffer.data(), n);
    std::fclose(input);
    int status = 1;
    waitpid(child, &status, 0);
    std::error_code ignored;
    std::filesystem::remove(copy, ignored);
    if (status != 0)
      throw std::invalid_argument(file_name + ": Gmsh crashes on this file");

    std::istringstream              received(bytes);
    boost::archive::binary_iarchive archive(received);
    std::string                     error;
    GmshFile                        file;
    archive >> error >> file;
    if (!error.empty())
      throw std::invalid_argument(file_name + ": " + error);
    for (GmshFile::Elements &elements : file.elements)
      for (auto &[group, name] : elements.groups)
        for (const int dimension : {-1, elements.dimension})
          if (const auto own = text.names.find({dimension, group});
              own != text.names.end())
            name = own->second;
    return file;
  }
} // namespace Debond
