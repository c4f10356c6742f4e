// SPDX-License-Identifier: LGPL-2.1-or-later
// Variables bound to entries: what is written into them, and what is said of
// values that are not allowed and of entries without effect.
#include <debond/base/text.h>
#include <debond/input/parameters.h>

#include <iostream>
#include <sstream>

#include "../check.h"

using namespace Debond;

namespace
{
  enum class Fruit
  {
    apple,
    pear,
    plum
  };



  struct Section
  {
    double                             number = 0.1;
    unsigned int                       count  = 3;
    std::string                        text   = "as it is";
    std::vector<double>                list   = {1., 2.5};
    std::set<std::string>              names  = {"a", "b"};
    bool                               on     = true;
    Fruit                              fruit  = Fruit::plum;
    std::map<std::string, std::string> family;
    int                                even = 0;
  };



  const Pattern anything("anything");
  const Pattern numbers("a list, each a number", [](const std::string &value) {
    double unused;
    return read_number(value, unused);
  });



  void
  bind(Section &section, ParameterTable &table)
  {
    table.bind("A/Number", section.number, number(), "A number");
    table.bind("A/Count", section.count, whole_number(0, 9), "A count");
    table.bind("A/Text", section.text, anything, "A text");
    table.bind("A/List", section.list, numbers, "A list");
    table.bind("A/Names", section.names, "Names");
    table.bind("A/On", section.on, "A switch");
    // Neither in the order of the values nor all of them.
    table.bind_choice("A/Fruit",
                      section.fruit,
                      {{"plum", Fruit::plum}, {"apple", Fruit::apple}},
                      "A choice");
    table.bind_family("A/Member", section.family, anything, "Members");
    table.declare("A/Even",
                  "0",
                  whole_number(0, 9),
                  "A number that its pattern does not tell",
                  "none",
                  [&section](const std::string &text) {
                    section.even = std::stoi(text);
                    if (section.even % 2 != 0)
                      throw std::invalid_argument("it is odd");
                  });
  }



  void
  print(const Section &section)
  {
    std::cout << section.number << " | " << section.count << " | "
              << section.text << " |";
    for (const double number : section.list)
      std::cout << ' ' << number;
    std::cout << " |";
    for (const std::string &name : section.names)
      std::cout << ' ' << name;
    std::cout << " | " << section.on << " | "
              << (section.fruit == Fruit::apple ? "apple" : "plum") << " |";
    for (const auto &[name, value] : section.family)
      std::cout << ' ' << name << '=' << value;
    std::cout << " | " << section.even << std::endl;
  }



  void
  test_values(const std::vector<std::string> &assignments)
  {
    Section        section;
    ParameterTable table;
    bind(section, table);
    for (const std::string &assignment : assignments)
      table.assign("A/" + assignment);
    table.take_values();
    print(section);
    for (const std::string &line : table.errors)
      std::cout << line << std::endl;
  }



  /// What is said of entries that a scene has no use for.
  void
  test_entries_without_effect()
  {
    const auto print_notes = [](const std::string              &text,
                                const std::vector<std::string> &assignments) {
      SceneTable         table;
      std::istringstream scene(text);
      table.read(scene, "scene.prm");
      for (const std::string &assignment : assignments)
        table.assign(assignment);
      try
        {
          table.evaluate();
          const Parameters parameters = table.parameters("scene.prm");
          for (const std::string &note : parameters.notes)
            std::cout << "  " << note << std::endl;
          return parameters.effective_scene;
        }
      catch (const BadInput &error)
        {
          for (const std::string &line : error.lines)
            std::cout << "  " << line << std::endl;
          return std::string();
        }
    };
    std::cout << "All defaults, and what a run of them writes" << std::endl;
    std::ostringstream all;
    SceneTable().print(all, false);
    print_notes(print_notes(all.str(), {}), {});
    for (const std::vector<std::string> &assignments :
         std::vector<std::vector<std::string>>{
           {"Contact law/Law=curve",
            "Contact law/Curve=0:0, 1:1, 2:0",
            "Contact law/Traction factor=2*x",
            "Contact law/Bond stiffness=69"},
           {"Contact law/Law=curve",
            "Contact law/Curve=0:0, 1:1, 2:0",
            "Contact law/Bond threshold top=1"},
           {"Contact law/Law=bilinear",
            "Contact law/Bond stiffness=100",
            "Contact law/Bond strength=1",
            "Contact law/Fracture energy=0.02",
            "Contact law/Traction factor=x"},
           {"Contact law/Law=none", "Contact law/Bond stiffness=70"},
           {"Contact law/Law=none", "Contact law/Traction factor=x"},
           {"Contact law/Curve=0:0, 1:1"},
           {"Contact law/Traction factor=1"},
           {"Boundary conditions/Contact boundary=",
            "Contact law/Initial gap=0.1",
            "Contact law/Bond stiffness=7"},
           {"Dimension=3",
            "Mesh/Lengths=1, 1, 1",
            "Mesh/Cells=1, 1, 1",
            "Material/Hypothesis=plane strain"},
           {"Mesh/Source=generator",
            "Mesh/Generator=hyper_cube",
            "Mesh/Arguments=0 : 1 : true",
            "Boundary conditions/Clamped boundaries=0",
            "Boundary conditions/Contact boundary=1",
            "Mesh/Cells=5, 7"},
           {"Mesh/Source=generator",
            "Mesh/Generator=hyper_cube",
            "Mesh/Arguments=0 : 1 : true",
            "Boundary conditions/Clamped boundaries=0",
            "Boundary conditions/Contact boundary=1",
            "Mesh/Scale=3"},
           {"Material/Thermal expansion=1e-6"},
           {"Loads/Temperature change=5"},
           {"Load path/Bonds heal=false", "Output/Load path body VTU=true"},
           {"Loads/Body force=0; 1",
            "Load path/Factors=0:0.1:1",
            "Load path/Global branch=none",
            "Solver/Search=full"},
           {"Solver/Method=energy bundle",
            "Solver/Euclidean bundle/Bundle size=9",
            "Solver/Majorise minimise/Stop tolerance=1e-7",
            "Solver/Proof/Maximum nodes=5"},
           {"Solver/Method=energy bundle",
            "Solver/Prove=true",
            "Solver/Majorise minimise/Stop tolerance=1e-7",
            "Solver/Proof/Maximum nodes=5"},
           {"Solver/Method=euclidean bundle",
            "Solver/Linear solver=direct",
            "Solver/Energy bundle/Bundle size=9"}})
      {
        for (const std::string &assignment : assignments)
          std::cout << assignment
                    << (&assignment == &assignments.back() ? "\n" : " | ");
        print_notes("", assignments);
      }
  }
} // namespace



int
main()
{
  std::cout << "== Values left out" << std::endl;
  test_values({});
  std::cout << "== Values given" << std::endl;
  test_values({"Number=-2e3",
               "Count=9",
               "Text=x = y",
               "List=4,5 , 6",
               "Names=c, b",
               "On=false",
               "Fruit=apple",
               "Member one=1",
               "Member two=",
               "Even=4"});
  std::cout << "== Values that are not allowed" << std::endl;
  test_values({"Number=much",
               "Count=-1",
               "List=4, five",
               "On=yes",
               "Fruit=pear",
               "Members=1",
               "Even=3"});
  std::cout << "== Entries without effect" << std::endl;
  test_entries_without_effect();
}
