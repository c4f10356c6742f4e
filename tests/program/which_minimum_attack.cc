// SPDX-License-Identifier: LGPL-2.1-or-later
// What the default search misses on random scenes: small ones against the
// enumeration of all bond states, by a solver of its own in long double, and
// scenes with many patches against branch and bound. Takes the numbers of small
// scenes and of scenes with many patches, and prints each miss with its gap; a
// third argument is the seed of other scenes, a fourth one the nodes of branch
// and bound, 3000 if there is none, but for large scenes fewer.

#include <debond/elasticity/contact_condensation.h>
#include <debond/input/parameters.h>
#include <debond/optimization/global/branch_search.h>
#include <debond/optimization/majorise/condensed_problem.h>
#include <debond/solve/scene.h>
#include <debond/solve/solve.h>

#include <Eigen/Dense>

#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <random>
#include <sstream>

#include "../check.h"
#include "../optimization/enumeration.h"
#include "solved.h"

using namespace Debond;

namespace
{
  // Nodes of a small scene: 2^n bond states take their time.
  unsigned int most_nodes = 9;

  // A miss is a result above the minimum by more than this part of J without
  // the energy of the body with its contact nodes held.
  constexpr double allowed = 1e-9;

  unsigned int proof_nodes = 3000;

  /// A node takes about n^3 operations, of which this is some seconds' worth.
  constexpr double proof_operations = 1e9;



  class Random
  {
  public:
    explicit Random(const unsigned int seed)
      : engine(seed)
    {}

    double
    operator()(const double lower, const double upper)
    {
      return std::uniform_real_distribution<double>(lower, upper)(engine);
    }

    double
    log10(const double lower, const double upper)
    {
      return std::pow(10., (*this)(lower, upper));
    }

    unsigned int
    integer(const unsigned int lower, const unsigned int upper)
    {
      return std::uniform_int_distribution<unsigned int>(lower, upper)(engine);
    }

  private:
    std::mt19937_64 engine;
  };



  template <typename... Values>
  std::string
  text(const Values &...values)
  {
    std::ostringstream out;
    out << std::setprecision(6);
    (out << ... << values);
    return out.str();
  }



  struct Case
  {
    std::string              kind;
    std::vector<std::string> entries;
  };



  /// A load along x that changes its sign.
  std::string
  waves(Random &random, const double length, const unsigned int most)
  {
    const double n = random(0.6, most), phase = random(0., 6.28);
    if (random.integer(0, 1) == 0)
      return text(random(0.5, 1.5),
                  "*sin(6.283*",
                  n,
                  "*x/",
                  length,
                  "+",
                  phase,
                  ")+",
                  random(-0.5, 0.8));
    std::string load = text(random(-1., 1.5));
    for (unsigned int k = 1; k <= n + 1; ++k)
      load = text("if(x<",
                  length * random(0., 1.),
                  ",",
                  (k % 2 == 0 ? 1. : -1.) * random(0.2, 1.5),
                  ",",
                  load,
                  ")");
    return load;
  }



