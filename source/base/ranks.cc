// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/ranks.h>

#include <string>

namespace Debond
{
  unsigned int
  number_of_ranks(const MPI_Comm ranks)
  {
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
        error   = std::current_exception();
        message = exception.what();
        is_own  = dynamic_cast<const ErrorElsewhere *>(&exception) == nullptr;
        if (dynamic_cast<const std::invalid_argument *>(&exception) != nullptr)
          kind = 1;
        if (dynamic_cast<const std::runtime_error *>(&exception) != nullptr)
          kind = 2;
      }
    // Own errors first; n + 1 is none.
    const unsigned int first = dealii::Utilities::MPI::min(!error ? n + 1 :
                                                           is_own ? rank :
                                                                    n,
                                                           ranks);
    if (first > n)
      return;
    // All follow one of other ranks than these.
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
