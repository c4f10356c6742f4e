// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/input/parameters.h>
#include <debond/mesh/owned_cells.h>
#include <debond/program/run_state.h>

#include <boost/algorithm/string/erase.hpp>
#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/container_hash/hash.hpp>
#include <boost/crc.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <iterator>

namespace Debond
{
  namespace
  {
    std::uint32_t
    checksum_of(const void *const data, const std::size_t n_bytes)
    {
      boost::crc_32_type checksum;
      checksum.process_bytes(data, n_bytes);
      return checksum.checksum();
    }



    /// The line before @p content in the file. A change of what that is needs
    /// another number.
    std::string
    title_of(const std::string &content)
    {
      return "Debond run state 11, checksum " +
             std::to_string(checksum_of(content.data(), content.size()));
    }



    // Boost's serialization knows neither std::optional nor Eigen.
    template <class Archive, typename T>
    void
    exchange(Archive &archive, std::optional<T> &value)
    {
      // The pair of a flag and a number stands for the optional one. Reading
      // and writing are the same code, since the operator & of an archive does
      // what its type says; in writing the value is replaced by itself.
      bool             exists = value.has_value();
      T                number = value.value_or(T());
      archive &exists &number;
      value = exists ? std::make_optional(number) : std::nullopt;
    }



    template <class Archive>
    void
    exchange(Archive &archive, Eigen::VectorXd &vector)
    {
      std::vector<double> entries(vector.begin(), vector.end());
      archive            &entries;
      vector = Eigen::Map<const Eigen::VectorXd>(
        entries.data(), static_cast<Eigen::Index>(entries.size()));
    }



    /// Writes to the file or reads from it, by the type of the archive.
    template <class Archive>
    void
    exchange(Archive &archive, BondBreak &bond)
    {
      exchange(archive, bond.factor);
      exchange(archive, bond.mode);
    }



    template <class Archive, int dim>
    void
    exchange(Archive &archive, LoadPathState<dim> &state)
    {
      LoadPathState<dim>::for_each_number(
        state,
        [&archive](const std::string &, auto &number) { archive &number; });
    }



    /// A step goes without its global branch, which comes when the path is
    /// whole.
    template <class Archive, int dim>
    void
    exchange(Archive &archive, LoadPathStep<dim> &step)
    {
      archive &step.step &step.factor &step.displacement_factor &step
        .status &step.iterations &step.message;
      exchange(archive, step.state);
    }



    template <class Archive>
    void
    exchange(Archive &archive, AdaptiveLevel &level)
    {
      archive &level.cells &level.unknowns &level.contact_nodes &level
        .iterations &level.step &level.functional &level.residual_error &level
        .scale &level.search_gain &level.gap &level.seconds;
      exchange(archive, level.error_factor);
    }



    template <class Archive>
    void
    exchange(Archive &archive, BondMemory &memory)
    {
      archive &memory.slipped &memory.pressed &memory.rubbed &memory.loose;
      archive &memory.reached &memory.mode &memory.mixity &memory.taken &memory
        .lag;
    }



    template <class Archive, typename T>
    void
    exchange(Archive &archive, std::vector<T> &list)
    {
      // The size goes first, so that a list that is read has its entries before
      // they are filled.
      std::size_t size = list.size();
      archive    &size;
      list.resize(size);
      for (T &entry : list)
        exchange(archive, entry);
    }



    template <class Archive, int dim>
    void
    exchange(Archive &archive, RunState<dim> &state)
    {
      // Everything that the rest of the run depends on is here, in the order of
      // the file. Another order or another member needs another number in
      // title_of(), since the file does not name what it contains.
      PathProgress<dim> &path = state.path;
      archive &state.scene &state.mesh &state.meshes.divisions &state.meshes
        .is_last &state.meshes.shortfall &path.kinds &state.meshes.start &path
        .u;
      exchange(archive, state.meshes.levels);
      exchange(archive, path.steps);
      exchange(archive, path.points);
      exchange(archive, path.memory);
      exchange(archive, path.breaks);
      // A peak has a step that may be none of the path's.
      bool     has_peak = path.peak.has_value();
      archive &has_peak;
      if (!has_peak)
        return;
      if (!path.peak)
        path.peak.emplace();
      exchange(archive, path.peak->step);
      exchange(archive, path.peak->bound);
    }



