// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/append.h>
#include <debond/base/atomic_file.h>
#include <debond/base/memory.h>
#include <debond/base/text.h>
#include <debond/mesh/gmsh_file.h>

#include <boost/algorithm/string.hpp>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <fcntl.h>
#include <gmsh.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <stdexcept>

namespace boost::serialization
{
  template <typename Archive>
  void
  serialize(Archive                    &archive,
            Debond::GmshFile::Elements &elements,
            unsigned int /*version*/)
  {
    archive &elements.dimension &elements.entity &elements.order &elements
      .n_corners &elements.tags &elements.corners &elements.groups;
  }

  template <typename Archive>
  void
  serialize(Archive &archive, Debond::GmshFile &file, unsigned int /*version*/)
  {
    archive &file.is_geometry &file.n_ghosts &file.nodes &file.coordinates &file
      .elements;
  }
} // namespace boost::serialization

namespace Debond
{
  namespace
  {
    /// Returns whether this is a .msh file of a version before 4. Throws
    /// std::invalid_argument if it is a .unv file with groups that Gmsh drops.
    bool
    is_old_msh(const std::string &file_name)
    {
      std::ifstream input = open_plain_file(file_name);
      if (!input)
        throw std::invalid_argument(file_name + " cannot be read");
      if (input.peek() == 0xef)
        throw std::invalid_argument(
          file_name +
          " begins with a byte order mark, which Gmsh does not read; save it without");
      const bool is_unv = boost::iends_with(file_name, ".unv");
      if (input.peek() != '$' && !is_unv)
        return false;
      for (std::string line; std::getline(input, line);)
        if (is_unv && line.rfind("  2467", 0) == 0) // numbers have 10 columns
          throw std::invalid_argument(
            file_name +
            ": Gmsh does not read the groups of dataset 2467; remove them from the file, and name sides by Parts");
        else if (line.rfind("$MeshFormat", 0) == 0)
          {
            double version = 0.;
            input >> version;
            return version < 4.;
          }
        else if (line.rfind("$NO", 0) == 0) // of version 1
          return true;
      return false;
    }



    /// Throws std::invalid_argument if a .geo file sets one of the constants
    /// itself, which would silently count.
    void
    check_constants(const std::string                   &file_name,
                    const std::map<std::string, double> &constants)
    {
      if (!boost::iends_with(file_name, ".geo"))
        return;
      std::ifstream input = open_plain_file(file_name);
      for (std::string line; std::getline(input, line);)
        if (std::smatch match;
            std::regex_search(line, match, std::regex("^\\s*(\\w+)\\s*=[^=]")))
          if (constants.count(match[1]) > 0)
            throw std::invalid_argument(
              words(file_name,
                    ": it sets ",
                    match[1],
                    ", a constant of the scene, itself; write DefineConstant[ ",
                    boost::trim_copy(line.substr(0, line.find(';'))),
                    " ]; there, which takes the scene's value"));
    }



    /// The errors that Gmsh has logged, in one line, but for those of options
    /// and pictures, which leave the geometry as it is.
    std::string
    errors_of_gmsh()
    {
      std::vector<std::string> log, found;
      gmsh::logger::get(log);
      for (const std::string &line : log)
        if (std::regex_search(
              line, std::regex("^Error: (?!Unknown .* option|.* requires )")))
          found.push_back(printable(line.substr(7)));
      return join(found, "; ");
    }



    /// Throws if there are any.
    void
    check_log()
    {
      if (!errors_of_gmsh().empty())
        throw std::runtime_error("errors of Gmsh");
    }



    void
    set_size(const double size)
    {
      for (const char *option : {"Mesh.MeshSizeMin", "Mesh.MeshSizeMax"})
        gmsh::option::setNumber(option, size);
    }



