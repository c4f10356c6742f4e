// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/solve/displacement.h>

#include <limits>
#include <stdexcept>

namespace Debond
{
  void
  write_displacement(const DofVector &u, const std::string &file_name)
  {
    write_atomically(file_name, [&u](std::ostream &out) {
      out.precision(std::numeric_limits<double>::max_digits10);
      for (const double value : u)
        out << value << '\n';
    });
  }



  DofVector
  read_displacement(const std::string &file_name, const unsigned int n_dofs)
  {
    std::ifstream file = open_plain_file(file_name);
    DofVector     u(n_dofs);
    for (double &value : u)
      file >> value;
    if (!file || !(file >> std::ws).eof())
      throw std::invalid_argument(
        file_name + " is not the displacement of a scene with " +
        std::to_string(n_dofs) + " degrees of freedom");
    return u;
  }
} // namespace Debond
