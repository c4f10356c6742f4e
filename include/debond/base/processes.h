// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_processes_h
#define debond_base_processes_h

#include <optional>

namespace Debond
{
  /// The number of processes that a launcher such as mpirun has started, as it
  /// says in the environment; 1 if there is none. MPI need not be there yet.
  unsigned int
  n_started_ranks();

  /// Starts MPI, which is called from the first thread only, unless it has been
  /// started.
  void
  start_mpi();

  /// Ends what start_mpi() has started; to be called before objects with static
  /// lifetime end, such as deal.II's stores of vectors.
  void
  end_mpi();

  /// The first of the started ranks writes log and files for all.
  bool
  is_first_rank();

  /// Says whether it is so on any of the started ranks. All of them have to
  /// ask, each from its first thread: what depends on clocks, signals or the
  /// memory of a process has to be the same for all.
  bool
  any_rank(const bool is_so_here);

  /// The least number that any of them has.
  double
  least_of_ranks(const double number_here);

  /// Ends ranks that have all met an error.
  struct EndOfRanks
  {
    bool is_speaker; ///< the first one that has an error of its own
    int  exit_code;  ///< of that one
  };

  /// To be called where an error ends this rank, one of its own or one of
  /// another. None if others do not come to their end within some seconds: they
  /// wait for this one.
  std::optional<EndOfRanks>
  end_together(const bool is_own, const int exit_code);

  /// Ends all ranks, whatever they do.
  void
  end_all_ranks(const int exit_code);
} // namespace Debond

#endif
