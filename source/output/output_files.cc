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
    // A folder or a pipe with the name of a file is not removed. That a file
    // could not be removed is no error here: to write it fails with the
    // system's reason, if it is written at all.
    if (!is_first_rank())
      return;
    const auto remove = [&directory](const std::string &name) {
      const auto      path = std::filesystem::path(directory) / name;
      std::error_code error;
      return std::filesystem::is_regular_file(path, error) &&
             std::filesystem::remove(path, error);
    };
    for (const OutputFile &file : files)
      {
        remove(file.name);
        // An earlier run may have had more ranks, each with a piece.
        if (std::filesystem::path(file.name).extension() == ".pvtu")
          for (unsigned int rank = 0; remove(piece_file(file.name, rank));)
            ++rank;
      }
  }



  void
  write_files(const std::vector<OutputFile> &files,
              const std::string             &directory,
              std::vector<std::string>      &written)
  {
    // The files come in the order of the list, each of them whole or not at
    // all. All ranks decide alike which ones are wanted, since each file is
    // written by all of them together.
    for (const OutputFile &file : files)
      if (file.is_wanted())
        {
          const std::string path =
            (std::filesystem::path(directory) / file.name).string();
          file.write(path);
          written.push_back(path);
        }
  }



  namespace
  {
    void
    write_iterations(const Solution &result, const std::string &path)
    {
      // The history ends with the state that the method led to. If search or
      // proof replaced it, one more row has J of the state that counts. Of the
      // two histories one is filled, by the kind of the method.
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
    // A file is listed once, for a run that removes it before the solve and
    // writes it afterwards. The functions keep references, so that the same
    // list can be made before there is a result. Most files need a
    // displacement, which there is none of if the body detaches at once.
    std::vector<OutputFile> files =
      matrix_files(output.matrices, scene, result.solution);
    // One rank writes body.vtu, several the pieces and body.pvtu. Both are in
    // the list, so that the other one does not remain of an earlier run with
    // another number of ranks.
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
