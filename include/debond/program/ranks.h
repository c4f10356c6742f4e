// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_program_ranks_h
#define debond_program_ranks_h

namespace Debond
{
  /// The number of processes that a launcher such as mpirun has started, as it
  /// says in the environment; 1 if there is none. MPI need not be there yet.
  unsigned int
  n_started_ranks();

  /// Starts MPI with one thread, unless it has been started, until the program
  /// ends.
  void
  start_mpi();
} // namespace Debond

#endif
