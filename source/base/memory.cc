// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/infinity.h>
#include <debond/base/memory.h>
#include <debond/base/processes.h>
#include <debond/base/text.h>

#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace Debond
{
  namespace
  {
    dealii::Utilities::System::MemoryStats
    memory_of_process()
    {
      // deal.II reads /proc/self/status, whose numbers are in units of 1024
      // bytes. Without such a file they are zero.
      dealii::Utilities::System::MemoryStats memory; // in kB
      dealii::Utilities::System::get_memory_stats(memory);
      return memory;
    }



    /// The number that the first word after @p label in a file is, infinity
    /// if there is no such file or number.
    double
    read_limit(const std::string &file_name, const std::string &label)
    {
      // Without a label the number is the first word of the file, as in those
      // of control groups. A group without a limit has the word "max" there,
      // which is no number and therefore counts as infinity.
      std::ifstream file(file_name);
      std::string   word;
      double        value = 0.;
      while (!label.empty() && file >> word && word != label)
        ;
      return file >> value ? value : infinity;
    }
  } // namespace



  double
  used_memory()
  {
    // VmRSS is what is in the memory of the machine at this moment. Address
    // space that has been reserved but not touched is not counted.
    return 1024. * static_cast<double>(memory_of_process().VmRSS);
  }



  double
  peak_memory()
  {
    // VmHWM is the largest value that VmRSS has had.
    return 1024. * static_cast<double>(memory_of_process().VmHWM);
  }



  double
  memory_left(const double limit)
  {
    // All ranks take the least number, as decisions on methods and meshes
    // depend on it and have to be the same everywhere. A limit given by the
    // user is one for each process, from which its present memory is
    // subtracted.
    if (limit > 0.)
      return least_of_ranks(std::max(0., limit - used_memory()));
    double left = 1024. * read_limit("/proc/meminfo", "MemAvailable:");
    // MemAvailable is what the kernel would give without swapping. A container
    // sees that of the whole machine, and its own limit is in one of these
    // files, depending on the version of its control groups. Of limits what the
    // process has already counts.
    for (const char *file : {"/sys/fs/cgroup/memory.max",
                             "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
      left = std::min(left, read_limit(file, "") - used_memory());
    rlimit address_space;
    if (getrlimit(RLIMIT_AS, &address_space) == 0 &&
        address_space.rlim_cur != RLIM_INFINITY)
      left =
        std::min(left,
                 static_cast<double>(address_space.rlim_cur) -
                   1024. * static_cast<double>(memory_of_process().VmSize));
    return least_of_ranks(std::max(0., left));
  }



  void
  limit_memory(const double bytes)
  {
    // The limit is one of address space, so that what is mapped now, libraries
    // included, is added to it. The conversion of a number beyond the range of
    // rlim_t would be undefined, hence the bound of 1e18. An allocation beyond
    // the limit fails, which is an exception with a message and not a signal by
    // the kernel.
    const auto most = static_cast<rlim_t>(std::min(bytes, 1e18));
    rlimit     limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0)
      return;
    limit.rlim_cur =
      std::min(limit.rlim_max, 1024 * memory_of_process().VmSize + most);
    setrlimit(RLIMIT_AS, &limit);
  }



  std::string
  in_gib(const double bytes)
  {
    const double gib = bytes / (1 << 30);
    return fixed_point(gib, gib < 10. ? 1 : 0) + " GiB";
  }
} // namespace Debond
