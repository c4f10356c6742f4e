// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/instantiate.h>
#include <debond/solve/minimum/displacement.h>

namespace Debond
{
  template <int dim>
  DofVector
  in_serial_order(const ElasticUnknowns<dim> &unknowns, const DofVector &u)
  {
    const auto order = unknowns.serial_order();
    DofVector  result(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      result(order[i]) = u(i);
    return result;
  }



  template <int dim>
  DofVector
  from_serial_order(const ElasticUnknowns<dim> &unknowns, const DofVector &u)
  {
    const auto order = unknowns.serial_order();
    DofVector  result(u.size());
    for (unsigned int i = 0; i < u.size(); ++i)
      result(i) = u(order[i]);
    return result;
  }



  template <int dim>
  void
  write_displacement(const ElasticUnknowns<dim> &unknowns,
                     const DofVector            &u,
                     const std::string          &file_name)
  {
    // The order of one rank makes the file the same for any number of ranks, so
    // that a run may start from one that had others.
    const DofVector in_order = in_serial_order(unknowns, u);
    write_atomically(file_name, [&in_order](std::ostream &out) {
      // With so many digits the numbers that are read are the same to the last
      // bit.
      out.precision(std::numeric_limits<double>::max_digits10);
      for (const double value : in_order)
        out << value << '\n';
    });
  }



  template <int dim>
  DofVector
  read_displacement(const std::string          &file_name,
                    const ElasticUnknowns<dim> &unknowns)
  {
    // Each rank reads the whole file, since it has the vector of all unknowns.
    // There has to be a number for each of them and nothing else, which tells
    // most files of other scenes.
    const unsigned int n_dofs = unknowns.n_dofs();
    std::ifstream      file   = open_plain_file(file_name);
    DofVector          u(n_dofs);
    for (double &value : u)
      file >> value;
    if (!file || !(file >> std::ws).eof())
      throw std::invalid_argument(
        file_name + " is not the displacement of a scene with " +
        std::to_string(n_dofs) + " degrees of freedom");
    return from_serial_order(unknowns, u);
  }



  DEBOND_INSTANTIATE(in_serial_order);
  DEBOND_INSTANTIATE(from_serial_order);
  DEBOND_INSTANTIATE(write_displacement);
  DEBOND_INSTANTIATE(read_displacement);
} // namespace Debond
