// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_study_run_study_h
#define debond_study_run_study_h

#include <debond/program/exit_code.h>
#include <debond/study/study_parameters.h>

#include <ostream>

namespace Debond
{
  /**
   * Runs the cases of a study that are not finished, @p jobs at a time, and
   * writes tables, plots and index.md into its directory. @p terminal says
   * whether @p out is one.
   *
   * Throws BadInput, before anything is written, if a case or the reference
   * cannot be used. A case that fails has that in its row and makes the exit
   * code ExitCode::not_converged.
   */
  ExitCode
  run_study(const StudyParameters &study,
            const unsigned int     jobs,
            std::ostream          &out,
            const bool             terminal);
} // namespace Debond

#endif
