// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/memory.h>
#include <debond/input/contact_parameters.h>
#include <debond/input/idle_entries.h>
#include <debond/input/parameters.h>
#include <debond/input/probe_parameters.h>
#include <debond/input/scene_checks.h>

#include <boost/algorithm/string/predicate.hpp>

#include <filesystem>
#include <fstream>

namespace Debond
{
  BadInput::BadInput(const std::vector<std::string> &errors)
    : std::invalid_argument(join(errors, "\n"))
    , lines(errors)
  {}



  SceneTable::SceneTable(CompanionEntries *const companion)
    : companion(companion)
  {
    // The order of these calls is that of the sections and entries in a scene
    // that is printed.
    bind_constants(constants, *this);
    bind("Dimension", p.dimension, whole_number(2, 3), "Space dimension");
    bind_choice(
      "Symmetry",
      p.symmetry,
      {{"none", Symmetry::none}, {"axis", Symmetry::axis}},
      "With axis the plane mesh is half of a section of a body of revolution: x is the distance from its axis, on which nodes are held along x, and y is along the axis. Forces, energies and areas are those of the whole circle");
    bind_mesh(body, *this);
    bind(
      "Mesh/Degree",
      p.degree,
      whole_number(1, 2),
      "Degree of the displacement on each triangle or tetrahedron: linear, as in the paper, or quadratic, which has a much smaller error for as many unknowns and no locking; it needs Contact law/Quadrature = gauss N");
    bind_parts(parts, *this);
    bind_probes(p.probes, *this);
    bind_material(p.materials, *this);
    bind_boundaries(p, *this);
    bind_loads(p.loads, *this);
    bind_load_path(p.load_path, *this);
    laws.bind(*this);
    bind_supports(p.supports, *this);
    bind_contact(p, *this);
    bind_solver(p.solver, *this);
    bind_accuracy(p.accuracy, p.verification, *this);
    if (companion != nullptr)
      companion->bind(*this);
    bind_output(p.output, *this);
  }



  void
  SceneTable::evaluate()
  {
    // Constants have values before those of any other entry are taken. Which of
    // them are used is seen in the texts as they were written, which the values
    // replace afterwards.
    p.loads.constants = body.meshing.constants = constants_of(*this);
    unused_constants = idle_constants(p.loads.constants, *this);
    take_values([this](const std::string &text) {
      return with_values(text, p.loads.constants);
    });
  }



  void
  read_scene(const std::string &scene, ParameterTable &table)
  {
    // Output goes into a folder of this name, and the name is printed to the
    // terminal.
    const std::string name = std::filesystem::path(scene).stem().string();
    if (printable(scene) != scene || name == "." || name == "..")
      throw BadInput({scene + ": no scene may have this name"});
    // What is no scene is refused by what it is. Read as a scene it would give
    // errors of lines that cannot be read, and none of them would say that it
    // is a mesh. A folder opens without an error but cannot be read, and a
    // device need not end. A file in UTF-16 begins with 0xfe or 0xff, which no
    // text in UTF-8 has.
    std::error_code error;
    if (!std::filesystem::exists(scene, error))
      throw BadInput({scene + ": there is no such file"});
    std::ifstream input(scene);
    if (!input || std::filesystem::is_directory(scene) ||
        std::filesystem::is_character_file(scene))
      throw BadInput({scene + ": cannot be read as a scene file"});
    if (input.peek() >= 0xfe)
      throw BadInput({scene + ": this is UTF-16; save it as UTF-8"});
    const std::string ending = std::filesystem::path(scene).extension();
    if (input.peek() == '{' || ending == ".json")
      throw BadInput({scene + ": this is JSON; a scene is a .prm file, as "
                              "debond --print-parameters prints it"});
    for (const std::string mesh : {".geo",
                                   ".msh",
                                   ".step",
                                   ".stp",
                                   ".stl",
                                   ".unv",
                                   ".inp",
                                   ".vtu",
                                   ".brep"})
      if (boost::iequals(ending, mesh))
        throw BadInput(
          {scene +
           ": this is a mesh or a geometry; a scene (.prm) has it as Mesh/File, with Mesh/Source = file"});
    table.read(input, scene);
  }



  Parameters
  SceneTable::parameters(const std::string &scene)
  {
    // Each step needs what those before it have completed: expressions may use
    // constants of the material, a load path refers to loads and supports, and
    // names are compared with those of the body. Nothing is thrown before the
    // end, so that errors in later steps are found as well.
    const Stage stage("mesh");
    p.scene = scene;
    check_symmetry(p, *this);
    complete_loads(p.dimension, p.materials.everywhere, p.loads, *this);
    complete_load_path(p.loads, p.supports, p.load_path, *this);
    // A mesh that Gmsh makes of a geometry is refused if there is no memory for
    // its cells.
    body.meshing.memory = memory_left(p.solver.memory_limit);
    p.body =
      make_body(scene, p.dimension, body, parts, p.loads.constants, *this);
    check_bonds(p, *this);
    p.law = laws.make_law(*this);
    complete_output(scene, p.output, *this);

    check_scene(p, *this);
    if (companion != nullptr)
      companion->check(p, *this);
    // What has no effect depends on all other entries, also on those of the
    // companion, and is looked for last.
    note_entries_without_effect(p, body, unused_constants, *this);
    if (!errors.empty())
      throw BadInput(errors);

    // The effective scene has all entries, with what follows from others in
    // their place, such as the whole path of a mesh, so that it may lie in
    // another folder than the scene.
    p.notes = notes;
    std::ostringstream effective;
    print(effective, false);
    p.effective_scene = effective.str();
    p.locations       = locations();
    return p;
  }
} // namespace Debond
