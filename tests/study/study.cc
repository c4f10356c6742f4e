// SPDX-License-Identifier: LGPL-2.1-or-later

// The parts of a study against values that are known: ranges of values, fits
// of exact power laws, tables with all that their formats treat specially, and
// reference results.

#include <debond/base/data_table.h>
#include <debond/input/parameters.h>
#include <debond/study/best_values.h>
#include <debond/study/convergence.h>
#include <debond/study/reference.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

#include "../check.h"

using namespace Debond;



namespace
{
  bool
  is_near(const double a, const double b)
  {
    return std::abs(a - b) <= 1e-12 * std::abs(b);
  }



  void
  print_values(const std::string &text)
  {
    std::cout << "values of '" << text << "':";
    try
      {
        for (const std::string &value : parse_sweep_values(text))
          std::cout << " [" << value << ']';
        std::cout << std::endl;
      }
    catch (const std::invalid_argument &error)
      {
        std::cout << ' ' << error.what() << std::endl;
      }
  }



  void
  check_fits()
  {
    const auto law = fit_power_law({1., 2., 5.}, {3., 3. / 8., 3. / 125.});
    check("k^-3 has exponent -3 and factor 3",
          law && is_near(law->exponent, -3.) && is_near(law->factor, 3.));
    check("one x has no exponent", !fit_power_law({2., 2.}, {1., 3.}));

    // 1/2, then k^-4 from k = 10 (1e-4) to k = 100 (1e-8), then k^-2.
    std::vector<double> errors;
    for (unsigned int k = 1; k <= 200; ++k)
      errors.push_back(k < 10   ? 0.5 :
                       k <= 100 ? std::pow(k, -4.) :
                                  1e-4 * std::pow(k, -2.));
    const auto rate = fit_rate(errors, 1.0001e-4, 1.0001e-8);
    check("rate -4 from 10 to 100",
          rate && is_near(rate->law.exponent, -4.) && rate->first == 10 &&
            rate->last == 100);
    const auto rest = fit_rate(errors, 0.999e-8, 1e-12);
    check("rate -2 from 101 to the end",
          rest && is_near(rest->law.exponent, -2.) && rest->first == 101 &&
            rest->last == 200);
    check("no rate if the errors stay above", !fit_rate({1., .5, .3}, 0.1, 0.));
    check("no rate of two iterations", !fit_rate({0.1, 1e-9}, 0.1, 1e-8));

    // An error of zero has no logarithm.
    const auto finite = fit_rate({1., 1. / 4., 1. / 9., 0.}, 1., 1e-8);
    check("a finite method",
          finite && is_near(finite->law.exponent, -2.) && finite->last == 3);

    const std::vector<double> relative = relative_errors({-1., -4.}, -4.);
    check("relative errors", relative[0] == 0.75 && relative[1] == 0.);
  }



  void
  check_best_values()
  {
    const auto best =
      best_value({8., 4., 2., 1., 0.5}, {0., 105., 100., 109., 111.});
    check("the best value is 2, good are 1 to 4",
          best && best->value == 2. && best->iterations == 100. &&
            best->smallest_good == 1. && best->largest_good == 4. &&
            !best->at_end);
    const auto last = best_value({4., 2.}, {9., 8.});
    check("the last value may not be the best there is", last && last->at_end);
    check("none if all failed", !best_value({1., 2.}, {0., 0.}));

    std::vector<BestRow> rows;
    for (const double h : {0.02, 0.01, 0.005})
      rows.push_back({"", "", h, {8. * h * h, 1., h, h, false}});
    rows.push_back({"", "", 0.04, {1., 1., 1., 1., true}});
    const auto law = fit_best_values(rows);
    check("8 h^2",
          law && is_near(law->exponent, 2.) && is_near(law->factor, 8.));
  }



  void
  print_file(const std::string &file_name)
  {
    std::ifstream file(file_name);
    std::cout << file_name << '\n' << file.rdbuf();
  }



  void
  check_tables()
  {
    DataTable table;
    table.add_column("u_k", 1);
    table.add_column("a | b", 1);
    table.add_column("n", 1);
    table.add_column("J", 9);
    table.add_column("error", 2);
    table.add_row({std::string("5"),
                   std::string("x, \"y\" & 10 %"),
                   40200L,
                   -5.7774619651e-04,
                   1. / 3.});
    table.add_row({std::string("1e-3"), {}, 0L, 0.1, 1.25e-13});
    table.write_csv("table.csv");
    table.write_markdown("table.md");
    table.write_latex("table.tex");
    for (const char *name : {"table.csv", "table.md", "table.tex"})
      print_file(name);
  }



  void
  print_cell(const Cell &cell)
  {
    if (const auto *const count = std::get_if<long>(&cell))
      std::cout << " count " << *count;
    else if (const auto *const number = std::get_if<double>(&cell))
      std::cout << " number " << *number;
    else
      std::cout << " nothing";
  }



  void
  check_reference()
  {
    std::ofstream("printed.csv") << "# a comment, with commas\n"
                                    "table,value,iterations,J,J_1400\n"
                                    "1,0.0010,1600,-5.0e-4,\n"
                                    "1,5,40200,-4e-4,-3e-4\n"
                                    "2,0.001,7,-1,-1\n";
    ReferenceParameters parameters;
    parameters.file    = "printed.csv";
    parameters.rows    = {{"table", "1"}};
    parameters.key     = "value";
    parameters.columns = {{"iterations", "iterations"},
                          {"error", "J"},
                          {"error at 1400", "J_1400"}};
    parameters.minimum = -5e-4;
    const Reference reference(parameters);
    std::cout << "reference:";
    print_cell(reference.value("1e-3", "iterations", false));
    print_cell(reference.value("1e-3", "error", true));
    print_cell(reference.value("1e-3", "error at 1400", true));
    print_cell(reference.value("5", "error", true));
    print_cell(reference.value("5", "error at 1400", true));
    print_cell(reference.value("5", "long", false));
    print_cell(reference.value("6", "iterations", false));
    std::cout << std::endl;

    const auto print_error = [](const ReferenceParameters &wrong) {
      try
        {
          const Reference unusable(wrong);
          std::cout << "NO ERROR" << std::endl;
        }
      catch (const BadInput &error)
        {
          std::cout << error.what() << std::endl;
        }
    };
    ReferenceParameters wrong = parameters;
    wrong.file                = "nothing.csv";
    print_error(wrong);
    wrong     = parameters;
    wrong.key = "values";
    print_error(wrong);
    wrong      = parameters;
    wrong.rows = {{"table", "3"}};
    print_error(wrong);
  }
} // namespace



int
main()
{
  print_values("");
  print_values("40, 4 | 80, 8 | if(a || b, 1, 2)");
  print_values("geometric 1 1e-4 5");
  print_values("geometric 1 0 5");
  print_values("geometric 1 2");
  check_fits();
  check_best_values();
  check_tables();
  check_reference();
}
