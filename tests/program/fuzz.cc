// SPDX-License-Identifier: LGPL-2.1-or-later
// Mutations of the shipped scenes and of small ones with all kinds of bodies,
// parts, supports and bonds, half of them with more entries: each is rejected
// with the entry or the line named and nothing written, or read; what is small
// is also solved. The same of mutated mesh files, a sixth as many. An argument
// gives the number of scenes. A case that crashes or hangs is printed before
// the test ends.

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>

#include <debond/input/parameters.h>
#include <debond/mesh/crossed_mesh.h>
#include <debond/program/run.h>
#include <debond/solve/method_choice.h>

#include <filesystem>
#include <iostream>
#include <regex>
#include <sstream>

#include "../check.h"
#include "../mesh/msh_text.h"
#include "mutator.h"

using namespace Debond;
using namespace Fuzz;

namespace
{
  constexpr double largest_scene_to_solve = 1500.; // unknowns



  const std::vector<std::string> hostile_values = {"",
                                                   "0",
                                                   "-0",
                                                   "1",
                                                   "-1",
                                                   "2",
                                                   "3",
                                                   "1e-300",
                                                   "1e300",
                                                   "1e308",
                                                   "-1e308",
                                                   "1e-12",
                                                   "1e12",
                                                   "nan",
                                                   "inf",
                                                   "-inf",
                                                   "1e",
                                                   "0x10",
                                                   "1,5",
                                                   "1, 1",
                                                   "2, 1",
                                                   "3, 2, 1",
                                                   "1, 1, 1",
                                                   "1e-9, 1e9",
                                                   "999999999999",
                                                   "4294967296",
                                                   "0.5",
                                                   "0.4999999",
                                                   "-0.999",
                                                   "left",
                                                   "right, right",
                                                   "bottom",
                                                   "bottom, top",
                                                   "left, right, bottom, top",
                                                   "front",
                                                   "free",
                                                   "fixed",
                                                   "none",
                                                   "winkler",
                                                   "exact",
                                                   "midpoint",
                                                   "gauss 1",
                                                   "gauss 99",
                                                   "gauss 100",
                                                   "gauss -1",
                                                   "plane strain",
                                                   "true",
                                                   "automatic",
                                                   "energy bundle",
                                                   "majorise minimise",
                                                   "multigrid",
                                                   "direct",
                                                   "0; 0",
                                                   "0; 1/x",
                                                   "0; 1/(x-0.2)",
                                                   "0; log(-1)",
                                                   "0; sqrt(x-0.2)",
                                                   "0; rint(1e9*x)",
                                                   "0; x",
                                                   "0; 0; 0",
                                                   "0; 1e300",
                                                   "0; sin(1e6*x)",
                                                   "0; if(x<0.2,1,",
                                                   "0; y z",
                                                   ";",
                                                   "0;",
                                                   "a=1",
                                                   "a=1, a=2",
                                                   "x=1",
                                                   "pi=3",
                                                   "a=nan",
                                                   "{scene}",
                                                   "/",
                                                   "\\",
                                                   "#",
                                                   "end",
                                                   "0; rand()",
                                                   "0; rand_seed(1)",
                                                   "0; x=1",
                                                   "0; 0.69*(x^-1)",
                                                   "..",
                                                   "x",
                                                   "69*x",
                                                   "0.1-x",
                                                   "1/(x-0.1)",
                                                   "if(x>0.1,0,69)",
                                                   "0.001*y",
                                                   "free; 0.001",
                                                   "free; free",
                                                   "free; -0.001",
                                                   "free; 1e-5*t",
                                                   "free; free; free",
                                                   "glued",
                                                   "glued, top",
                                                   "core",
                                                   "all",
                                                   "bottom: x > 0.05",
                                                   "bottom: x > 9",
                                                   "bottom: ",
                                                   "nowhere: x > 0.05",
                                                   "glued: x < 0.1",
                                                   "y > 0.02",
                                                   "x ? 1 : 0",
                                                   "bottom: x > 0.05 && x < "
                                                   "0.07",
                                                   "0.5, 1, 0.5, 0",
                                                   "0:0.25:1",
                                                   "0:0:1",
                                                   "1:-0.5:-1",
                                                   "0, nan",
                                                   "mean bottom",
                                                   "force glued",
                                                   "force core",
                                                   "mean",
                                                   "0.1, 0.02",
                                                   "9, 9",
                                                   "box",
                                                   "file",
                                                   "generator",
                                                   "plane.msh",
                                                   "solid.msh",
                                                   "missing.msh",
                                                   "hyper_L",
                                                   "-1 : 1 : true",
                                                   "subdivided_hyper_rectangle",
                                                   "traction, body force",
                                                   "top",
                                                   "symmetry",
                                                   std::string(5000, '9'),
                                                   "0; " +
                                                     std::string(2000, '(')};



