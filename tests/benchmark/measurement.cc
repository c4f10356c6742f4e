// SPDX-License-Identifier: LGPL-2.1-or-later
// The measurement of memory against blocks of known size, and what happens to
// jobs that fail.

#include <debond/benchmark/measurement.h>

#include <sys/mman.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "../check.h"

using namespace Debond;

namespace
{
  constexpr double mebibyte = 1024. * 1024.;



  bool
  has_peak(const std::function<void()> &run, const double mebibytes)
  {
    const double peak = measure({"job", run, {}}).peak_bytes / mebibyte;
    const bool   good = std::abs(peak - mebibytes) < 0.5;
    if (!good)
      std::cout << "  peak " << peak << " MiB in place of " << mebibytes
                << std::endl;
    return good;
  }



  /// Small blocks come from the heap, large ones directly from the system.
  void
  touch_small_blocks(const unsigned int mebibytes)
  {
    std::vector<std::unique_ptr<char[]>> blocks(1024 * mebibytes);
    for (auto &block : blocks)
      {
        // With malloc's own header, 1024 bytes.
        block = std::make_unique<char[]>(1024 - 2 * sizeof(std::size_t));
        std::memset(block.get(), 1, 1000);
      }
  }



  void
  touch(const unsigned int mebibytes)
  {
    std::vector<char> block(mebibytes << 20, 1);
    volatile char     last = block.back();
    (void)last;
  }



  void
  memory()
  {
    std::cout << "Memory" << std::endl;
    std::cout << "  nothing: " << verdict(has_peak([] {}, 0.)) << std::endl;
    std::cout << "  one block: " << verdict(has_peak([] { touch(64); }, 64.))
              << std::endl;
    std::cout << "  two after each other: "
              << verdict(has_peak(
                   [] {
                     touch(24);
                     touch(40);
                   },
                   40.))
              << std::endl;
    std::cout << "  a block that is not touched: "
              << verdict(has_peak(
                   [] {
                     void *block = std::malloc(256 << 20);
                     if (block == nullptr)
                       throw std::bad_alloc();
                     std::free(block);
                   },
                   0.))
              << std::endl;

    // A block at the end keeps what is freed below it from the system.
    {
      std::vector<std::unique_ptr<char[]>> blocks(32 * 1024);
      for (auto &block : blocks)
        {
          block = std::make_unique<char[]>(1000);
          std::memset(block.get(), 1, 1000);
        }
      auto end = std::make_unique<char[]>(1000);
      blocks.clear();
      std::cout << "  memory that the parent has freed: "
                << verdict(has_peak([] { touch_small_blocks(16); }, 16.))
                << std::endl;
    }

    std::vector<char> block(32 << 20, 1);
    std::cout << "  changing the parent's memory: "
              << verdict(
                   has_peak([&] { std::memset(block.data(), 2, block.size()); },
                            0.))
              << ", which stays as it was: " << verdict(block.back() == 1)
              << std::endl;
  }



  void
  failures()
  {
    std::cout << "Failures" << std::endl;
    for (const auto &run : std::vector<std::function<void()>>{
           [] { throw std::runtime_error("the reason"); },
           [] { std::raise(SIGKILL); },
           [] { std::_Exit(3); }})
      try
        {
          measure({"the job", run, {}});
          std::cout << "  NOTHING THROWN" << std::endl;
        }
      catch (const std::runtime_error &error)
        {
          std::cout << "  " << error.what() << std::endl;
        }

    // The other job is measured all the same, once where there is no time.
    const Job good = {"a good one", [] {}, {}};
    const Job bad  = {"a bad one",
                      [] { throw std::runtime_error("its reason"); },
                      {}};
    for (const Measurements &job : measure_alternating({bad, good}, 3, 1e4))
      std::cout << "  " << job.values.size() << " measurements, \"" << job.error
                << '"' << std::endl;
    std::cout << "  " << measure_alternating({good}, 3, 1e-9)[0].values.size()
              << " where there is no time" << std::endl;
  }



  void
  order()
  {
    // Shared with the children.
    struct Log
    {
      unsigned int size;
      char         names[100];
    };
    Log             *log = static_cast<Log *>(mmap(nullptr,
                                       sizeof(Log),
                                       PROT_READ | PROT_WRITE,
                                       MAP_SHARED | MAP_ANONYMOUS,
                                       -1,
                                       0));
    std::vector<Job> jobs;
    for (const char name : {'a', 'b', 'c'})
      jobs.push_back({std::string(1, name),
                      [log, name] {
                        if (log->size == 0 || log->names[log->size - 1] != name)
                          log->names[log->size++] = name;
                      },
                      [name]() -> nlohmann::json {
                        return {{"name", std::string(1, name)}};
                      }});
    const auto results = measure_alternating(jobs, 3);
    // The last of a row and the first of the next one are the same job.
    std::cout << "Order: " << std::string(log->names, log->size) << std::endl;
    for (const Measurements &job : results)
      for (const Measurement &measurement : job.values)
        std::cout << "  " << measurement.facts << std::endl;
  }



  void
  spreads()
  {
    std::cout << "Spreads" << std::endl;
    const auto print = [](const Spread &spread) {
      std::cout << "  " << spread.median << " (" << spread.min << " to "
                << spread.max << ")" << std::endl;
    };
    print(spread({3., 1., 2.}));
    print(spread({4., 1., 2., 8.}));
    // The median of the quotients is not the quotient of the medians.
    std::vector<Measurement> a(3), b(3);
    a[0].seconds = 10.;
    a[1].seconds = 20.;
    a[2].seconds = 30.;
    b[0].seconds = 20.;
    b[1].seconds = 4.;
    b[2].seconds = 10.;
    print(spread_of_ratios(a, b, &Measurement::seconds));
    print(spread(b, &Measurement::seconds));
  }
} // namespace



int
main()
{
  memory();
  failures();
  order();
  spreads();
}
