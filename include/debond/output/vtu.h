// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_vtu_h
#define debond_output_vtu_h

#include <debond/check/error_estimate.h>
#include <debond/check/verification.h>

namespace Debond
{
  /// A name and a number for each cell, in the order of the active ones, or for
  /// each face of the contact boundary.
  using CellField = std::pair<std::string, std::vector<double>>;



  /**
   * Writes the body as VTU: displacement (vector, nodal; warp by it), and as
   * cell data, where P1 elements have them, stress components (with stress_zz
   * in plane strain), von Mises stress, strain-energy density, if
   * @p estimate is not null the estimated error of J per volume, and @p more.
   * To be called by all ranks: of several each one writes its own cells as
   * *.rankN.vtu, and the first one *.pvtu, which joins them. Throws
   * std::runtime_error naming the file if it cannot be written.
   */
  template <int dim>
  void
  write_body_vtu(const ElasticProblem<dim>    &problem,
                 const DofVector              &u,
                 const std::string            &file_name,
                 const LoadFactors             factors  = 1.,
                 const ErrorEstimate          *estimate = nullptr,
                 const std::vector<CellField> &more     = {});

  /// The file that shows all, of one called @p file_name.
  std::string
  joined_file(const std::string &file_name, const MPI_Comm ranks);

  /// The file with the cells of a rank, of several.
  std::string
  piece_file(const std::string &file_name, const unsigned int rank);

  /**
   * Writes the contact boundary as VTU, with the fields that
   * doc/reference/output.md has. A face is cut into the shares of its vertices,
   * which are the cells of the file, with bond_state and @p more of the faces
   * as cell data.
   */
  template <int dim>
  void
  write_contact_vtu(const ContactBoundary<dim>   &boundary,
                    const Verification<dim>      &verification,
                    const std::string            &file_name,
                    const std::vector<CellField> &more = {});
} // namespace Debond

#endif