  /// Entries that are added to scenes, with a value that fits.
  const std::vector<std::pair<std::string, std::string>> more_entries = {
    {"Parts/glued", "bottom: x > 0.05"},
    {"Parts/core", "y > 0.02"},
    {"Parts/bottom", "y > 0.02"},
    {"Parts/", "x > 0"},
    {"Material/Young modulus core", "7"},
    {"Material/Poisson ratio core", "0.2"},
    {"Material/Poisson ratio upper", "0.2"},
    {"Material/Thermal expansion core", "1e-5"},
    {"Material/Thermal expansion", "1e-5"},
    {"Material/Young modulus nowhere", "7"},
    {"Boundary conditions/Roller boundaries", "right"},
    {"Boundary conditions/Symmetry boundaries", "right"},
    {"Boundary conditions/Clamped boundaries", ""},
    {"Boundary conditions/Contact boundary", "bottom, top"},
    {"Boundary conditions/Displacement right", "free; 0.0001"},
    {"Boundary conditions/Displacement top", "free; 0.0001"},
    {"Boundary conditions/Displacement bottom", "0.0001; free"},
    {"Boundary conditions/Displacement glued", "0; free"},
    {"Contact law/Bond stiffness", "69*x"},
    {"Contact law/Bond threshold", "0.001*(1+x)"},
    {"Contact law/Bond strength", "0.1"},
    {"Contact law/Fracture energy", "1e-4"},
    {"Contact law/Initial gap", "0.0001*x"},
    {"Contact law/Bond stiffness glued", "7"},
    {"Contact law/Bond stiffness bottom", "7"},
    {"Contact law/Bond stiffness top", "0"},
    {"Contact law/Bond threshold glued", "0.0001"},
    {"Contact law/Bond threshold nowhere", "0.0001"},
    {"Contact law/Bond strength glued", "0.1"},
    {"Contact law/Fracture energy glued", "1e-4"},
    {"Contact law/Initial gap glued", "0.0001"},
    {"Contact law/Initial gap bottom", "0.0001*x"},
    {"Contact law/Tangential displacement glued", "free"},
    {"Contact law/Tangential displacement bottom", "free"},
    {"Contact law/Tangential displacement", "free"},
    {"Contact law/Quadrature", "exact"},
    {"Contact law/Law", "stepped"},
    {"Load path/Factors", "0.5, 1, 0.5, 0"},
    {"Load path/Displacement factors", "0:0.25:1"},
    {"Load path/Dead loads", "body force"},
    {"Load path/Bonds heal", "false"},
    {"Loads/Temperature change", "20*y"},
    {"Loads/Traction glued", "0; -0.01"},
    {"Loads/Traction top", "0; 0.01"},
    {"Loads/Body force", "0; 0.01"},
    {"Probes/tip", "0.1, 0.02"},
    {"Probes/grip", "force bottom"},
    {"Probes/all", "mean core"},
    {"Mesh/Source", "box"},
    {"Mesh/File", "plane.msh"},
    {"Mesh/Scale", "0.1"},
    {"Mesh/Generator", "hyper_L"},
    {"Mesh/Arguments", "-1 : 1 : true"},
    {"Mesh/Refinements", "1"},
    {"Mesh/Degree", "2"},
    {"Mesh/Cells", "6, 2"},
    {"Solver/Method", "automatic"},
    {"Solver/Prove", "true"},
    {"Certificate/Kind", "global"},
    {"Accuracy/Maximum unknowns", "300"}};