    /// Returns the values of each entry in two scenes, without their spaces.
    std::map<std::string, std::array<std::string, 2>>
    values_of(const std::array<std::string, 2> &scenes)
    {
      const std::array<std::string, 2> nothing = {{"nothing", "nothing"}};
      std::map<std::string, std::array<std::string, 2>> values;
      // Both texts are effective scenes with all entries. The tables have no
      // companion, so that its entries are unknown to them and may differ. An
      // entry that only one of the scenes has, such as the traction on a
      // boundary, has `nothing` in the other one. A difference in spaces is
      // none.
      for (unsigned int k = 0; k < scenes.size(); ++k)
        {
          SceneTable         table;
          std::istringstream text(scenes[k]);
          table.read(text, "");
          for (const auto &[path, unused] : table.locations())
            {
              auto &both = values.try_emplace(path, nothing).first->second;
              both[k] = boost::algorithm::erase_all_copy(table.get(path), " ");
            }
        }
      return values;
    }



    /// Says whether a run may continue with another value.
    bool
    may_differ(const std::string &entry)
    {
      // These entries say how a state is found, how good it has to be and what
      // is written of it, but not which problem it belongs to. Factors of a
      // load path may differ because only later steps may, which
      // earlier_state() checks.
      for (const std::string beginning : {"Accuracy/",
                                          "Output/",
                                          "Solver/",
                                          "Verification/",
                                          "Load path/Arc",
                                          "Load path/Displacement factors",
                                          "Load path/Factors",
                                          "Load path/Global branch",
                                          "Load path/Resolve"})
        if (entry.rfind(beginning, 0) == 0)
          return true;
      return false;
    }
  } // namespace



  template <int dim>
  std::vector<DofVector *>
  displacements_of(RunState<dim> &state)
  {
    std::vector<DofVector *> all = {&state.meshes.start, &state.path.u};
    all.erase(std::remove_if(all.begin(),
                             all.end(),
                             [](const DofVector *const u) {
                               return u->size() == 0;
                             }),
              all.end());
    return all;
  }



  template <int dim>
  std::uint64_t
  mesh_checksum(const Scene<dim> &scene)
  {
    // Each cell has a number of its own and the whole mesh the sum, modulo
    // 2^64: the sum neither depends on the order of the cells nor on the rank
    // that owns them. The number of a cell includes its place in the mesh, so
    // that cells which change places change the sum.
    const auto   &dofs = scene.problem().unknowns().dof_handler();
    std::uint64_t sum  = 0; // on any number of ranks the same
    for (const auto &cell : owned_cells(dofs))
      {
        std::vector<double> numbers = {
          static_cast<double>(cell->id().get_coarse_cell_id()),
          static_cast<double>(cell->material_id())};
        for (const unsigned int v : cell->vertex_indices())
          for (unsigned int d = 0; d < dim; ++d)
            numbers.push_back(cell->vertex(v)[d]);
        for (const auto &face : cell->face_iterators())
          numbers.push_back(face->boundary_id());
        sum += boost::hash_range(numbers.begin(), numbers.end());
      }
    return dealii::Utilities::MPI::sum(sum, scene.ranks());
  }



  template <int dim>
  void
  write_state(const RunState<dim> &state, const std::string &file_name)
  {
    write_atomically(file_name, [&state](std::ostream &out) {
      // Boost would write past the stream, which would not know what fails.
      std::ostringstream content;
      {
        boost::archive::binary_oarchive archive(content);
        RunState<dim>                   copy = state;
        exchange(archive, copy);
      }
      out << title_of(content.str()) << '\n' << content.str();
    });
  }



  template <int dim>
  RunState<dim>
  read_state(const std::string &file_name, const std::string &scene)
  {
    // Every rank reads the file for itself and comes to the same result or the
    // same error. A file that cannot be opened gives an empty title, which is
    // not that of a state.
    std::ifstream file = open_plain_file(file_name);
    std::string   title;
    std::getline(file, title);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    // The checksum finds files that were cut off or are of another version
    // before Boost reads them, which would crash on some.
    if (title != title_of(bytes))
      throw BadInput({file_name + " is not the state of a run of this version "
                                  "of Debond, or it is damaged; run without "
                                  "--restart"});
    RunState<dim>                   state;
    std::istringstream              content(bytes);
    boost::archive::binary_iarchive archive(content);
    exchange(archive, state);

    // A state belongs to its scene, but for entries that may_differ() names.
    for (const auto &[name, values] : values_of({{state.scene, scene}}))
      if (!may_differ(name) && values[0] != values[1])
        throw BadInput({file_name + " is of another scene: " + name + " was " +
                        values[0] + " and is " + values[1] +
                        "; run without --restart"});
    return state;
  }



  DEBOND_INSTANTIATE(displacements_of);
  DEBOND_INSTANTIATE(mesh_checksum);
  DEBOND_INSTANTIATE(write_state);
  DEBOND_INSTANTIATE(read_state);
} // namespace Debond
