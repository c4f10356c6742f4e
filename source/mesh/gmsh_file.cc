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
#include <set>
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
      // Only the beginning of the file is looked at, for what Gmsh takes
      // without a word of warning: a byte order mark, after which it does not
      // recognise the format, and groups of .unv files, which it drops.
      // Versions before 4 store the groups with each element, later ones with
      // entities.
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
      // An assignment in the file overrides a value that was given with
      // -setnumber, where DefineConstant would take it. The scene's constant
      // would then change nothing in the mesh.
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
      // Gmsh reports many errors in its log only and continues. Unknown options
      // and missing libraries for pictures do not change the geometry, so that
      // files made for a graphical Gmsh are read all the same.
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



    /// Makes physical groups of the names that the parts of a geometry have in
    /// their file, if it has no groups.
    void
    group_by_names(const int dimension, const int dim)
    {
      gmsh::vectorpair entities;
      gmsh::model::getPhysicalGroups(entities, dimension);
      if (!entities.empty())
        return;
      // The label of a solid in a STEP file is "Shapes/ASSEMBLY/PLACE/PART",
      // with more assemblies or none. Each of these names is a group, so that
      // copies of a part have its name in common, and one of each place.
      std::map<std::string, std::vector<int>> groups;
      std::vector<int>                        without;
      gmsh::model::getEntities(entities, dimension);
      for (const auto &[unused, entity] : entities)
        {
          std::string              label;
          std::vector<std::string> names;
          gmsh::model::getEntityName(dimension, entity, label);
          boost::split(names, label, boost::is_any_of("/"));
          for (const std::string &name :
               std::set<std::string>(names.begin(), names.end()))
            if (!name.empty() && name != "Shapes")
              groups[name].push_back(entity);
          if (label.empty())
            without.push_back(entity);
        }
      // Cells without a group would be left out.
      if (dimension == dim && !groups.empty())
        for (const int entity : without)
          groups[std::to_string(entity)].push_back(entity);
      for (const auto &[name, of_name] : groups)
        gmsh::model::setPhysicalName(
          dimension, gmsh::model::addPhysicalGroup(dimension, of_name), name);
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
      // A file of a partitioned mesh has an entity for each piece, and entities
      // for the faces between pieces. A piece has the groups of the entity that
      // it is a piece of, and faces between pieces are none of the file's.
      // Ghost cells are copies of cells of other pieces.
      int of_dimension, whole;
      gmsh::model::getParent(dimension, entity, of_dimension, whole);
      if (whole < 0)
        std::tie(of_dimension, whole) = std::tie(dimension, entity);
      if (!ghosts.empty() || of_dimension != dimension)
        return;
      // In old files the entities are the groups themselves (see
      // read_by_gmsh()). A number is negative if the orientation of the group
      // is reversed, which does not matter here, and 0 stands for no group.
      numbers = {entity};
      if (!is_old)
        gmsh::model::getPhysicalGroupsForEntity(dimension, whole, numbers);
      std::map<int, std::string> groups;
      for (const int number : numbers)
        if (const int group = std::abs(number); group != 0)
          gmsh::model::getPhysicalName(dimension, group, groups[group]);

      // Elements are listed by kind, with all nodes of each. Nodes beyond the
      // corners belong to elements of higher order and come after them, so that
      // the first n_corners are taken.
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
          // Corners that are fewer than those of a simplex of this dimension
          // span no cell.
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
      // Gmsh is a library with a state of its own, which is set up here in the
      // child process and never cleared: the process ends with the answer.
      // Numbers of the scene are given like those of its command line, before
      // the file is read.
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
      // An exception that Gmsh throws in one of its own threads would end the
      // process. Without the abort its error is in the log.
      gmsh::option::setNumber("General.AbortOnError", 0);
      gmsh::open(file_name);
      check_log();
      gmsh::vectorpair entities;
      gmsh::model::getEntities(entities);
      // If the entities are not one to a line, Gmsh continues with points of
      // the number 0 and without groups. The first entity is such a point then.
      if (!is_old && !entities.empty() && entities[0] == std::make_pair(0, 0))
        throw std::invalid_argument(
          "Gmsh does not understand the file's entities, each of which has to be a line");
      if (gmsh::model::getDimension() > dim)
        throw std::invalid_argument(
          "a body in 3D, but the scene has Dimension = 2");
      GmshFile            file;
      std::vector<double> unused;
      gmsh::model::mesh::getNodes(file.nodes, file.coordinates, unused);
      // A file has a mesh if there are nodes, or else a geometry that is meshed
      // here. A .geo file may merge an STL surface, which has nodes already,
      // and still have a volume without cells.
      std::vector<int> kinds;
      gmsh::model::mesh::getElementTypes(kinds, dim);
      file.is_geometry =
        file.nodes.empty() ||
        (kinds.empty() && boost::iends_with(file_name, ".geo") &&
         gmsh::model::getDimension() == dim);
      if (!file.is_geometry && options.size > 0.)
        throw std::invalid_argument(
          "the file has a mesh, where Size is for geometries");
      // The same number as the least and the largest size overrules the sizes
      // at points that a geometry may have.
      if (file.is_geometry && options.size > 0.)
        set_size(options.size);
      if (file.is_geometry)
        {
          for (const int dimension : {dim - 1, dim})
            group_by_names(dimension, dim);
          gmsh::model::mesh::generate(dim);
        }
      gmsh::model::mesh::getNodes(file.nodes, file.coordinates, unused);

      // Cells and their faces are read, from all entities of these two
      // dimensions. Lines and points of a body in 3D are of no use.
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
      // An error of Gmsh may be of any type, and the log has its words. If the
      // log is empty as well, an allocation has failed at the limit of memory,
      // or the format is none that Gmsh knows.
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
      // The answer is serialised as a whole and written in one go. The parent
      // reads until the end of the pipe, so that neither process waits for the
      // other one with a full buffer.
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
    // What needs no Gmsh is checked before there is a process for it.
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
        // The child inherits the parent's handlers of signals, which would
        // record an interruption for a run that this process does not make.
        // With the default actions it simply ends.
        for (const int number :
             {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGINT, SIGTERM})
          std::signal(number, SIG_DFL);
        // It must not go on alone, not even if the parent has ended before.
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent)
          _exit(1);
        // Gmsh takes any amount of memory. With a limit an allocation fails in
        // the child, and the parent survives with a message.
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
    // The parent closes its copy of the writing end. As long as any process has
    // it open, reading would not come to an end, not even after the child has
    // crashed.
    close(ends[1]);
    std::string       bytes;
    std::vector<char> buffer(1 << 16);
    std::FILE *const  input = fdopen(ends[0], "rb");
    while (const std::size_t n =
             std::fread(buffer.data(), 1, buffer.size(), input))
      bytes.append(buffer.data(), n);
    std::fclose(input);
    // A child that has crashed is distinguished from one that has ended by
    // itself. One that has sent nothing has met Exit in a .geo file. Only an
    // archive that is complete is read.
    int status = 1;
    waitpid(child, &status, 0);
    if (status != 0)
      throw std::invalid_argument(
        file_name + ": Gmsh crashes on this file, or a memory of " +
        in_gib(options.memory) +
        " is not enough for its mesh, which a larger "
        "Mesh/Size makes smaller");
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