  /// Small scenes with bodies of all kinds.
  const std::vector<std::string> small_scenes = {
    R"(subsection Mesh
  set Lengths = 0.2, 0.04
  set Cells = 10, 2
end
subsection Parts
  set glued = bottom: x > 0.05
  set core = y > 0.02
end
subsection Material
  set Young modulus core = 7
  set Thermal expansion = 1e-5
end
subsection Boundary conditions
  set Clamped boundaries = left
  set Symmetry boundaries = right
  set Contact boundary = bottom, top
end
subsection Contact law
  set Bond stiffness = if(x > 0.1, 0, 69)
  set Bond threshold glued = 0.001
  set Bond stiffness top = 7
  set Initial gap top = 0.0001*x
  set Tangential displacement top = free
end
subsection Loads
  set Body force = 0; 0.01
  set Temperature change = 20*y
end
subsection Probes
  set tip = 0.2, 0.02
  set grip = force glued
end
)",
    R"(subsection Mesh
  set Source = file
  set File = plane.msh
  set Scale = 0.1
end
subsection Boundary conditions
  set Clamped boundaries =
  set Roller boundaries = left
  set Contact boundary = bottom
  set Displacement top = free; 1e-4
end
subsection Material
  set Young modulus upper = 7
  set Poisson ratio upper = 0.2
end
subsection Contact law
  set Bond strength bottom = 0.1
  set Fracture energy bottom = 1e-4
end
subsection Load path
  set Displacement factors = 0:0.5:2
  set Bonds heal = false
end
)",
    R"(subsection Mesh
  set Source = generator
  set Generator = hyper_L
  set Arguments = -1 : 1 : true
end
subsection Boundary conditions
  set Clamped boundaries = 0
  set Contact boundary = 1, 2
end
subsection Contact law
  set Bond stiffness 1 = 10
  set Bond strength 2 = 0.1
  set Bond threshold 2 = 0.01
  set Quadrature = gauss 2
end
subsection Loads
  set Traction 5 = 0; 0.1
end
)",
    R"(set Dimension = 3
subsection Mesh
  set Source = file
  set File = solid.msh
end
subsection Boundary conditions
  set Clamped boundaries =
  set Contact boundary = bottom, top
end
subsection Contact law
  set Bond stiffness bottom = 10
  set Bond threshold top = 0.01*(1+x)
  set Initial gap top = 0.001
end
subsection Loads
  set Body force = 0; 0.1; 0
end
subsection Load path
  set Factors = 0.5, 1, 0
  set Dead loads = body force
