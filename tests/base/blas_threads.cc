// SPDX-License-Identifier: LGPL-2.1-or-later
// The number of threads of OpenBLAS after use_one_blas_thread_by_default().
#include <debond/base/blas_threads.h>

#include <dlfcn.h>

#include <cstdlib>

#include "../check.h"

namespace
{
  template <typename Function>
  Function *
  find(const char *name)
  {
    return reinterpret_cast<Function *>(dlsym(RTLD_DEFAULT, name));
  }



  /// Of two before; what is expected if the BLAS does not tell.
  int
  threads_after(const int expected)
  {
    auto *const set = find<void(int)>("openblas_set_num_threads");
    auto *const get = find<int()>("openblas_get_num_threads");
    if (set == nullptr || get == nullptr)
      return expected;
    set(2);
    Debond::use_one_blas_thread_by_default();
    return get();
  }
} // namespace



int
main()
{
  unsetenv("OPENBLAS_NUM_THREADS");
  unsetenv("OMP_NUM_THREADS");
  check("one thread", threads_after(1) == 1);
  for (const char *variable : {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"})
    {
      setenv(variable, "2", 1);
      check(std::string("what the user sets in ") + variable + " stays",
            threads_after(2) == 2);
      unsetenv(variable);
    }
}
