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
    // The BLAS is chosen when the program is loaded, by Debian's alternatives
    // for instance, so that neither function can be linked by name. dlsym()
    // finds those that the loaded library happens to have.
    for (const char *name : {"openblas_set_num_threads", "omp_set_num_threads"})
      if (void *const function = dlsym(RTLD_DEFAULT, name); function != nullptr)
        reinterpret_cast<void (*)(int)>(function)(1);
  }
} // namespace Debond
