// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/study/columns.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    /// Short names of numbers in summary.json.
    const std::map<std::string, std::string> &
    short_names()
    {
      static const std::map<std::string, std::string> pointers = {
        {"iterations", "/iterations/total"},
        {"long", "/iterations/long"},
        {"short", "/iterations/short"},
        {"null", "/iterations/null"},
        {"unknowns", "/degrees_of_freedom"},
        {"contact nodes", "/contact_nodes"},
        {"v", "/stop_criterion"},
        {"law violation", "/law_violation"},
        {"seconds", "/timings_s/total"}};
      return pointers;
    }



    /// J after iteration k, or at the end if that was earlier.
    double
    functional_at(const CaseResult &result, const unsigned int iteration)
    {
      if (iteration == 0 || iteration >= result.history.size())
        return result.number("/functional");
      return result.history[iteration - 1];
    }



    Cell
    number_or_count(const double number)
    {
      if (number == std::round(number) && std::abs(number) < 1e9)
        return std::lround(number);
      return number;
    }
  } // namespace



  Column::Column(const std::string &title)
    : heading(title)
  {}



  Column
  Column::parse(const std::string &name)
  {
    Column column(name);
    if (name == "status")
      return column;
    if (const auto entry = short_names().find(name);
        entry != short_names().end())
      {
        column.kind    = Kind::number;
        column.pointer = entry->second;
        return column;
      }
    if (const std::size_t slash = name.find('/'); slash != std::string::npos)
      {
        column.kind    = Kind::number;
        column.pointer = name.substr(slash);
        if (const std::size_t equals = name.find('=');
            equals != std::string::npos && equals < slash)
          column.heading = dealii::Utilities::trim(name.substr(0, equals));
        return column;
      }
    const std::map<std::string, Kind> others = {{"J", Kind::functional},
                                                {"J_min", Kind::minimum},
                                                {"error", Kind::error},
                                                {"rate", Kind::rate},
                                                {"window", Kind::window}};
    const std::size_t                 at     = name.find(" at ");
    const auto                        entry  = others.find(name.substr(0, at));
    bool                              known  = entry != others.end();
    if (known)
      column.kind = entry->second;
    if (known && at != std::string::npos)
      {
        const char *const last = name.data() + name.size();
        const auto [end, problem] =
          std::from_chars(name.data() + at + 4, last, column.iteration);
        known = problem == std::errc() && end == last && column.iteration > 0 &&
                (column.kind == Kind::functional || column.kind == Kind::error);
      }
    if (!known)
      throw std::invalid_argument("there is no column '" + name +
                                  "'; known are " + documentation());
    return column;
  }



  std::string
  Column::documentation()
  {
    return "status; iterations, long, short, null: steps; J: the functional "
           "at the end; J at K: after iteration K, or at the end if that was "
           "earlier; J_min: the exact minimum of the same problem; error, "
           "error at K: (J - J_min) / |J_min|; rate: the exponent of k in the "
           "error, and window: the iterations it is fitted on; v: of the stop "
           "criterion; law violation; seconds; unknowns; contact nodes; or "
           "TITLE = /POINTER, the JSON pointer of a number in summary.json, as "
           "broken = /bond_states/broken";
  }



  Cell
  Column::value(const StudyRow &row) const
  {
    const CaseResult &result = row.result;
    if (kind == Kind::status)
      return result.status;
    if (kind == Kind::minimum)
      return row.minimum ? Cell(*row.minimum) : Cell();
    if (!result.has_results())
      return {};
    switch (kind)
      {
        case Kind::number:
          if (result.numbers.count(pointer) == 0)
            return {};
          return number_or_count(result.number(pointer));
        case Kind::functional:
          return functional_at(result, iteration);
        case Kind::error:
          return row.minimum ?
                   Cell((functional_at(result, iteration) - *row.minimum) /
                        std::abs(*row.minimum)) :
                   Cell();
        case Kind::rate:
          return row.rate ? Cell(row.rate->law.exponent) : Cell();
        case Kind::window:
          return row.rate ? Cell(std::to_string(row.rate->first) + " to " +
                                 std::to_string(row.rate->last)) :
                            Cell();
        default:
          return {};
      }
  }



  const std::string &
  Column::title() const
  {
    return heading;
  }



  unsigned int
  Column::digits() const
  {
    return kind == Kind::functional || kind == Kind::minimum ? 9 : 2;
  }



  bool
  Column::is_error() const
  {
    return kind == Kind::error;
  }



  bool
  Column::needs_minimum() const
  {
    return kind == Kind::minimum || kind == Kind::error || kind == Kind::rate ||
           kind == Kind::window;
  }



  const std::string &
  Column::json_pointer() const
  {
    return pointer;
  }
} // namespace Debond
