// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_run_h
#define debond_program_run_h

#include <debond/input/parameters.h>
#include <debond/program/exit_code.h>

#include <ostream>

namespace Debond
{
  /**
   * Solves a scene: sets up the problem, minimises J from its start, verifies
   * the result, writes files and the log. @p terminal says whether the log
   * @p out is a terminal, on which progress is one line that changes.
   *
   * The output directory is created, and the effective parameters are written
   * there, before the solve, so that a directory without access costs no
   * time. Errors of the scene are thrown as BadInput before anything is
   * written; all other outcomes are told by the exit code and by
   * a line on std::cerr. To be called by all ranks, which share the scene: the
   * first one writes log, messages and files.
   */
  template <int dim>
  ExitCode
  run(const Parameters &parameters, std::ostream &out, const bool terminal);
} // namespace Debond

#endif