end
)"};



  std::vector<std::string>
  base_scenes(const std::filesystem::path &directory)
  {
    std::vector<std::string> scenes = read_files(directory, ".prm");
    for (const char *folder : {"hard", "cookbook"})
      {
        const auto more = read_files(directory / folder, ".prm");
        scenes.insert(scenes.end(), more.begin(), more.end());
      }
    for (unsigned int k = 0; k < 6; ++k)
      scenes.insert(scenes.end(), small_scenes.begin(), small_scenes.end());
    return scenes;
  }



  /// Mesh files with the groups of boxes: squares, triangles, hexahedra.
  std::vector<std::string>
  mesh_files()
  {
    dealii::Triangulation<2> coarse, crossed;
    dealii::Triangulation<3> bricks;
    dealii::GridGenerator::subdivided_hyper_rectangle(
      coarse, {4, 2}, dealii::Point<2>(), dealii::Point<2>(2., 1.), true);
    crossed_subdivision(coarse, crossed);
    dealii::GridGenerator::subdivided_hyper_rectangle(bricks,
                                                      {2, 1, 1},
                                                      dealii::Point<3>(),
                                                      dealii::Point<3>(2.,
                                                                       1.,
                                                                       1.),
                                                      true);
    std::vector<std::string> texts;
    for (const bool version_4 : {false, true})
      texts.insert(texts.end(),
                   {msh_text(coarse, version_4),
                    msh_text(crossed, version_4),
                    msh_text(bricks, version_4)});
    return texts;
  }



  void
  write_file(const std::string &name, const std::string &text)
  {
    std::ofstream(name) << text;
  }



  /// One to three lines of a mesh file changed.
  std::string
  mutated_mesh(const std::string &text, Mutator &random)
  {
    static const std::vector<std::string> odd = {"-1",
                                                 "0",
                                                 "1e300",
                                                 "nan",
                                                 "x",
                                                 "99999999999999999999",
                                                 "4294967297",
                                                 "2",
                                                 "7",
                                                 "",
                                                 "\"",
                                                 "0.5",
                                                 "4.1 1 8"};
    std::vector<std::string>              lines;
    std::istringstream                    input(text);
    for (std::string line; std::getline(input, line);)
      lines.push_back(line);
    for (unsigned int k = random.below(3) + 1; k > 0; --k)
      {
        const unsigned int at   = random.below(lines.size());
        std::string       &line = lines[at];
        switch (random.below(7))
          {
            case 0:
              lines.erase(lines.begin() + at);
              break;
            case 1:
              std::swap(line, lines[random.below(lines.size())]);
              break;
            case 2:
              line.resize(random.below(line.size() + 1));
              break;
            case 3:
              lines.insert(lines.begin() + at,
                           std::string(lines[random.below(lines.size())]));
              break;
            case 4:
              line.insert(random.below(line.size() + 1),
                          1,
                          char(random.below(255) + 1));
              break;
            default:
              {
                const std::size_t blank =
                  line.rfind(' ', random.below(line.size() + 1));
                const std::size_t from =
                  blank == std::string::npos ? 0 : blank + 1;
                line.replace(from,
                             line.find(' ', from) - from,
                             odd[random.below(odd.size())]);
              }
          }
        if (lines.empty())
          break;
      }
    std::string result;
    for (const std::string &line : lines)
      result += line + '\n';
    // Some are cut off.
    return random.below(10) == 0 ?
             result.substr(0, random.below(result.size() + 1)) :
             result;
  }



  /// The scene of a mutated file.
  std::string
  scene_of_mesh(const bool is_solid)
  {
    return std::string(is_solid ? "set Dimension = 3\n" : "") +
           R"(subsection Mesh
  set Source = file
  set File = case.msh
end
subsection Boundary conditions
  set Clamped boundaries = left
  set Contact boundary = bottom, top
end
subsection Material
  set Young modulus upper = 7
end
subsection Contact law
  set Bond stiffness top = 7
end
subsection Loads
  set Traction right = 0; 0.1)" +
           (is_solid ? "; 0" : "") + "\nend\n";
  }



  struct Counts
  {
    unsigned int rejected = 0, read = 0, solved = 0, not_converged = 0;
    unsigned int multigrid = 0, unnamed = 0, failed = 0, written = 0;
  };



  /// Whether an error says where the mistake is: the line, an entry, or the
  /// load and the point.
  bool
  is_named(const std::string &error, const bool is_mesh)
  {
    // Whatever is wrong with a mesh, or with names that it has lost.
    static const std::regex in_mesh(
      "^fuzz\\.prm:[0-9]+: [^]*(case\\.msh|the body has no|has no (face|cell)|"
      "Boundary conditions|rigid motion)[^]*");
    if (is_mesh)
      return std::regex_match(error, in_mesh);
    static const std::regex named(
      "^fuzz\\.prm:[0-9]+: [^]*|[^]*(Dimension|[A-Z][A-Za-z ]*/[A-Z][a-z]+|"
      "traction|body force|Boundary conditions|clamped|contact boundary)[^]*");
    return std::regex_match(error, named);
  }



  void
  try_case(const std::string &scene,
           const bool         is_mesh,
           const std::string &directory,
           Counts            &counts)
  {
    std::filesystem::remove_all(directory);
    bool is_read = false;
    try
      {
        SceneTable         table;
        std::istringstream input(scene);
        table.read(input, "fuzz.prm");
        Parameters         parameters = table.parameters("fuzz.prm");
        const MethodChoice choice =
          choose_method(parameters, parameters.solver, parameters.accuracy);
        ++counts.read;
        is_read = true;
        if (parameters.dimension * parameters.body->n_vertices() >
            largest_scene_to_solve)
          return;
        // Which is chosen for large scenes only.
        if (counts.read % 4 == 0 &&
            choice.linear_solver == LinearSolver::automatic)
          {
            parameters.solver.method        = SolverMethod::majorise_minimise;
            parameters.solver.linear_solver = LinearSolver::multigrid;
            parameters.solver.prove         = false;
            ++counts.multigrid;
          }

        parameters.output.directory = directory;
        for (auto *method :
             {&parameters.solver.bundle, &parameters.solver.energy_bundle})
          method->maximum_iterations =
            std::min(method->maximum_iterations, 50U);
        std::ostringstream log;
        const ExitCode     code = parameters.dimension == 2 ?
                                    run<2>(parameters, log, false) :
                                    run<3>(parameters, log, false);
        ++counts.solved;
        counts.not_converged += code == ExitCode::not_converged;
        if (code != ExitCode::success && code != ExitCode::not_converged)
          {
            ++counts.failed;
            std::cout << "exit code " << static_cast<int>(code)
                      << " of the case\n"
                      << current_case;
          }
      }
    catch (const BadInput &error)
      {
        ++counts.rejected;
        counts.read -= is_read;
        for (const std::string &line : error.lines)
          if (!is_named(line, is_mesh))
            {
              ++counts.unnamed;
              std::cout << "no entry is named: " << line << '\n';
            }
        if (std::filesystem::exists(directory))
          {
            ++counts.written;
            std::cout << "rejected, but files are written: " << error.lines[0]
                      << '\n';
          }
      }
    catch (const std::exception &error)
      {
        ++counts.failed;
        std::cout << "exception " << error.what() << "\nin the case\n"
                  << current_case;
      }
  }
} // namespace



