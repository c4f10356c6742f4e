// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_path_path_table_h
#define debond_solve_path_path_table_h

#include <debond/solve/path/load_path_steps.h>

#include <iomanip>
#include <iostream>

namespace Debond
{
  /// The table of a path in the log: the factors that vary, J, a number and
  /// the state.
  class PathTable
  {
  public:
    /// Keeps both; null is for no log.
    PathTable(const LoadPathParameters &parameters, std::ostream *const out)
      : parameters(parameters)
      , out(out)
    {}

    void
    titles(const std::string &number) const
    {
      if (out == nullptr)
        return;
      factors<const char *>("factor", "displacement factor");
      *out << std::setw(17) << "J" << std::setw(14) << number << "  state"
           << std::endl;
    }

    void
    row(const LoadFactors &of_row,
        const double       functional,
        const double       number,
        const std::string &word) const
    {
      if (out == nullptr)
        return;
      factors(of_row.loads, of_row.displacements);
      *out << std::scientific << std::setprecision(8) << std::setw(17)
           << functional << std::defaultfloat << std::setprecision(3)
           << std::setw(14) << number << std::setprecision(6) << "  " << word
           << std::endl;
    }

    template <int dim>
    void
    row(const LoadPathStep<dim> &step) const
    {
      row(step.factors(),
          step.state.functional,
          step.state.broken_part,
          step.state.minimum.empty() ? step.status : step.state.minimum);
    }

    /// A row without numbers.
    void
    row(const LoadFactors &of_row, const std::string &word) const
    {
      if (out == nullptr)
        return;
      factors(of_row.loads, of_row.displacements);
      *out << std::setw(17) << "" << std::setw(14) << ""
           << "  " << word << std::endl;
    }

    void
    section(const std::string &name) const
    {
      if (out != nullptr)
        *out << "  " << name << '\n';
    }

  private:
    /// Those that vary, or their titles.
    template <typename Entry>
    void
    factors(const Entry &of_loads, const Entry &of_displacements) const
    {
      if (!parameters.moves_only())
        *out << std::setw(11) << of_loads;
      if (!parameters.displacement_factors.empty())
        *out << std::setw(21) << of_displacements;
    }

    const LoadPathParameters &parameters;
    std::ostream *const       out;
  };
} // namespace Debond

#endif
