// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/ranks.h>

#include <string>

namespace Debond
{
  unsigned int
  number_of_ranks(const MPI_Comm ranks)
  {
    // deal.II's functions call MPI directly and fail before MPI_Init(). Tests
    // and programs that use parts of the library may never start it, and are
    // one rank then.
    return dealii::Utilities::MPI::job_supports_mpi() ?
             dealii::Utilities::MPI::n_mpi_processes(ranks) :
             1;
  }



  unsigned int
  rank_of_this(const MPI_Comm ranks)
  {
    return dealii::Utilities::MPI::job_supports_mpi() ?
             dealii::Utilities::MPI::this_mpi_process(ranks) :
             0;
  }



  void
  on_all_ranks(const MPI_Comm ranks, const std::function<void()> &work)
  {
    const unsigned int n    = number_of_ranks(ranks);
    const unsigned int rank = rank_of_this(ranks);
    if (n == 1)
      {
        work();
        return;
      }
    // The work of a rank ends before anything is communicated, with or without
    // an exception. Then all ranks take the minimum of one number each, and if
    // that shows an error they receive its text. The same calls follow on all
    // ranks whatever has happened, so that none of them waits for a call that
    // another one never makes.
    std::exception_ptr error;
    std::string        message;
    bool               is_own = true;
    int                kind   = 0; // see below
    try
      {
        work();
      }
    catch (const std::exception &exception)
      {
        // The exception itself cannot be sent. What other ranks throw has its
        // message and the nearest of three standard classes, by which callers
        // decide what kind of error it is.
        error   = std::current_exception();
        message = exception.what();
        is_own  = dynamic_cast<const ErrorElsewhere *>(&exception) == nullptr;
        if (dynamic_cast<const std::invalid_argument *>(&exception) != nullptr)
          kind = 1;
        if (dynamic_cast<const std::runtime_error *>(&exception) != nullptr)
          kind = 2;
      }
    // A rank with an error of its own offers its number, one that only follows
    // another rank's error offers n, and one without an error n + 1. The
    // minimum is therefore the first rank that has an error itself, if there is
    // one.
    const unsigned int first = dealii::Utilities::MPI::min(!error ? n + 1 :
                                                           is_own ? rank :
                                                                    n,
                                                           ranks);
    if (first > n)
      return;
    // All errors follow that of a rank outside of this communicator. Each rank
    // has caught one then and throws it on.
    if (first == n)
      std::rethrow_exception(error);
    message = dealii::Utilities::MPI::broadcast(ranks, message, first);
    kind    = dealii::Utilities::MPI::broadcast(ranks, kind, first);
    if (first == rank)
      std::rethrow_exception(error);
    if (kind == 1)
      throw Elsewhere<std::invalid_argument>(message);
    if (kind == 2)
      throw Elsewhere<std::runtime_error>(message);
    throw Elsewhere<std::logic_error>(message);
  }
} // namespace Debond
