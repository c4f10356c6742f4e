// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_run_h
#define debond_program_run_h

#include <debond/program/companion.h>
#include <debond/program/exit_code.h>

namespace Debond
{
  struct RunOptions
  {
    bool terminal = false; ///< whether the log is one
    bool restart  = false; ///< whether to go on where an earlier run ended
  };

  /**
   * Solves a scene: sets up the problem, minimises J from its start, verifies
   * the result, writes files and the log to @p out. On a terminal progress is
   * one line that changes. A restart goes on after the last load step or mesh
   * in restart.state, which a run leaves in its output directory, see RunState.
   *
   * The output directory is created, and the effective parameters are written
   * there, before the solve, so that a directory without access costs no time.
   * Errors of the scene are thrown as BadInput before anything is written; all
   * other outcomes are told by the exit code and by a line on std::cerr. To be
   * called by all ranks, which share the scene: the first one writes log,
   * messages and files.
   */
  template <int dim>
  ExitCode
  run(const Parameters &parameters,
      const Companion  &companion,
      std::ostream     &out,
      const RunOptions  options);

  /// Throws what run() throws before it writes anything.
  template <int dim>
  void
  validate(const Parameters &parameters, const Companion &companion);
} // namespace Debond

#endif
