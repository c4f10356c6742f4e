// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/blas_threads.h>

#include <dlfcn.h>

#include <cstdlib>

namespace Debond
{
  void
  use_one_blas_thread_by_default()
  {
    if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr ||
        std::getenv("OMP_NUM_THREADS") != nullptr)
      return;
    // Which BLAS there is, is decided when the program is loaded.
    for (const char *name : {"openblas_set_num_threads", "omp_set_num_threads"})
      if (void *const function = dlsym(RTLD_DEFAULT, name); function != nullptr)
        reinterpret_cast<void (*)(int)>(function)(1);
  }
} // namespace Debond
