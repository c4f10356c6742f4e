// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_output_parameters_h
#define debond_input_output_parameters_h

#include <debond/base/parameter_table.h>

namespace Debond
{
  struct OutputParameters
  {
    std::string directory        = "output/{scene}";
    bool        body_vtu         = true;
    bool        contact_vtu      = true;
    bool        contact_profile  = true;
    bool        history          = true;
    bool        displacement     = false;
    bool        matrices         = false;
    bool        proof            = false;
    bool        path_body_vtu    = false;
    bool        path_contact_vtu = true;
    bool        machine_details  = true;
  };

  /// Binds the section Output.
  void
  bind_output(OutputParameters &output, ParameterTable &table);

  /// Puts the name of the @p scene for {scene} into the directory, in the table
  /// as well: the effective scene names the directory itself, so that a second
  /// run of it does not write elsewhere.
  void
  complete_output(const std::string &scene,
                  OutputParameters  &output,
                  ParameterTable    &table);
} // namespace Debond

#endif
