// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_run_on_ranks_h
#define debond_program_run_on_ranks_h

#include <deal.II/base/mpi.h>

#include <debond/input/parameters.h>
#include <debond/program/exit_code.h>

#include <ostream>

namespace Debond
{
  /// run() by all ranks, which share the scene (BodyPiece): the first one
  /// writes log, messages and files but body.pvtu, and all return its exit
  /// code. There are no probes. Throws BadInput on all of them if they cannot
  /// share the scene, before anything is written.
  template <int dim>
  ExitCode
  run_on_ranks(const Parameters &parameters,
               const MPI_Comm    ranks,
               std::ostream     &out,
               const bool        terminal);
} // namespace Debond

#endif
