// SPDX-License-Identifier: LGPL-2.1-or-later
// Tables of results, and growth exponents of made-up ones.

#include <debond/benchmark/benchmark_table.h>
#include <debond/benchmark/contact_against_linear.h>

#include <cmath>
#include <fstream>
#include <iostream>

using namespace Debond;

namespace
{
  BenchmarkRow
  made_up(const std::string &path, const unsigned int unknowns)
  {
    BenchmarkRow row;
    row["path"]       = path;
    row["unknowns"]   = unknowns;
    row["seconds"]    = 3e-7 * std::pow(unknowns, path == "direct" ? 1.5 : 1.);
    row["peak_bytes"] = 100. * std::pow(unknowns, 1.25);
    return row;
  }



  void
  growth()
  {
    std::vector<BenchmarkRow> rows = {made_up("direct", 10),
                                      made_up("direct", 1000),
                                      made_up("multigrid", 1000),
                                      made_up("direct", 4000),
                                      made_up("other", 5000),
                                      made_up("multigrid", 100000),
                                      made_up("direct", 90000)};
    // Too small to count.
    rows[0]["seconds"] = 1.;
    std::cout << "Growth" << std::endl;
    for (const BenchmarkRow &row : fit_growth(rows, 1000))
      std::cout << "  " << row["path"] << ", " << row["scenes"]
                << " scenes from " << row["unknowns_from"] << " to "
                << row["unknowns_to"] << ": time "
                << row["time_exponent"].get<double>() << ", memory "
                << row["memory_exponent"].get<double>() << std::endl;
  }



  void
  tables()
  {
    std::vector<BenchmarkRow> rows(3);
    rows[0]["name"] = "a";
    add_spread("time", {1.2345, 1., 2.}, rows[0]);
    rows[1]["name"]  = "b";
    rows[1]["error"] = 0.1 + 0.2;
    rows[2]["name"]  = "c";
    rows[2]["error"] = std::nan("");
    add_spread("time", {1e-10, 0., 1.}, rows[2]);

    write_csv(rows, "results.csv");
    write_markdown("The machine",
                   {plain_column("name", "name"),
                    spread_column("time, s", "time", 3),
                    number_column("error", "error", 2)},
                   rows,
                   "results.md");
    for (const char *name : {"results.csv", "results.md"})
      std::cout << name << std::endl << std::ifstream(name).rdbuf();
  }
} // namespace



int
main()
{
  growth();
  tables();
}
