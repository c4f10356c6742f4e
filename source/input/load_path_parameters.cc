// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/append.h>
#include <debond/base/tolerances.h>
#include <debond/input/load_path_parameters.h>

#include <algorithm>
#include <cmath>

namespace Debond
{
  namespace
  {
    constexpr unsigned int most_factors = 10000;



    double
    rounded_to_decimals(const double number)
    {
      // The multiples of a step have digits that come from rounding alone.
      // Factors are printed and compared, so that they are the decimal numbers
      // that were meant.
      return std::stod(words(std::setprecision(12), number));
    }



    /// The values of FIRST:STEP:LAST.
    std::vector<double>
    range(const std::string &item,
          const double       first,
          const double       step,
          const double       last)
    {
      // The number of steps is rounded, since 0.1 and its multiples are no
      // binary numbers; the last value has to be met within the rounding of
      // decimals all the same. A step of 0 or in the wrong direction does not
      // lead anywhere. The comparison is written so that NaN fails it.
      const double n = step == 0. ? -1. : std::round((last - first) / step);
      if (!(n >= 1. &&
            std::abs(first + n * step - last) <=
              Tolerance::decimals * (std::abs(first) + std::abs(last))))
        throw std::invalid_argument("the step of " + item +
                                    " does not lead from its first to its "
                                    "last factor");
      if (n >= most_factors)
        throw std::invalid_argument(item + " has more than " +
                                    std::to_string(most_factors) + " factors");

      // The values are parts of the whole way and no sums of steps, in which
      // rounding would add up. What is 0 but for rounding becomes 0, which is a
      // body without loads.
      std::vector<double> values;
      for (unsigned int k = 0; k <= n; ++k)
        {
          const double value = first + (last - first) * (k / n);
          values.push_back(std::abs(value) <
                               Tolerance::decimals * std::abs(step) ?
                             0. :
                             rounded_to_decimals(value));
        }
      return values;
    }



    /// A number, a range, or "NUMBER x COUNT".
    std::vector<double>
    parse_item(const std::string &item)
    {
      if (const auto x = item.find(" x "); x != std::string::npos)
        {
          double number, count;
          if (read_number(item.substr(0, x), number) &&
              read_number(item.substr(x + 3), count) && count >= 1. &&
              count <= most_factors && count == std::floor(count))
            return std::vector<double>(static_cast<std::size_t>(count), number);
          throw std::invalid_argument("'" + item + "' is not NUMBER x COUNT");
        }
      std::vector<double> numbers;
      for (const std::string &word :
           dealii::Utilities::split_string_list(item, ':'))
        {
          double number;
          if (!read_number(word, number))
            throw std::invalid_argument("'" + word + "' is not a number");
          numbers.push_back(number);
        }
      switch (numbers.size())
        {
          case 1:
            return numbers;
          case 3:
            return range(item, numbers[0], numbers[1], numbers[2]);
          default:
            throw std::invalid_argument(
              "'" + item +
              "' is neither a number nor a range FIRST:STEP:LAST nor NUMBER x "
              "COUNT");
        }
    }
  } // namespace



  std::vector<double>
  parse_load_factors(const std::string &text)
  {
    std::vector<double> factors;
    for (const std::string &item :
         dealii::Utilities::split_string_list(text, ','))
      append(parse_item(item), factors);
    if (factors.size() > most_factors)
      throw std::invalid_argument("there are more than " +
                                  std::to_string(most_factors) + " factors");
    return factors;
  }



  void
  bind_load_path(LoadPathParameters &load_path, ParameterTable &table)
  {
    const auto bind_factors = [&table](const std::string   &path,
                                       std::vector<double> &factors,
                                       const std::string   &documentation) {
      table.declare(
        path,
        "",
        Pattern("nothing, or numbers, ranges FIRST:STEP:LAST and repetitions "
                "NUMBER x COUNT, separated by commas"),
        documentation,
        "none",
        [&factors](const std::string &text) {
          factors = parse_load_factors(text);
        });
    };
    bind_factors(
      "Load path/Factors",
      load_path.factors,
      "Multiples of all loads that are applied one after the other, each solved from the state before it, the first one from rest, such as '0:0.05:1.2, 1.2:-0.05:0' for loading and unloading; empty for the loads as they are. Needs another method than euclidean bundle");
    bind_factors(
      "Load path/Displacement factors",
      load_path.displacement_factors,
      "Multiples of the prescribed displacements, step by step beside Factors, each list as long as the other; a single factor holds for all steps, and if Factors is empty the loads stay as they are. Empty: those of the loads");
    table.bind(
      "Load path/Resolve",
      load_path.resolve,
      number("from 0 to 0.5",
             [](const double x) { return x >= 0. && x <= 0.5; }),
      "The part of the largest force to which that is found on a path with Displacement factors alone: between two factors the force may rise further than at both of them before bonds break, and where it may, the step is halved until it is known. The steps of the path stay as they are; 0 leaves it to them");
    table.bind(
      "Load path/Dead loads",
      load_path.dead_loads,
      "What stays as it is whatever the factor: names of boundaries with a traction, body force, or temperature change");
    table.bind(
      "Load path/Bonds heal",
      load_path.bonds_heal,
      "Whether bonds hold again when they come back: false leaves each bond with what it has lost at its largest opening for the rest of the path: one that broke never holds again. Needs nodal, midpoint or gauss N quadrature, whose bonds stay where they are");
    table.bind_choice(
      "Load path/Global branch",
      load_path.global_branch,
      {{"automatic", GlobalBranch::automatic},
       {"none", GlobalBranch::none},
       {"search", GlobalBranch::search},
       {"prove", GlobalBranch::prove}},
      "What is computed beside the states that the load path leads to: search is the lowest minimum that a search finds at each factor, automatic what it finds of it with as much work as the path takes (none with Displacement factors or Bonds heal = false), prove has it proved as well, with the limits of Solver/Proof for each factor, and needs nodal quadrature. With Bonds heal = false it is the energetic path: the minimum at each factor for what its own states before have broken");
    table.bind(
      "Load path/Arc",
      load_path.arc,
      "Whether load_path_arc.csv has the curve of all stationary states that starts at the first factor, from break to break of a bond, with the unstable ones between a snap and the state that it leads to. Needs nodal quadrature and one factor that varies");
  }



