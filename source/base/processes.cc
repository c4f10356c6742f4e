// SPDX-License-Identifier: LGPL-2.1-or-later

#include <debond/base/processes.h>
#include <debond/base/ranks.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>

namespace Debond
{
  unsigned int
  n_started_ranks()
  {
    // The number is needed before MPI has been started, to decide how to start
    // it. Open MPI has it in the first variable, MPICH and the implementations
    // derived from it in the second one.
    static const unsigned int n_ranks = []() {
      int n = 1;
      for (const char *const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
        if (const char *const text = std::getenv(name))
          n = std::max(n, std::atoi(text));
      return static_cast<unsigned int>(n);
    }();
    return n_ranks;
  }



  namespace
  {
    /// A communicator for what ranks say to each other when they end. Others
    /// may still be waiting in a collective operation on MPI_COMM_WORLD, with
    /// which a message there could be confused.
    MPI_Comm for_the_end = MPI_COMM_NULL;

    std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize> session;
  } // namespace



  void
  start_mpi()
  {
    // A program that uses this as a library may have started MPI, and ends it
    // then, too.
    if (dealii::Utilities::MPI::job_supports_mpi())
      return;
    // One process alone needs no daemon of Open MPI beside it and no network,
    // for which MPI_Init() would look for most of a second.
    if (n_started_ranks() == 1)
      for (const auto &[name, value] :
           {std::pair{"OMPI_MCA_ess_singleton_isolated", "1"},
            std::pair{"OMPI_MCA_pml", "ob1"},
            std::pair{"OMPI_MCA_btl", "self"},
            std::pair{"OMPI_MCA_osc", "^ucx"},
            std::pair{"OMPI_MCA_mtl", "^ofi"}})
        setenv(name, value, /*overwrite=*/0);
    // The arguments of the program are its own, so that MPI gets none. The last
    // argument limits deal.II's tasks to one thread on each rank.
    static int    argc = 0;
    static char **argv = nullptr;
    // A library that starts together with MPI installs a handler of SIGTERM. A
    // SignalWatch may have its own there already, which is restored afterwards.
    struct sigaction of_term;
    sigaction(SIGTERM, nullptr, &of_term);
    session =
      std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(argc, argv, 1);
    sigaction(SIGTERM, &of_term, nullptr);
    if (n_started_ranks() > 1)
      MPI_Comm_dup(MPI_COMM_WORLD, &for_the_end);
  }



  void
  end_mpi()
  {
    // deal.II's object calls MPI_Finalize(), after it has released what its
    // vectors and matrices hold of MPI.
    session.reset();
  }



  bool
  is_first_rank()
  {
    return rank_of_this(MPI_COMM_WORLD) == 0;
  }



  bool
  any_rank(const bool is_so_here)
  {
    return dealii::Utilities::MPI::max(is_so_here ? 1 : 0, MPI_COMM_WORLD) == 1;
  }



  double
  least_of_ranks(const double number_here)
  {
    return dealii::Utilities::MPI::min(number_here, MPI_COMM_WORLD);
  }



  std::optional<EndOfRanks>
  end_together(const bool is_own, const int exit_code)
  {
    if (for_the_end == MPI_COMM_NULL)
      return EndOfRanks{is_own, exit_code};
    // Each rank that has met an error comes here, and the least number of one
    // with an error of its own speaks for all. A rank that follows an error of
    // another one takes part with the number n, which is above all others.
    const int   n    = static_cast<int>(number_of_ranks(for_the_end));
    const int   rank = static_cast<int>(rank_of_this(for_the_end));
    const int   own  = is_own ? rank : n;
    int         first, is_agreed = 0;
    MPI_Request request;
    MPI_Iallreduce(&own, &first, 1, MPI_INT, MPI_MIN, for_the_end, &request);
    // A blocking reduction would deadlock if some rank never comes here because
    // it waits for this one elsewhere. Therefore the reduction is nonblocking
    // and is given up after three seconds, which an empty result tells the
    // caller.
    constexpr std::chrono::seconds patience(3);
    const auto                     begin = std::chrono::steady_clock::now();
    while (!is_agreed && std::chrono::steady_clock::now() - begin < patience)
      {
        MPI_Test(&request, &is_agreed, MPI_STATUS_IGNORE);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    if (!is_agreed)
      return {};
    // The reduction has ended on all ranks, so that they all come to this
    // broadcast and it cannot block. All ranks have the same exit code
    // afterwards.
    int code = exit_code;
    MPI_Bcast(&code, 1, MPI_INT, first < n ? first : 0, for_the_end);
    return EndOfRanks{first == rank, code};
  }



  void
  end_all_ranks(const int exit_code)
  {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
  }
} // namespace Debond
