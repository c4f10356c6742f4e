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
#include <fstream>
#include <sstream>
#include <stdexcept>

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
    /// Whether this is a .msh file of a version before 4.
    bool
    is_old_msh(const std::string &file_name)
    {
      std::ifstream input = open_plain_file(file_name);
      if (!input)
        throw std::invalid_argument(file_name + " cannot be read");
      if (input.peek() != '$')
        return false;
      for (std::string line; std::getline(input, line);)
        if (line.rfind("$MeshFormat", 0) == 0)
          {
            double version = 0.;
            input >> version;
            return version < 4.;
          }
        else if (line.rfind("$NO", 0) == 0) // of version 1
          return true;
      return false;
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
    const bool is_old = is_old_msh(file_name);
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
        send_what_gmsh_reads(
          fdopen(ends[1], "wb"), file_name, is_old, dim, size);
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
    if (status != 0)
      throw std::invalid_argument(file_name + ": Gmsh crashes on this file");

    std::istringstream              received(bytes);
    boost::archive::binary_iarchive archive(received);
    std::string                     error;
    GmshFile                        file;
    archive >> error >> file;
    if (!error.empty())
      throw std::invalid_argument(file_name + ": " + error);
    return file;
  }
} // namespace Debond
