// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_solve_minimum_displacement_h
#define debond_solve_minimum_displacement_h

#include <debond/elasticity/unknowns.h>

namespace Debond
{
  /// The entries by the numbers that degrees of freedom have on one rank, and
  /// back. To be called by all ranks.
  template <int dim>
  DofVector
  in_serial_order(const ElasticUnknowns<dim> &unknowns, const DofVector &u);

  template <int dim>
  DofVector
  from_serial_order(const ElasticUnknowns<dim> &unknowns, const DofVector &u);

  /// Writes all degrees of freedom as text, a line each, with all digits, in
  /// the order that they have on one rank. Throws std::runtime_error naming the
  /// file if it cannot be written.
  template <int dim>
  void
  write_displacement(const ElasticUnknowns<dim> &unknowns,
                     const DofVector            &u,
                     const std::string          &file_name);

  /// Reads what write_displacement() wrote. Throws std::invalid_argument
  /// naming the file if it has not a number for each of the unknowns and
  /// nothing else.
  template <int dim>
  DofVector
  read_displacement(const std::string          &file_name,
                    const ElasticUnknowns<dim> &unknowns);
} // namespace Debond

#endif
