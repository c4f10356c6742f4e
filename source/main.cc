// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/program/command_line.h>
#include <debond/study/command_line.h>

#include <csignal>
#include <exception>
#include <iostream>

int
main(int argc, char *argv[])
{
  // A file beyond the limit of the shell is then an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try
    {
      return static_cast<int>(Debond::is_study_command_line(argc, argv) ?
                                Debond::execute_study_command_line(argc, argv) :
                                Debond::execute_command_line(argc, argv));
    }
  catch (const std::exception &error)
    {
      std::cerr << "debond: internal error: " << error.what() << std::endl;
      return static_cast<int>(Debond::ExitCode::internal_error);
    }
}
