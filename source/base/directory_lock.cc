// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/directory_lock.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace Debond
{
  namespace
  {
    /// Of the latest lock of this process, as long as it exists.
    std::string name_of_lock;



    std::string
    host_name()
    {
      char name[256] = "";
      return gethostname(name, sizeof(name) - 1) == 0 ? name :
                                                        "an unknown host";
    }



    /// Whether the name still belongs to the open file.
    bool
    is_named(const int descriptor, const std::string &file_name)
    {
      struct stat opened = {}, named = {};
      return fstat(descriptor, &opened) == 0 &&
             stat(file_name.c_str(), &named) == 0 &&
             opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
    }
  } // namespace



  DirectoryLock::DirectoryLock(const std::string &directory)
    : file_name((std::filesystem::path(directory) / ".lock").string())
  {
    std::error_code error;
    for (std::filesystem::path path(directory);
         path.has_relative_path() && !std::filesystem::exists(path, error);
         path = path.parent_path())
      created.push_back(path.string());
    std::filesystem::create_directories(directory, error);
    if (error)
      throw std::runtime_error("cannot create the output directory " +
                               directory + ": " + error.message());

    // Who had it may remove the file between its opening and locking.
    while (descriptor < 0)
      {
        descriptor =
          open(file_name.c_str(),
               O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK,
               0666);
        struct stat status = {};
        if (descriptor < 0 || fstat(descriptor, &status) != 0 ||
            !S_ISREG(status.st_mode) || status.st_nlink > 1)
          {
            const std::string reason =
              descriptor < 0 ? std::strerror(errno) :
                               "it is no plain file, or has another name";
            close(descriptor);
            throw std::runtime_error("Cannot write " + file_name + ": " +
                                     reason);
          }
        const bool locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
        if (!locked && errno == EWOULDBLOCK)
          {
            close(descriptor);
            std::ifstream file = open_plain_file(file_name);
            std::string   holder;
            std::getline(file, holder);
            throw std::runtime_error(
              directory + " is being written by " +
              (holder.empty() ? "another process" : holder) +
              "; wait for its end, or give another Output/Directory");
          }
        // A file system without locks is no reason not to run.
        if (locked && !is_named(descriptor, file_name))
          {
            close(descriptor);
            descriptor = -1;
          }
      }

    // What the file says is only for the message of another process.
    if (ftruncate(descriptor, 0) == 0)
      dprintf(descriptor,
              "process %d on %s\n",
              static_cast<int>(getpid()),
              host_name().c_str());
    name_of_lock = file_name;
    std::at_quick_exit([]() { unlink(name_of_lock.c_str()); });
  }



  DirectoryLock::~DirectoryLock()
  {
    if (descriptor < 0)
      return;
    name_of_lock.clear();
    unlink(file_name.c_str());
    close(descriptor);
  }



  void
  DirectoryLock::withdraw()
  {
    if (descriptor < 0)
      return;
    unlink(file_name.c_str());
    close(descriptor);
    descriptor = -1;
    std::error_code not_empty;
    for (const std::string &directory : created)
      std::filesystem::remove(directory, not_empty);
  }
} // namespace Debond
