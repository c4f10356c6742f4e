// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <debond/program/ranks.h>

#include <algorithm>
#include <cstdlib>

namespace Debond
{
  unsigned int
  n_started_ranks()
  {
    // Of Open MPI; of MPICH and those that come from it.
    int n = 1;
    for (const char *const name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
      if (const char *const text = std::getenv(name))
        n = std::max(n, std::atoi(text));
    return static_cast<unsigned int>(n);
  }



  void
  start_mpi()
  {
    // Who uses this as a library may have started it.
    if (dealii::Utilities::MPI::job_supports_mpi())
      return;
    static int                                            argc = 0;
    static char                                         **argv = nullptr;
    static const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  }
} // namespace Debond
