// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/version.h>
#include <debond/benchmark/machine.h>

#include <Trilinos_version.h>
#include <cholmod.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace Debond
{
  namespace
  {
    std::string
    processor()
    {
      std::ifstream cpuinfo("/proc/cpuinfo");
      for (std::string line; std::getline(cpuinfo, line);)
        if (line.compare(0, 10, "model name") == 0)
          return line.substr(line.find(':') + 2);
      return "unknown processor";
    }



    /// The file that holds the BLAS: libblas.so.3 is an alternative, behind
    /// which there may be any implementation.
    std::string
    blas()
    {
      std::ifstream maps("/proc/self/maps");
      std::string   blas = "unknown BLAS";
      for (std::string line; std::getline(maps, line);)
        {
          const std::size_t slash = line.find('/');
          if (slash == std::string::npos)
            continue;
          const std::string name =
            std::filesystem::path(line.substr(slash)).filename().string();
          if (name.compare(0, 11, "libopenblas") == 0)
            return name;
          if (name.compare(0, 7, "libblas") == 0)
            blas = name;
        }
      return blas;
    }
  } // namespace



  std::string
  describe_machine()
  {
    const char *threads = std::getenv("OPENBLAS_NUM_THREADS");
    return "Debond " + program_version() + ", revision " + git_revision() +
           ", " + build_type() + ", g++ " + __VERSION__ + "; " + processor() +
           "; deal.II " + deal_ii_version() + ", Trilinos " +
           TRILINOS_VERSION_STRING + ", CHOLMOD " +
           std::to_string(CHOLMOD_MAIN_VERSION) + "." +
           std::to_string(CHOLMOD_SUB_VERSION) + "." +
           std::to_string(CHOLMOD_SUBSUB_VERSION) + ", " + blas() +
           ", OPENBLAS_NUM_THREADS " +
           (threads == nullptr ? "not set" : threads);
  }
} // namespace Debond
