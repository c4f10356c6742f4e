// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/processes.h>
#include <debond/output/matrices.h>
#include <debond/output/output_files.h>
#include <debond/output/tables.h>
#include <debond/output/vtu.h>
#include <debond/solve/displacement.h>

#include <algorithm>
#include <filesystem>

namespace Debond
{
  void
  remove_files(const std::vector<OutputFile> &files,
               const std::string             &directory)
  {
    if (!is_first_rank())
      return;
    for (const OutputFile &file : files)
      {
        const auto      path = std::filesystem::path(directory) / file.name;
        std::error_code error;
        if (std::filesystem::is_regular_file(path, error))
          std::filesystem::remove(path, error);
      }
  }



  std::vector<std::string>
  write_files(const std::vector<OutputFile> &files,
              const std::string             &directory)
  {
    std::vector<std::string> written;
    for (const OutputFile &file : files)
      if (file.is_wanted())
        {
          written.push_back(
            (std::filesystem::path(directory) / file.name).string());
          file.write(written.back());
        }
    return written;
  }



  namespace
  {
    void
    write_iterations(const SolveResult &result, const std::string &path)
    {
      const std::optional<double> found =
        result.is_replaced ? std::make_optional(result.functional) :
                             std::nullopt;
      if (result.majorise_history.empty())
        write_history(result.bundle_history, found, path);
      else
        write_history(result.majorise_history, found, path);
    }



    /// Of a certificate with stresses of the same mesh: the mean equilibrated
    /// stress and the gap per area or volume.
    template <int dim>
    std::vector<CellField>
    fields_of_cells(const Scene<dim>                 &scene,
                    const std::optional<Certificate> &certificate)
    {
      if (!certificate || certificate->gaps.empty())
        return {};
      std::vector<CellField>               fields;
      std::vector<dealii::TableIndices<2>> components;
      for (unsigned int k = 0;
           k < dealii::SymmetricTensor<2, dim>::n_independent_components;
           ++k)
        {
          const auto indices =
            dealii::SymmetricTensor<2, dim>::unrolled_to_component_indices(k);
          components.push_back(indices);
          fields.push_back({std::string("equilibrated_stress_") +
                              "xyz"[indices[0]] + "xyz" [indices[1]],
                            {}});
        }
      fields.push_back({"gap_density", {}});
      for (const auto &cell :
           scene.problem().unknowns().dof_handler().active_cell_iterators())
        {
          const auto &stress = certificate->stresses[cell->active_cell_index()];
          for (unsigned int k = 0; k < components.size(); ++k)
            fields[k].second.push_back(stress[components[k]]);
          fields.back().second.push_back(
            certificate->gaps[cell->active_cell_index()] / cell->measure());
        }
      return fields;
    }



    /// Where a certificate has the state of bonds: the number of the law's
    /// branch on which each face is in all minima, -1 where that is not known.
    template <int dim>
    std::vector<CellField>
    fields_of_faces(const Scene<dim>                 &scene,
                    const std::optional<Certificate> &certificate)
    {
      if (!certificate || certificate->sides.empty())
        return {};
      CellField field = {"certain_branch", {}};
      if constexpr (dim == 2)
        for (const auto &face : scene.contact_boundary().faces)
          {
            const dealii::Point<2> middle =
              0.5 * (face.vertices[0] + face.vertices[1]);
            const auto side =
              std::find_if(certificate->sides.begin(),
                           certificate->sides.end(),
                           [&](const CertifiedSide &other) {
                             const auto &[a, b] = other.ends;
                             return a.distance(middle) + middle.distance(b) <=
                                    (1. + 1e-9) * a.distance(b);
                           });
            field.second.push_back(
              side == certificate->sides.end() || !side->piece ? -1. :
                                                                 *side->piece);
          }
      return {field};
    }
  } // namespace



  template <int dim>
  std::vector<OutputFile>
  output_files(const OutputParameters &output,
               const Scene<dim>       &scene,
               const RunResult<dim>   &result)
  {
    std::vector<OutputFile> files = matrix_files(scene, output.matrices);
    // One or the other.
    for (const std::string name : {"body.vtu", "body.pvtu"})
      files.push_back(
        {name,
         [&, name]() {
           return output.body_vtu && result.has_displacement() &&
                  name == joined_file("body.vtu", scene.ranks());
         },
         [&](const std::string &path) {
           write_body_vtu(scene.problem(),
                          result.solve.u,
                          path,
                          result.solve.load_factor,
                          result.estimate ? &*result.estimate : nullptr,
                          fields_of_cells(scene, result.certificate));
         }});
    const std::vector<OutputFile> others = {
      {"contact.vtu",
       [&]() { return output.contact_vtu && result.has_displacement(); },
       [&](const std::string &path) {
         write_contact_vtu(scene.contact_boundary(),
                           result.verification,
                           path,
                           fields_of_faces(scene, result.certificate));
       }},
      {"contact_profile.csv",
       [&]() { return output.contact_profile && result.has_displacement(); },
       [&](const std::string &path) {
         write_contact_profile(scene.contact_boundary(),
                               result.verification,
                               path);
       }},
      {"certified_sides.csv",
       [&]() {
         return output.contact_profile && result.certificate &&
                !result.certificate->sides.empty();
       },
       [&](const std::string &path) {
         write_certified_sides(*result.certificate, scene.law(), path);
       }},
      {"history.csv",
       [&]() { return output.history; },
       [&](const std::string &path) { write_iterations(result.solve, path); }},
      {"displacement.txt",
       [&]() { return output.displacement && result.has_displacement(); },
       [&](const std::string &path) {
         write_displacement(scene.problem().unknowns(), result.solve.u, path);
       }},
      {"proof.csv",
       [&]() {
         return output.history && !result.solve.minimum.proof_history.empty();
       },
       [&](const std::string &path) {
         write_history(result.solve.minimum.proof_history, path);
       }}};
    files.insert(files.end(), others.begin(), others.end());
    return files;
  }



  template decltype(output_files<2>) output_files<2>;
  template decltype(output_files<3>) output_files<3>;
} // namespace Debond
