// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/solve/scene_size.h>

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>

namespace Debond
{
  namespace
  {
    /// An executable that does nothing but load the libraries.
    constexpr double memory_of_program = 170e6;

    /// Of a factorisation on one core.
    constexpr double seconds_per_operation = 1e-10;

    /// The direction that a side of the box is normal to.
    unsigned int
    normal_direction(const std::string &side)
    {
      if (side == "left" || side == "right")
        return 0;
      return side == "bottom" || side == "top" ? 1 : 2;
    }



    /// The number that the first word after @p label in a file is, infinity
    /// if there is no such file or number.
    double
    read_limit(const std::string &file_name, const std::string &label)
    {
      std::ifstream file(file_name);
      std::string   word;
      double        value = 0.;
      while (!label.empty() && file >> word && word != label)
        ;
      return file >> value ? value : std::numeric_limits<double>::infinity();
    }
  } // namespace



  SceneSize
  scene_size(const Parameters &parameters)
  {
    const unsigned int          dim = parameters.dimension;
    const std::array<double, 3> n   = {
        {1. * parameters.box.cells[0],
         1. * parameters.box.cells[1],
       dim == 3 ? 1. * parameters.box.cells[2] : 0.}};

    SceneSize size;
    if (dim == 2)
      {
        size.cells    = 4. * n[0] * n[1];
        size.unknowns = 2. * ((n[0] + 1.) * (n[1] + 1.) + n[0] * n[1]);
      }
    else
      {
        size.cells         = 24. * n[0] * n[1] * n[2];
        const double faces = (n[0] + 1.) * n[1] * n[2] +
                             n[0] * (n[1] + 1.) * n[2] +
                             n[0] * n[1] * (n[2] + 1.);
        size.unknowns = 3. * ((n[0] + 1.) * (n[1] + 1.) * (n[2] + 1.) + faces +
                              n[0] * n[1] * n[2]);
      }

    size.contact_nodes = 0.;
    for (const std::string &side : parameters.contact_boundaries)
      {
        double corners = 1., faces = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != normal_direction(side))
            {
              corners *= n[d] + 1.;
              faces *= n[d];
            }
        size.contact_nodes += dim == 2 ? corners : corners + faces;
      }
    return size;
  }



  double
  memory_with_factorisation(const SceneSize &size, const unsigned int dimension)
  {
    // The fill of minimum degree orderings: about n log n in 2D, n^(4/3) in
    // 3D.
    const double n = size.unknowns;
    const double factor =
      dimension == 2 ? 29. * n * std::log2(n) : 100. * std::pow(n, 4. / 3.);
    const double dense = 4. * 8. * size.contact_nodes * size.contact_nodes;
    return memory_of_program + (dimension == 2 ? 900. : 600.) * n + factor +
           dense;
  }



  double
  memory_with_multigrid(const SceneSize &size, const unsigned int dimension)
  {
    return memory_of_program + (dimension == 2 ? 1700. : 4600.) * size.unknowns;
  }



  double
  memory_with_bundle(const SceneSize &size,
                     const unsigned int,
                     const unsigned int bundle_size)
  {
    return memory_of_program + (1000. + 8. * bundle_size) * size.unknowns;
  }



  double
  seconds_with_factorisation(const Parameters &parameters)
  {
    const SceneSize             size = scene_size(parameters);
    std::array<unsigned int, 3> n    = parameters.box.cells;
    const double                N    = size.unknowns;
    // In 2D what was measured on the benchmark, up to 2560x256.
    if (parameters.dimension == 2)
      return 3e-9 * std::pow(N, 1.5);

    // A front is a section of the body by its two smaller numbers of cells,
    // with three unknowns for each of two vertices a cell; in compact bodies
    // dissection beats such a band. S is dense, and factorised a few times.
    std::sort(n.begin(), n.end());
    const double front = 6. * n[0] * n[1] + 3. * (n[0] + n[1] + 1.);
    const double S     = std::pow(size.contact_nodes, 3);
    return seconds_per_operation *
           (std::min(N * front * front, 20. * N * N) + 3. * S);
  }



  double
  seconds_with_multigrid(const Parameters &parameters)
  {
    const double N = scene_size(parameters).unknowns;
    if (parameters.dimension == 2)
      return 5e-6 * N;

    // The cycle has no grip on the bending of thin bodies unless their contact
    // side is held.
    const auto  &lengths = parameters.box.lengths;
    const double slenderness =
      *std::max_element(lengths.begin(), lengths.end()) /
      *std::min_element(lengths.begin(), lengths.end());
    const double bending = parameters.tangential_displacement_fixed ?
                             1. :
                             std::max(1., slenderness / 1.5);
    return 1e-4 * N * bending;
  }



  double
  available_memory()
  {
    double available = 1024. * read_limit("/proc/meminfo", "MemAvailable:");
    // Containers, by the two versions of control groups.
    for (const char *limit : {"/sys/fs/cgroup/memory.max",
                              "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
      available = std::min(available, read_limit(limit, ""));
    rlimit address_space;
    if (getrlimit(RLIMIT_AS, &address_space) == 0 &&
        address_space.rlim_cur != RLIM_INFINITY)
      available =
        std::min(available, static_cast<double>(address_space.rlim_cur));
    return available;
  }
} // namespace Debond
