// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_input_certificate_parameters_h
#define debond_input_certificate_parameters_h

namespace Debond
{
  class ParameterTable;

  /// What is to be certified.
  enum class CertificateKind
  {
    none,
    fixed_state,
    global
  };

  struct CertificateParameters
  {
    CertificateKind kind = CertificateKind::none;
  };

  /// The section Certificate.
  void
  bind_certificate(CertificateParameters &certificate, ParameterTable &table);
} // namespace Debond

#endif
