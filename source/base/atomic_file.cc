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
      // The system's reason is in errno, which is set to zero before the
      // output. A stream that fails for a reason of its own leaves it there.
      const std::string reason =
        errno != 0 ? std::strerror(errno) : "the output failed";
      throw std::runtime_error("Cannot write " + file_name + ": " + reason);
    }
  } // namespace



  std::ifstream
  open_plain_file(const std::string &file_name)
  {
    // A stream opened with an empty name has failed, which is how the caller
    // sees that there is no plain file. To open a pipe would wait for a writer,
    // therefore the kind of the file is asked for first.
    std::error_code unreadable;
    return std::ifstream(
      std::filesystem::is_regular_file(file_name, unreadable) ? file_name : "",
      std::ios::binary);
  }



  void
  write_atomically(const std::string                         &file_name,
                   const std::function<void(std::ostream &)> &write)
  {
    // One rank writes, but all learn whether it could: an exception on the
    // first rank alone would leave the others waiting in their next collective
    // call.
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

    // A link or a pipe may have the name of the partial file: it is removed,
    // and O_EXCL makes sure that what is opened then is a new plain file. The
    // stream opens that file once more by its name, since it takes no
    // descriptor, and errno is zero before it so that a reason found at the end
    // is one of the output.
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
        // The file is complete only after close() has written the last buffer
        // without an error. rename() replaces an older file in one step, so
        // that readers find either the old contents or the new ones.
        write(out);
        out.close();
        if (out && std::rename(partial.c_str(), file_name.c_str()) == 0)
          return;
      }
    catch (...)
      {
        // If the stream is still good the exception is one of the caller's data
        // and passes through. Otherwise deal.II has noticed the failed stream
        // and thrown without a reason, and the system's reason below says more.
        if (out)
          {
            unlink(partial.c_str());
            throw;
          }
      }
    // unlink() may set errno itself, therefore the reason of the output is kept
    // across it.
    const int reason = errno;
    unlink(partial.c_str());
    errno = reason;
    fail(file_name);
  }
} // namespace Debond