    /// Throws std::invalid_argument if edges of this length make more cells
    /// than there is memory for. A coarse mesh says how large the geometry is.
    void
    check_size(const int dim, const MeshingOptions &options)
    {
      const double size = options.size;
      double       x, y, z, end_x, end_y, end_z;
      gmsh::model::getBoundingBox(-1, -1, x, y, z, end_x, end_y, end_z);
      const double length = end_x - x + end_y - y + end_z - z;
      if (size > length / 300.)
        return;
      set_size(length / 20.);
      gmsh::model::mesh::generate(dim);
      std::vector<double> matrices, determinants, points;
      gmsh::model::mesh::getJacobians(
        dim == 2 ? 2 : 4, {0., 0., 0.}, matrices, determinants, points);
      gmsh::model::mesh::clear();
      // Of equilateral triangles and regular tetrahedra, each of which takes
      // 1000 bytes and more with its part of the matrix.
      const double bytes =
        1000. / (dim == 2 ? 0.433 : 0.118) / std::pow(size, dim);
      double needed = 0.;
      for (const double determinant : determinants)
        needed += bytes * std::abs(determinant) / (dim == 2 ? 2. : 6.);
      if (needed > options.memory)
        throw std::invalid_argument(words("cells of Mesh/Size take about ",
                                          in_gib(needed),
                                          ", and there are ",
                                          in_gib(options.memory),
                                          ": make it larger"));
    }



