// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_scene_size_h
#define debond_solve_scene_size_h

#include <debond/input/problem_parameters.h>

namespace Debond
{
  /// How large a scene is, without its mesh. Numbers may exceed what an integer
  /// holds.
  struct SceneSize
  {
    double    cells;         ///< triangles or tetrahedra
    double    unknowns;      ///< dim for each vertex (and edge)
    double    contact_nodes; ///< vertices (and edges) of the contact boundaries
    BodyShape shape;
    unsigned int degree; ///< of the displacement
  };

  /// Edges, of degree 2, are those of a body without holes, in 3D about as
  /// many.
  SceneSize
  scene_size(const BodyDescription       &body,
             const unsigned int           dimension,
             const std::set<std::string> &contact_boundaries,
             const unsigned int           degree = 1);

  SceneSize
  scene_size(const ProblemParameters &problem);

  /// Estimates of the program's peak memory, in bytes, from measured runs of
  /// the benchmark and of bars in 3D: mesh, A, solver and output.
  double
  memory_with_factorisation(const SceneSize   &size,
                            const unsigned int dimension);

  /// The same of the equilibrated stresses of a certificate.
  double
  memory_with_certificate(const SceneSize &size, const unsigned int dimension);

  double
  memory_with_multigrid(const SceneSize   &size,
                        const unsigned int dimension,
                        const bool         has_levels);

  /// Without any linear solver: mesh, A and a bundle of vectors.
  double
  memory_with_bundle(const SceneSize   &size,
                     const unsigned int dimension,
                     const unsigned int bundle_size);

  /// Estimates of the time that the solve of a scene takes with a factorisation
  /// and with multigrid, in seconds on one core as of 2024, from the box and
  /// the materials alone: within a factor of about 3 on the bodies measured.
  double
  seconds_with_factorisation(const ProblemParameters &problem);

  double
  seconds_with_multigrid(const ProblemParameters &problem);

  /// What the system can give to this process now, in bytes.
  double
  available_memory();
} // namespace Debond

#endif