  /// Without the law, which depends on the displacements.
  Case
  random_case(Random &random, const bool many_patches)
  {
    const unsigned int type   = random.integer(0, many_patches ? 3 : 4);
    const bool         is_3d  = type >= 3;
    const double       length = random(1., 3.);
    Case               c;
    const auto         set = [&](const auto &...values) {
      c.entries.push_back(text(values...));
    };
    set("Dimension=", is_3d ? 3 : 2);
    set("Material/Poisson ratio=", random(0., 0.45));
    set("Material/Young modulus=1");
    set("Boundary conditions/Contact boundary=bottom");
    set("Contact law/Tangential displacement=",
        random.integer(0, 1) == 0 ? "fixed" : "free");
    std::string clamped = "left, right", loaded = "top";
    if (type == 0 || type == 4)
      c.kind = is_3d ? "bar in 3D" : "bar";
    else if (type == 1)
      {
        c.kind  = "strip clamped at one end";
        clamped = "left";
      }
    else
      {
        c.kind  = type == 2 ? "pad clamped on the far side" : "plate in 3D";
        clamped = type == 2 ? "top" : "left, right";
        if (type == 2)
          loaded = "bottom";
      }
    set("Boundary conditions/Clamped boundaries=", clamped);
    const unsigned int most   = many_patches ? 8 : 3;
    const std::string  normal = waves(random, length, most);
    const double       height = length * random.log10(-1.6, -0.6);
    if (is_3d)
      {
        const unsigned int nx =
          many_patches ? random.integer(8, 14) : random.integer(3, 4);
        const unsigned int nz = many_patches ? random.integer(3, 6) : 1;
        set("Mesh/Lengths=",
            length,
            ", ",
            height,
            ", ",
            length * random(0.2, 0.6));
        set("Mesh/Cells=", nx, ", 1, ", nz);
        set("Loads/Traction ",
            loaded,
            "=0; (",
            normal,
            ")*(1+",
            random(-0.8, 0.8),
            "*z); 0");
      }
    else
      {
        const unsigned int nx =
          many_patches ? random.integer(40, 140) : random.integer(4, 14);
        set("Mesh/Lengths=", length, ", ", height);
        set("Mesh/Cells=", nx, ", ", random.integer(1, many_patches ? 4 : 2));
        set("Loads/Traction ", loaded, "=0; ", normal);
      }
    return c;
  }



  /// The least value over all bond states: for each the minimum for s <= 0 of
  /// a convex quadratic, by principal pivoting.
  long double
  minimum_over_bonds(const LongMatrix &S,
                     const LongVector &g,
                     const LongVector &k,
                     const long double M)
  {
    const unsigned int n = g.size();
    std::vector<char>  active(n, 0);
    long double        least = 0.;
    for (unsigned int count = 0; count < (1u << n); ++count)
      {
        const unsigned int state    = count ^ (count >> 1);
        LongMatrix         A        = S;
        long double        constant = 0.;
        for (unsigned int i = 0; i < n; ++i)
          if ((state >> i) % 2 == 0)
            A(i, i) += k(i);
          else
            constant += 0.5L * k(i) * M * M;
        const LongVector s = pivoted_minimiser(A, g, active);
        least = std::min(least, s.dot(0.5L * (A * s) - g) + constant);
      }
    return least;
  }



  struct Counts
  {
    unsigned int scenes = 0, missed = 0, failed = 0, unknown = 0;
    std::map<std::string, unsigned int> words;
  };



