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



    /// How many times as many cycles as at nu = 1/3 the largest Poisson ratio
    /// takes.
    double
    more_cycles(const ProblemParameters &problem)
    {
      const Material &everywhere = problem.materials.everywhere;
      if (problem.dimension == 2 &&
          everywhere.hypothesis == Material::Hypothesis::plane_stress)
        return 1.;
      double largest = everywhere.poisson_ratio;
      for (const auto &[region, material] : problem.materials.of_regions())
        largest = std::max(largest, material.poisson_ratio);
      return std::pow(std::min(1., 3. * (1. - 2. * largest)), -0.4);
    }
  } // namespace



  SceneSize
  scene_size(const BodyDescription       &body,
             const unsigned int           dimension,
             const std::set<std::string> &contact_boundaries,
             const unsigned int           degree)
  {
    SceneSize size;
    size.degree        = degree;
    size.cells         = body.n_cells();
    size.unknowns      = dimension * body.n_vertices();
    size.contact_nodes = 0.;
    for (const std::string &name : contact_boundaries)
      size.contact_nodes += body.n_vertices_on(name);
    if (degree == 2)
      {
        // Euler's formula.
        size.unknowns += dimension * (body.n_vertices() + size.cells - 1.);
        size.contact_nodes *= dimension == 2 ? 2. : 4.;
      }
    size.shape = body.shape();
    return size;
  }



  SceneSize
  scene_size(const ProblemParameters &problem)
  {
    return scene_size(*problem.body,
                      problem.dimension,
                      problem.contact_boundaries,
                      problem.degree);
  }



  double
  memory_with_factorisation(const SceneSize &size, const unsigned int dimension)
  {
    // The fill of minimum degree orderings: about n log n in 2D, n^(4/3) in
    // 3D.
    const double n = size.unknowns;
    const double factor =
      dimension == 2 ? 29. * n * std::log2(n) :
                       (size.degree == 2 ? 125. : 100.) * std::pow(n, 4. / 3.);
    const double dense = 4. * 8. * size.contact_nodes * size.contact_nodes;
    return memory_of_program + (dimension == 2 ? 900. : 600.) * n + factor +
           dense;
  }



  double
  memory_with_certificate(const SceneSize &size, const unsigned int dimension)
  {
    SceneSize stresses = size;
    stresses.degree    = 1;
    if (dimension == 2)
      {
        // Four unknowns on each of 3/2 sides a triangle, two kept on each side
        // in contact.
        stresses.unknowns = std::max(size.unknowns, 6. * size.cells);
        stresses.contact_nodes *= 2.;
        return memory_with_factorisation(stresses, dimension);
      }
    // Nine on each of two faces a tetrahedron; three kept on each face in
    // contact, of which there are two a vertex, or four times as many as edges
    // and vertices are eight. Tetrahedra that are not congruent have matrices
    // of their own; with congruent ones it is less.
    stresses.unknowns = 18. * size.cells;
    stresses.contact_nodes *= size.degree == 2 ? 1.5 : 6.;
    return memory_with_factorisation(stresses, dimension) + 40e3 * size.cells;
  }



  double
  memory_with_multigrid(const SceneSize   &size,
                        const unsigned int dimension,
                        const bool         has_levels)
  {
    const double bytes = has_levels ? (dimension == 2 ? 1000. : 2200.) :
                                      (dimension == 2 ? 1700. : 4600.);
    return memory_of_program + bytes * size.unknowns;
  }



  double
  memory_with_bundle(const SceneSize &size,
                     const unsigned int,
                     const unsigned int bundle_size)
  {
    return memory_of_program + (1000. + 8. * bundle_size) * size.unknowns;
  }



  double
  seconds_with_factorisation(const ProblemParameters &problem)
  {
    const SceneSize       size = scene_size(problem);
    std::array<double, 3> n    = size.shape.cells;
    const double          N    = size.unknowns;
    // In 2D what was measured of bars, strips and pads up to 650000 unknowns
    // and 4000 contact nodes: the factor, and what is done with S.
    if (problem.dimension == 2)
      return 3e-7 * std::pow(N, 1.25) +
             2.2e-7 * std::pow(size.contact_nodes, 2.2);

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
  seconds_with_multigrid(const ProblemParameters &problem)
  {
    const SceneSize size    = scene_size(problem);
    const double    N       = size.unknowns;
    const auto     &lengths = size.shape.lengths;
    const double    slenderness =
      *std::max_element(lengths.begin(), lengths.begin() + problem.dimension) /
      *std::min_element(lengths.begin(), lengths.begin() + problem.dimension);
    if (problem.body->has_coarse_levels())
      return (problem.dimension == 2 ? 0.3 + 4e-6 * N : 1.5 + 1.2e-5 * N) *
             more_cycles(problem) * std::max(1., slenderness / 50.);
    if (problem.dimension == 2)
      return 5e-6 * N;

    // The cycle has no grip on the bending of thin bodies unless their contact
    // side is held.
    const double bending = problem.tangential_displacement_fixed ?
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
