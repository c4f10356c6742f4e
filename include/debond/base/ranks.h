// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_ranks_h
#define debond_base_ranks_h

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <stdexcept>
#include <vector>

namespace Debond
{
  /// Marks exceptions of ranks that only follow another one, which has the
  /// error itself and says what is wrong.
  class ErrorElsewhere
  {
  public:
    virtual ~ErrorElsewhere() = default;
  };

  /// One of these.
  template <typename Exception>
  class Elsewhere : public Exception, public ErrorElsewhere
  {
  public:
    using Exception::Exception;
  };



  /// deal.II's functions for these need MPI to have been started.
  unsigned int
  number_of_ranks(const MPI_Comm ranks);

  unsigned int
  rank_of_this(const MPI_Comm ranks);

  /// Calls @p work on each rank, and returns if it did on all of them. Else the
  /// first one on which it threw throws its exception again, and all others
  /// std::invalid_argument, runtime_error or logic_error, as it is or is not,
  /// with its message, as an ErrorElsewhere: all ranks catch it or none. To be
  /// called by all ranks; where they wait for each other in @p work, nothing
  /// but this may throw on some of them only.
  void
  on_all_ranks(const MPI_Comm ranks, const std::function<void()> &work);



  /// Returns the result of @p work() on the first rank, which alone does it;
  /// MPI or Boost's serialisation has to know its type. Throws as
  /// on_all_ranks(). To be called by all ranks.
  template <typename Work>
  auto
  on_first_rank(const MPI_Comm ranks, const Work &work) -> decltype(work())
  {
    decltype(work()) result{};
    on_all_ranks(ranks, [&]() {
      if (rank_of_this(ranks) == 0)
        result = work();
    });
    if (number_of_ranks(ranks) > 1)
      result = dealii::Utilities::MPI::broadcast(ranks, result);
    return result;
  }



  /// The entries of all ranks in the order of the ranks, each once.
  template <typename Entry>
  std::vector<Entry>
  union_of_ranks(const std::vector<Entry> &entries, const MPI_Comm ranks)
  {
    std::vector<Entry> result;
    for (const std::vector<Entry> &of_rank :
         dealii::Utilities::MPI::all_gather(ranks, entries))
      for (const Entry &entry : of_rank)
        if (std::find(result.begin(), result.end(), entry) == result.end())
          result.push_back(entry);
    return result;
  }
} // namespace Debond

#endif
