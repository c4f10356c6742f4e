// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/instantiate.h>
#include <debond/base/processes.h>
#include <debond/output/matrices.h>
#include <debond/output/tables.h>
#include <debond/solve/minimum/displacement.h>

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
    write_iterations(const Solution &result, const std::string &path)
    {
      const std::optional<double> found =
        result.is_replaced ? std::make_optional(result.functional) :
                             std::nullopt;
      if (result.majorise_history.empty())
        write_history(result.bundle_history, found, path);
      else
        write_history(result.majorise_history, found, path);
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
      files.push_back({name,
                       [&, name]() {
                         return output.body_vtu && result.has_displacement() &&
                                name == joined_file("body.vtu", scene.ranks());
                       },
                       [&](const std::string &path) {
                         write_body_vtu(scene.problem(),
                                        result.solution.u,
                                        path,
                                        result.solution.load_factor,
                                        result.estimate ? &*result.estimate :
                                                          nullptr,
                                        result.cell_fields);
                       }});
    const std::vector<OutputFile> others = {
      {"contact.vtu",
       [&]() { return output.contact_vtu && result.has_displacement(); },
       [&](const std::string &path) {
         write_contact_vtu(scene.contact_boundary(),
                           result.verification,
                           path,
                           result.face_fields);
       }},
      {"contact_profile.csv",
       [&]() { return output.contact_profile && result.has_displacement(); },
       [&](const std::string &path) {
         write_contact_profile(scene.contact_boundary(),
                               result.verification,
                               path);
       }},
      {"history.csv",
       [&]() { return output.history; },
       [&](const std::string &path) {
         write_iterations(result.solution, path);
       }},
      {"displacement.txt",
       [&]() { return output.displacement && result.has_displacement(); },
       [&](const std::string &path) {
         write_displacement(scene.problem().unknowns(),
                            result.solution.u,
                            path);
       }},
      {"proof.csv",
       [&]() {
         return output.history &&
                !result.solution.minimum.proof_history.empty();
       },
       [&](const std::string &path) {
         write_history(result.solution.minimum.proof_history, path);
       }}};
    files.insert(files.end(), others.begin(), others.end());
    return files;
  }



  DEBOND_INSTANTIATE(output_files);
} // namespace Debond