  template <int dim>
  void
  attack(Random &random, Case c, const bool many_patches, Counts &counts)
  {
    // A law of which some bonds break.
    c.entries.push_back("Solver/Method=automatic");
    double largest, stiffness;
    {
      const Parameters   parameters = parameters_of(c.entries);
      const Scene<dim>   scene(parameters);
      const Condensation condensed =
        condense_to_contact(scene.problem(), scene.adhesion());
      const unsigned int n = condensed.load().size();
      if (n == 0 || (!many_patches && n > most_nodes))
        return;
      const MatrixView S = condensed.schur_complement();
      const VectorView g = condensed.load();
      largest            = -S.llt().solve(g).minCoeff();
      stiffness =
        S.diagonal().mean() /
        scene.adhesion().curvature(Eigen::VectorXd::Zero(n)).diagonal().mean() *
        scene.law().curvature(0.);
    }
    if (!(largest > 0.))
      return;
    c.entries.push_back(
      text("Contact law/Bond threshold=", largest * random.log10(-2., -0.1)));
    c.entries.push_back(
      text("Contact law/Bond stiffness=", stiffness * random.log10(-2.5, 1.)));

    const Parameters  parameters = parameters_of(c.entries);
    const Scene<dim>  scene(parameters);
    const SolveResult result = solved(parameters, scene);
    ++counts.scenes;
    if (result.status != SolverStatus::success)
      {
        ++counts.failed;
        std::cout << "  " << c.kind << ": " << result.message << '\n';
        return;
      }
    ++counts.words[to_string(result.minimum.kind)];

    const Condensation condensed =
      condense_to_contact(scene.problem(), scene.adhesion());
    const Eigen::VectorXd s =
      scene.problem().unknowns().contact().trace(result.u);
    const unsigned int      n = static_cast<unsigned int>(s.size());
    const SeparableBranches bonds =
      lumped_branches(scene.adhesion(), n, scene.law().branches());
    const double found =
      s.dot(0.5 * condensed.schur_complement() * s - condensed.load()) +
      bonds.value(s);
    double minimum;
    if (many_patches)
      {
        BranchAndBoundParameters proof_parameters;
        proof_parameters.tolerance     = 1e-10 * std::abs(found);
        proof_parameters.maximum_nodes = static_cast<unsigned int>(
          std::min<double>(proof_nodes, proof_operations / std::pow(n, 3)));
        const BranchAndBoundResult proof =
          branch_and_bound(proof_parameters,
                           condensed.schur_complement(),
                           condensed.load(),
                           bonds,
                           s);
        minimum = proof.upper;
        counts.unknown += proof.upper - proof.lower > allowed * std::abs(found);
      }
    else
      {
        LongMatrix S(n, n);
        LongVector g(n);
        for (unsigned int i = 0; i < n; ++i)
          {
            g(i) = condensed.load()(i);
            for (unsigned int j = 0; j < n; ++j)
              S(i, j) = condensed.schur_complement()(i, j);
          }
        LongVector k(n);
        for (unsigned int i = 0; i < n; ++i)
          k(i) = bonds.f[i][0].curvature;
        minimum = minimum_over_bonds(S, g, k, scene.law().bond_threshold());
      }
    // The minimum is 0 where all is pressed.
    const double gap =
      found > minimum ? (found - minimum) / std::abs(minimum) : 0.;
    const bool miss = !(gap <= allowed);
    counts.missed += miss;
    const bool wrong_word = result.minimum.kind == MinimumKind::global && miss;
    if (miss)
      {
        std::cout << "  " << (wrong_word ? "FALSE GLOBAL, " : "") << c.kind
                  << ", " << n << " nodes, above the minimum by " << gap
                  << " of it, " << to_string(result.minimum.kind) << ":\n   ";
        for (const std::string &entry : c.entries)
          std::cout << " --set \"" << entry << '"';
        std::cout << '\n';
      }
  }



  Counts
  attack(const unsigned int n_scenes,
         const bool         many_patches,
         const unsigned int seed)
  {
    Random random(seed);
    Counts counts;
    while (counts.scenes < n_scenes)
      {
        const Case c = random_case(random, many_patches);
        if (c.entries[0] == "Dimension=3")
          attack<3>(random, c, many_patches, counts);
        else
          attack<2>(random, c, many_patches, counts);
      }
    return counts;
  }



  void
  report(const std::string &name, const Counts &counts, const bool figures)
  {
    std::cout << name << ": all solved: " << (counts.failed == 0 ? "yes" : "NO")
              << ", the minimum in 99 of 100: "
              << (100 * counts.missed <= counts.scenes ? "yes" : "NO") << '\n';
    if (!figures)
      return;
    std::cout << "  " << counts.scenes << " scenes, " << counts.missed
              << " misses, " << counts.unknown
              << " with a minimum that is not proved;";
    for (const auto &[word, number] : counts.words)
      std::cout << ' ' << number << ' ' << word << ',';
    std::cout << " " << counts.failed << " not solved\n";
  }



