// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/processes.h>
#include <debond/base/ranks.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

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
  } // namespace



  std::ifstream
  open_plain_file(const std::string &file_name)
  {
    std::error_code unreadable;
    return std::ifstream(
      std::filesystem::is_regular_file(file_name, unreadable) ? file_name : "",
      std::ios::binary);
  }



  void
  write_atomically(const std::string                         &file_name,
                   const std::function<void(std::ostream &)> &write)
  {
    on_all_ranks(MPI_COMM_WORLD, [&]() {
      if (is_first_rank())
        write_own_file(file_name, write);
    });
  }



  void
  write_own_file(const std::string                         &file_name,
                 const std::function<void(std::ostream &)> &write)
  {
    const std::string partial = file_name + ".partial";

    // In place of what has the name, such as a link or a pipe.
    unlink(partial.c_str());
    const int descriptor =
      open(partial.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0)
      fail(partial);
    close(descriptor);
    errno = 0;
    std::ofstream out(partial, std::ios::binary);

    try
      {
        write(out);
        out.close();
        if (out && std::rename(partial.c_str(), file_name.c_str()) == 0)
          return;
      }
    catch (...)
      {
        // deal.II throws on its own if its stream fails, and knows no reason.
        if (out)
          {
            unlink(partial.c_str());
            throw;
          }
      }
    const int reason = errno;
    unlink(partial.c_str());
    errno = reason;
    fail(file_name);
  }
} // namespace Debond
