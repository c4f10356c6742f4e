// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/parameter_table.h>
#include <debond/input/certificate_parameters.h>

namespace Debond
{
  void
  bind_certificate(CertificateParameters &certificate, ParameterTable &table)
  {
    table.bind_choice(
      "Certificate/Kind",
      certificate.kind,
      {{"none", CertificateKind::none},
       {"fixed state", CertificateKind::fixed_state},
       {"global", CertificateKind::global}},
      "An interval, with a proof, for the minimum of the continuous problem on the body of the mesh: global is for the least J (2D), fixed state for the least J with the bonds of each side of the contact boundary on the branch of the result",
      AtRestart::any);
  }
} // namespace Debond