    /// Adds the elements of an entity. Throws std::invalid_argument if they are
    /// of a kind that is not read.
    void
    add_elements(const int  dimension,
                 const int  entity,
                 const bool is_old,
                 GmshFile  &file)
    {
      std::vector<std::size_t> ghosts;
      std::vector<int>         numbers;
      gmsh::model::mesh::getGhostElements(dimension, entity, ghosts, numbers);
      file.n_ghosts += ghosts.size();
      // A piece of a partition has the groups of what it is a piece of,
      // and faces between pieces are none of the file's.
      int of_dimension, whole;
      gmsh::model::getParent(dimension, entity, of_dimension, whole);
      if (whole < 0)
        std::tie(of_dimension, whole) = std::tie(dimension, entity);
      if (!ghosts.empty() || of_dimension != dimension)
        return;
      numbers = {entity};
      if (!is_old)
        gmsh::model::getPhysicalGroupsForEntity(dimension, whole, numbers);
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
            dimension, entity, 1, 0, tags[k], {}, groups};
          std::string         name;
          int                 same_dimension, n_nodes;
          std::vector<double> unused;
          gmsh::model::mesh::getElementProperties(types[k],
                                                  name,
                                                  same_dimension,
                                                  elements.order,
                                                  n_nodes,
                                                  unused,
                                                  elements.n_corners);
          if (elements.n_corners <= dimension)
            throw std::invalid_argument(
              words("element ",
                    tags[k][0],
                    " is of a kind that is not read, ",
                    name));
          for (std::size_t e = 0; e < tags[k].size(); ++e)
            elements.corners.insert(elements.corners.end(),
                                    nodes[k].begin() + e * n_nodes,
                                    nodes[k].begin() + e * n_nodes +
                                      elements.n_corners);
          file.elements.push_back(std::move(elements));
        }
    }



    /// Has Gmsh read a file, or mesh its geometry. Throws
    /// std::invalid_argument, or what Gmsh throws.
    GmshFile
    read_by_gmsh(const std::string    &file_name,
                 const bool            is_old,
                 const int             dim,
                 const MeshingOptions &options)
    {
      std::vector<std::string> arguments = {"debond"};
      for (const auto &[name, value] : options.constants)
        append<std::string>({"-setnumber", name, shortest_text(value)},
                            arguments);
      std::vector<char *> words;
      for (std::string &argument : arguments)
        words.push_back(argument.data());
      gmsh::initialize(static_cast<int>(words.size()), words.data(), false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::logger::start();
      // Gmsh knows groups of entities. In old files elements of one entity may
      // be in several groups: Gmsh is to take the groups for entities.
      gmsh::option::setNumber("Mesh.SwitchElementTags", is_old ? 1 : 0);
      // Their partitions are numbers of elements, which it would sort by them.
      gmsh::option::setNumber("Mesh.PartitionConvertMsh2", 0);
      // What it throws in a thread of its own would end the process.
      gmsh::option::setNumber("General.AbortOnError", 0);
      gmsh::open(file_name);
      check_log();
      gmsh::vectorpair entities;
      gmsh::model::getEntities(entities);
      // It goes on, with points of no number and without groups.
      if (!is_old && !entities.empty() && entities[0] == std::make_pair(0, 0))
        throw std::invalid_argument(
          "Gmsh does not understand the file's entities, each of which has to be a line");
      if (gmsh::model::getDimension() > dim)
        throw std::invalid_argument(
          "a body in 3D, but the scene has Dimension = 2");
      GmshFile            file;
      std::vector<double> unused;
      gmsh::model::mesh::getNodes(file.nodes, file.coordinates, unused);
      // The surface of a geometry may be a mesh, from an STL file.
      std::vector<int> kinds;
      gmsh::model::mesh::getElementTypes(kinds, dim);
      file.is_geometry =
        file.nodes.empty() ||
        (kinds.empty() && boost::iends_with(file_name, ".geo") &&
         gmsh::model::getDimension() == dim);
      if (!file.is_geometry && options.size > 0.)
        throw std::invalid_argument(
          "the file has a mesh, where Size is for geometries");
      if (file.is_geometry && options.size > 0.)
        {
          if (file.nodes.empty())
            check_size(dim, options);
          set_size(options.size);
        }
      if (file.is_geometry)
        gmsh::model::mesh::generate(dim);
      gmsh::model::mesh::getNodes(file.nodes, file.coordinates, unused);

      gmsh::model::getEntities(entities);
      for (const auto &[dimension, entity] : entities)
        if (dimension >= dim - 1)
          add_elements(dimension, entity, is_old, file);
      check_log();
      return file;
    }



    /// Writes an error, or an empty one and what Gmsh has read, to a pipe.
    void
    send_what_gmsh_reads(std::FILE *const      pipe,
                         const std::string    &file_name,
                         const bool            is_old,
                         const int             dim,
                         const MeshingOptions &options)
    {
      GmshFile    file;
      std::string error;
      try
        {
          file = read_by_gmsh(file_name, is_old, dim, options);
        }
      catch (const std::invalid_argument &exception)
        {
          error = exception.what();
        }
      catch (...)
        {
          const std::string said = errors_of_gmsh();
          error                  = "Gmsh does not read this" +
                  (said.empty() ? ", or a memory of " + in_gib(options.memory) +
                                    " is not enough" :
                                  ": " + said);
          if (!boost::iends_with(file_name, ".geo") &&
              !boost::iends_with(file_name, ".msh"))
            error +=
              "; it knows .msh, .unv, .bdf, .nas, .mesh, .vtk, .step, .stp, .brep, .iges, .igs and .stl, and takes files of other endings for .geo";
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
  read_gmsh_file(const std::string    &file_name,
                 const int             dim,
                 const MeshingOptions &options)
  {
    const bool is_old = is_old_msh(file_name);
    check_constants(file_name, options.constants);
    // Gmsh crashes on some broken files, and it changes the locale, the
    // environment and the number of threads: it gets a process of its own.
    int         ends[2];
    const pid_t parent = getpid();
    const pid_t child  = pipe(ends) == 0 ? fork() : -1;
    if (child < 0)
      throw std::runtime_error("there is no process for Gmsh");
    if (child == 0)
      {
        for (const int number :
             {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGINT, SIGTERM})
          std::signal(number, SIG_DFL);
        // It must not go on alone, not even if the parent has ended before.
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent)
          _exit(1);
        limit_memory(options.memory);
        // Exit in a .geo file calls exit(), where handlers of the parent would
        // wait for its threads for ever.
        std::atexit([]() { _exit(0); });
        // It prints in spite of what it was told.
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        send_what_gmsh_reads(
          fdopen(ends[1], "wb"), file_name, is_old, dim, options);
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
      throw std::invalid_argument(
        file_name + ": Gmsh crashes on this file, or a memory of " +
        in_gib(options.memory) + " is not enough for its mesh");
    if (bytes.empty())
      throw std::invalid_argument(
        file_name + ": it ends Gmsh before there is a mesh; leave out Exit");

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