int
main(int argc, char *argv[])
{
  const unsigned int n_cases = argc > 1 ? std::stoul(argv[1]) : 500;
  // Multigrid needs MPI, which starts only once in a process.
  int                                            no_arguments = 0;
  char                                         **no_argument  = nullptr;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(no_arguments,
                                                     no_argument,
                                                     1);
  catch_signals();

  const std::vector<std::string> scenes = base_scenes(SOURCE_DIR "/../../prm");
  const std::vector<std::string> meshes = mesh_files();
  const std::filesystem::path    folder =
    std::filesystem::temp_directory_path() /
    ("debond-fuzz-" + std::to_string(getpid()));
  const std::string directory = (folder / "output").string();
  std::filesystem::create_directories(folder);
  std::filesystem::current_path(folder);
  write_file("plane.msh", meshes[0]);
  write_file("solid.msh", meshes[2]);
  write_file("ring.msh", meshes[4]);

  std::ostringstream    messages;
  std::streambuf *const errors = std::cerr.rdbuf(messages.rdbuf());
  Mutator               mutator(hostile_values);
  Counts                counts, mesh_counts;
  for (unsigned int k = 0; k < n_cases; ++k)
    {
      current_case = mutator(scenes[mutator.below(scenes.size())]);
      if (mutator.below(2) == 0)
        for (unsigned int n = mutator.below(3) + 1; n > 0; --n)
          {
            const auto &[path, fitting] =
              more_entries[mutator.below(more_entries.size())];
            const std::size_t slash = path.find('/');
            const std::string value =
              mutator.below(3) > 0 ? fitting : mutator.value();
            current_case += "subsection " + path.substr(0, slash) + "\n  set " +
                            path.substr(slash + 1) + " = " + value + "\nend\n";
          }
      alarm(seconds_for_a_case);
      try_case(current_case, false, directory, counts);
      alarm(0);
      messages.str("");
    }
  for (unsigned int k = 0; k < n_cases / 6; ++k)
    {
      const unsigned int which = k % meshes.size();
      current_case             = mutated_mesh(meshes[which], mutator);
      write_file("case.msh", current_case);
      alarm(seconds_for_a_case);
      try_case(scene_of_mesh(which % 3 == 2), true, directory, mesh_counts);
      alarm(0);
      messages.str("");
    }
  std::cerr.rdbuf(errors);
  std::filesystem::current_path("/");
  std::filesystem::remove_all(folder);

  for (const auto &[name, all] : {std::make_pair("scenes", counts),
                                  std::make_pair("mesh files", mesh_counts)})
    {
      std::cout << name << "\nfailures: " << all.failed
                << "\nrejections that name nothing: " << all.unnamed
                << "\nthat write something: " << all.written
                << "\nsome of each: "
                << verdict(all.rejected > 0 && all.solved > 0) << '\n';
      if (argc > 1)
        std::cout << (all.rejected + all.read + all.failed)
                  << " cases: " << all.rejected << " rejected, " << all.read
                  << " read, " << all.solved << " solved (" << all.multigrid
                  << " by multigrid), " << all.not_converged
                  << " not converged\n";
    }
  return counts.failed + counts.unnamed + counts.written + mesh_counts.failed +
               mesh_counts.unnamed + mesh_counts.written >
             0 ?
           1 :
           0;
}
