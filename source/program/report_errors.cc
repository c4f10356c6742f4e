// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/text.h>
#include <debond/input/bad_input.h>
#include <debond/program/report_errors.h>

#include <exception>
#include <iostream>
#include <new>

namespace Debond
{
  ExitCode
  report_errors(const std::string               &name,
                const std::function<ExitCode()> &action)
  {
    try
      {
        return action();
      }
    catch (const BadInput &error)
      {
        for (const std::string &line : error.lines)
          print_error(line, name);
        return ExitCode::bad_input;
      }
    catch (const std::bad_alloc &)
      {
        print_error("there is not enough memory for this scene; try fewer "
                    "cells or a smaller bundle",
                    name);
        return ExitCode::bad_input;
      }
    catch (const std::exception &error)
      {
        std::cerr << name << ": internal error: " << error.what() << std::endl;
        return ExitCode::internal_error;
      }
  }
} // namespace Debond
