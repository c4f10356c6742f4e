// SPDX-License-Identifier: LGPL-2.1-or-later
// Variables bound to entries: what is written into them, and what is said of
// values that are not allowed. Entries without effect are in program/errors.
#include <debond/base/text.h>
#include <debond/input/parameters.h>

#include <iostream>

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
}
