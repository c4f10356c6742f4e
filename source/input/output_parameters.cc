// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/input/output_parameters.h>

#include <filesystem>

namespace Debond
{
  void
  bind_output(OutputParameters &output, ParameterTable &table)
  {
    table.bind(
      "Output/Directory",
      output.directory,
      Pattern("a path",
              [](const std::string &value) { return !value.empty(); }),
      "Where files are written, relative to the working directory; created if missing. {scene} stands for the name of the scene file without its ending");
    const auto bind_switch = [&table](const std::string &name,
                                      bool              &variable,
                                      const std::string &documentation) {
      table.bind("Output/" + name, variable, documentation);
    };
    bind_switch("Body VTU", output.body_vtu, "Write body.vtu, for ParaView");
    bind_switch("Contact VTU",
                output.contact_vtu,
                "Write contact.vtu, for ParaView");
    bind_switch("Contact profile",
                output.contact_profile,
                "Write contact_profile.csv, a row for each contact node");
    bind_switch("History",
                output.history,
                "Write history.csv, a row for each iteration");
    bind_switch(
      "Displacement",
      output.displacement,
      "Write displacement.txt, all degrees of freedom, from which another run can start");
    bind_switch(
      "Matrices",
      output.matrices,
      "Write A, f, the condensed S and g, weights and bounds as Matrix Market files (*.mtx), for other programs");
    bind_switch(
      "Proof",
      output.proof,
      "Write what Solver/Prove has proved, S.mtx, problem.json and proof.json, which scripts/check_proof checks, and certificate_proof.json of a global certificate for scripts/check_certificate");
    bind_switch(
      "Load path contact VTU",
      output.path_contact_vtu,
      "Write load_path_contact.pvd, the contact boundary at each factor, for ParaView");
    bind_switch(
      "Load path body VTU",
      output.path_body_vtu,
      "Write load_path_body.pvd, the body at each factor, for ParaView");
    bind_switch(
      "Machine details",
      output.machine_details,
      "Whether the log has what differs between machines: revision, times, paths, progress, numbers of iterations and figures that only rounding and the stop tolerance decide. Without them logs can be compared");
  }



  void
  complete_output(const std::string &scene,
                  OutputParameters  &output,
                  ParameterTable    &table)
  {
    // The search continues behind the name that was put in, which may contain
    // the placeholder itself.
    const std::string placeholder = "{scene}";
    const std::string name = std::filesystem::path(scene).stem().string();
    for (std::size_t at = output.directory.find(placeholder);
         at != std::string::npos;
         at = output.directory.find(placeholder, at + name.size()))
      output.directory.replace(at, placeholder.size(), name);
    // These characters are for a shell, which has not seen the entry. A folder
    // whose name is a variable would be made.
    if (output.directory.find_first_of("~$\"{") != std::string::npos)
      table.reject(
        "Output/Directory",
        "has no ~, $VARIABLE or quotes, and {scene} as the only name");
    table.derive("Output/Directory", output.directory, "Output/Directory");
  }
} // namespace Debond
