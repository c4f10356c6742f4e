// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    [[noreturn]] void
    fail(const std::string &file_name)
    {
      const std::string reason =
        errno != 0 ? std::strerror(errno) : "the output failed";
      throw std::runtime_error("Cannot write " + file_name + ": " + reason);
    }



    /// Removes a file at the end of its life, unless told to keep it.
    struct Remover
    {
      std::string file_name;
      bool        keep = false;

      ~Remover()
      {
        if (!keep)
          std::remove(file_name.c_str());
      }
    };
  } // namespace



  void
  write_atomically(const std::string                         &file_name,
                   const std::function<void(std::ostream &)> &write)
  {
    const std::string partial = file_name + ".partial";

    errno = 0;
    std::ofstream out(partial, std::ios::binary);
    if (!out)
      fail(file_name);

    Remover remover = {partial};
    try
      {
        write(out);
      }
    catch (...)
      {
        // deal.II throws on its own if its stream fails, and knows no reason.
        if (!out)
          fail(file_name);
        throw;
      }
    out.close();
    if (!out)
      fail(file_name);

    if (std::rename(partial.c_str(), file_name.c_str()) != 0)
      fail(file_name);
    remover.keep = true;
  }
} // namespace Debond