  void
  complete_load_path(const LoadParameters    &loads,
                     const SupportParameters &supports,
                     LoadPathParameters      &load_path,
                     ParameterTable          &table)
  {
    const std::string branch     = "Load path/Global branch";
    load_path.asks_for_branch    = table.is_set(branch);
    std::vector<double> &factors = load_path.factors;
    std::vector<double> &others  = load_path.displacement_factors;
    // Factors that follow each other and are equal, such as the last one of
    // loading and the first one of unloading, are one step. With two lists side
    // by side each pair is a step, and a single factor in one of them stands
    // for all.
    if (others.empty())
      factors.erase(std::unique(factors.begin(), factors.end()), factors.end());
    else
      {
        const std::string path = "Load path/Displacement factors";
        if (supports.displacements.empty())
          table.reject(path, "the scene prescribes no displacement");
        // Reactions are wanted of such paths rather than states of less energy.
        if (!load_path.asks_for_branch)
          table.derive(branch, "none", path);
        if (factors.empty())
          factors.push_back(1.);
        if (factors.size() == 1)
          factors.resize(others.size(), factors[0]);
        if (others.size() == 1)
          others.resize(factors.size(), others[0]);
        if (others.size() != factors.size())
          table.reject(path,
                       "has " + std::to_string(others.size()) +
                         " factors, Load path/Factors " +
                         std::to_string(factors.size()),
                       {"Load path/Factors"});
      }
    // States that break nothing too early are wanted of such paths, and the
    // energetic path is another one.
    if (!factors.empty() && !load_path.bonds_heal && !load_path.asks_for_branch)
      table.derive(branch, "none", "Load path/Bonds heal");
    // The arc follows one factor, while the other one stays.
    const auto vary = [](const std::vector<double> &list) {
      return std::any_of(list.begin(), list.end(), [&](const double factor) {
        return factor != list[0];
      });
    };
    if (load_path.arc && !factors.empty() && !others.empty() && vary(factors) &&
        vary(others))
      table.reject("Load path/Arc",
                   "is for one factor: that of the loads, or of prescribed "
                   "displacements, has to stay the same",
                   {"Load path/Factors", "Load path/Displacement factors"});
    if (load_path.arc && factors.empty())
      table.reject("Load path/Arc", "the scene has no load path");
    // What is loaded has a name for the dead loads: that of its boundary, or
    // one of two words. Names with commas are put together as in other lists.
    std::set<std::string> loaded;
    if (!loads.body_force.empty())
      loaded.insert("body force");
    if (!loads.temperature_change.empty())
      loaded.insert("temperature change");
    for (const SurfaceLoad &load : loads.on_boundaries())
      loaded.insert(load.boundary);
    const std::string dead_loads = "Load path/Dead loads";
    join_names(table.get(dead_loads), loaded, load_path.dead_loads);
    for (const std::string &name : load_path.dead_loads)
      if (loaded.count(name) == 0)
        table.reject(dead_loads,
                     "the scene has no load " + name +
                       (loaded.empty() ?
                          "" :
                          ", but " +
                            join({loaded.begin(), loaded.end()}, ", ")));
    // Factors that multiply nothing would give the same state again and again.
    if (vary(factors) && (supports.displacements.empty() || !others.empty()) &&
        std::includes(load_path.dead_loads.begin(),
                      load_path.dead_loads.end(),
                      loaded.begin(),
                      loaded.end()))
      table.reject("Load path/Factors",
                   "they multiply nothing: there is no load but dead ones, and "
                   "no prescribed displacement without factors of its own");
  }



  bool
  LoadPathParameters::moves_only() const
  {
    // If so, messages and results name the factor of the displacements.
    return !displacement_factors.empty() &&
           std::count(factors.begin(), factors.end(), factors[0]) ==
             static_cast<long>(factors.size());
  }



  std::string
  LoadPathParameters::name(const LoadFactors &at_step) const
  {
    const bool moves = moves_only();
    return words(moves ? "displacement factor " : "factor ",
                 varying(at_step),
                 moves || displacement_factors.empty() ?
                   "" :
                   words(", displacement factor ", at_step.displacements));
  }
} // namespace Debond
