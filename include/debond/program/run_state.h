// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_run_state_h
#define debond_program_run_state_h

#include <debond/solve/answer.h>

#include <cstdint>

namespace Debond
{
  /// How far a run has come, for one on any number of ranks that continues from
  /// there.
  template <int dim>
  struct RunState
  {
    /// Its scene with all entries, as Parameters::effective_scene.
    std::string scene;

    /// mesh_checksum() of the mesh that displacements are on.
    std::uint64_t mesh = 0;

    MeshProgress      meshes;
    PathProgress<dim> path; ///< on the last of them
  };

  /// The displacements in the state that are not empty.
  template <int dim>
  std::vector<DofVector *>
  displacements_of(RunState<dim> &state);

  /// Returns a fingerprint of vertices, cells, boundary and material ids, by
  /// which a mesh is known again on any number of ranks. To be called by all of
  /// them.
  template <int dim>
  std::uint64_t
  mesh_checksum(const Scene<dim> &scene);

  /// Displacements in the state, and in the file, are in_serial_order(). To be
  /// called by all ranks. Throws std::runtime_error if the file cannot be
  /// written.
  template <int dim>
  void
  write_state(const RunState<dim> &state, const std::string &file_name);

  /// Throws BadInput if the file is not from a run of a scene whose mesh,
  /// material, law and loads are those of @p scene, naming the first entry that
  /// differs. Solver, accuracy, what is checked and written, and more load
  /// factors may differ.
  template <int dim>
  RunState<dim>
  read_state(const std::string &file_name, const std::string &scene);
} // namespace Debond

#endif