  /// Search and proof refuse a law without a curvature at 0; by default there
  /// is a note and no word.
  void
  test_other_law()
  {
    const std::vector<std::string> entries = {
      "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)"};
    const AdhesiveLaw law({{0., -0.1, 0.L, "sliding"}, {0., 0., 1e-4L, "off"}});
    unsigned int      refused = 0, noted = 0;
    for (const std::string entry :
         {"Solver/Search=full", "Solver/Prove=true", "Solver/Search=automatic"})
      {
        std::vector<std::string> more = entries;
        more.push_back(entry);
        const Parameters   parameters = parameters_of(more);
        const Scene<2>     scene(parameters);
        const Condensation condensed =
          condense_to_contact(scene.problem(), scene.adhesion());
        Eigen::VectorXd s = Eigen::VectorXd::Zero(condensed.load().size());
        try
          {
            const WhichMinimum result = find_better_minimum(
              parameters.solver,
              scene.problem().unknowns().contact().boundary(),
              law,
              scene.adhesion(),
              condensed,
              []() { return true; },
              s);
            noted += result.notes.size() == 1 &&
                     result.kind != MinimumKind::best_known &&
                     result.kind != MinimumKind::global;
          }
        catch (const BadInput &)
          {
            ++refused;
          }
      }
    std::cout << "a law of another shape is refused: "
              << (refused == 2 ? "yes" : "NO")
              << ", and by default noted: " << (noted == 1 ? "yes" : "NO")
              << '\n';
  }



  /// A pad with five patches, whose minimum branch and bound proves with 54,543
  /// nodes: the moves have to be tried again from what a proof with few nodes
  /// finds.
  void
  test_patches()
  {
    constexpr double minimum = -4.56234928075e-3;
    // Automatic may be cut short by its limit of time.
    for (const std::string search : {"full"})
      {
        const Parameters parameters = parameters_of(
          {"Dimension=2",
           "Material/Young modulus=1",
           "Material/Poisson ratio=0.0958529",
           "Boundary conditions/Contact boundary=bottom",
           "Boundary conditions/Clamped boundaries=top",
           "Contact law/Tangential displacement=fixed",
           "Mesh/Lengths=1.7075, 0.111103",
           "Mesh/Cells=124, 1",
           "Loads/Traction bottom=0; "
           "0.950284*sin(6.283*4.56869*x/1.7075+5.64752)+0.347743",
           "Contact law/Bond threshold=0.00697278",
           "Contact law/Bond stiffness=1372.05",
           "Solver/Search=" + search});
        const Scene<2>    scene(parameters);
        const SolveResult result = solved(parameters, scene);
        std::cout << "a pad with five patches, " << search << ": "
                  << verdict(std::abs(result.functional / minimum - 1.), 1e-9)
                  << '\n';
      }
  }



  /// Without time a search says that it has ended, and claims nothing.
  void
  test_limit_of_time()
  {
    const Parameters parameters =
      parameters_of({"Contact law/Bond stiffness=690",
                     "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345)"});
    const Scene<2>     scene(parameters);
    const Condensation condensed =
      condense_to_contact(scene.problem(), scene.adhesion());
    for (const double seconds : {0., std::numeric_limits<double>::infinity()})
      {
        SolverParameters solver = parameters.solver;
        solver.search_seconds   = seconds;
        // The intact state, which is a minimum far above the least one.
        Eigen::VectorXd  s = Eigen::VectorXd::Zero(condensed.load().size());
        CondensedProblem problem(condensed.schur_complement(),
                                 condensed.load(),
                                 scene.adhesion(),
                                 s);
        MajoriseMinimise(solver.majorise_minimise).minimize(problem);
        const Eigen::VectorXd start  = s;
        const WhichMinimum    result = find_better_minimum(
          solver,
          scene.problem().unknowns().contact().boundary(),
          scene.law(),
          scene.adhesion(),
          condensed,
          []() { return true; },
          s);
        std::cout << (seconds > 0. ? "with" : "without")
                  << " time: " << to_string(result.kind) << ", "
                  << result.notes.size() << " notes"
                  << (s == start ? ", nothing lower" : "") << '\n';
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  const bool         figures = argc > 2;
  const unsigned int seed    = argc > 3 ? std::stoul(argv[3]) : 20261122;
  if (figures)
    most_nodes = 16;
  if (argc > 4)
    proof_nodes = std::stoul(argv[4]);
  test_other_law();
  test_limit_of_time();
  if (!figures)
    test_patches();
  report("small scenes against enumeration",
         attack(figures ? std::stoul(argv[1]) : 20, false, seed),
         figures);
  report("many patches against branch and bound",
         attack(figures ? std::stoul(argv[2]) : 5, true, seed),
         figures);
}
