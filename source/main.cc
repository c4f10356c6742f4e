// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/certify/certificate_companion.h>
#include <debond/program/command_line.h>

#include <csignal>

int
main(int argc, char *argv[])
{
  // A file beyond the limit of the shell is then an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  return static_cast<int>(Debond::execute_command_line(
    argc, argv, Debond::make_certificate_companion));
}
