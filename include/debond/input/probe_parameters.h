// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_probe_parameters_h
#define debond_input_probe_parameters_h

#include <debond/base/parameter_table.h>
#include <debond/elasticity/probes.h>

namespace Debond
{
  /// Binds the section Probes: texts by name.
  void
  bind_probes(std::map<std::string, std::string> &probes,
              ParameterTable                     &table);

  /// Leaves what is wrong in the table as an error.
  void
  check_probes(const std::map<std::string, std::string> &probes,
               const unsigned int                        dimension,
               const std::set<std::string>              &boundaries,
               const std::set<std::string>              &regions,
               ParameterTable                           &table);

  /// Makes the probes of texts that have been checked.
  template <int dim>
  std::vector<Probe<dim>>
  make_probes(const std::map<std::string, std::string> &probes);
} // namespace Debond

#endif
