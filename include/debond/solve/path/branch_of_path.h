// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_branch_of_path_h
#define debond_solve_path_branch_of_path_h

#include <debond/solve/answer.h>
#include <debond/solve/minimum/condensed_scene.h>
#include <debond/solve/path/path_table.h>

namespace Debond
{
  /**
   * Finds the global branch at the factors of a path without failures, and
   * enters its states, which @p correction refines, at all steps of @p answer.
   * Steps that are as low get the word of the search or of the proof. A branch
   * that was not asked for takes as much work as the path took; if that is not
   * enough, the @p table says so. Of bonds that do not heal, with the memory of
   * @p condensed to begin with, it is the energetic_path(), whose words are its
   * own: the followed path has another memory.
   */
  template <int dim>
  void
  enter_global_branch(const CondensedScene<dim> &condensed,
                      const SolveSettings       &settings,
                      const PathTable           &table,
                      CorrectionSolver          &correction,
                      Answer<dim>               &answer);
} // namespace Debond

#endif
