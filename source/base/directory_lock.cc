// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/utilities.h>

#include <debond/base/atomic_file.h>
#include <debond/base/directory_lock.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    using boost::interprocess::interprocess_exception;

    /// The file of the latest lock of this process, as long as it exists.
    std::string name_of_lock;



    /// Creates a file that boost can open by its name: a link is not followed.
    void
    create_plain_file(const std::string &file_name)
    {
      // boost's lock opens a file by its name and cannot be told how, so that
      // the checks come before it. O_NOFOLLOW refuses a link, O_NONBLOCK does
      // not wait at a pipe, and a second hard link would be a file elsewhere
      // into which the name of this process is written.
      const int descriptor =
        open(file_name.c_str(),
             O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK,
             0666);
      const std::string reason = descriptor < 0 ? std::strerror(errno) :
                                                  "it is no plain file, or has "
                                                  "another name";
      std::error_code   error;
      const bool        is_plain =
        std::filesystem::is_regular_file(file_name, error) &&
        std::filesystem::hard_link_count(file_name, error) == 1;
      close(descriptor);
      if (descriptor < 0 || !is_plain)
        throw std::runtime_error("Cannot write " + file_name + ": " + reason);
    }
  } // namespace



  DirectoryLock::DirectoryLock(const std::string &directory)
    : file_name((std::filesystem::path(directory) / ".lock").string())
  {
    // The directories that do not exist yet are noted before they are created,
    // the innermost one first. withdraw() removes these and no others.
    std::error_code error;
    for (std::filesystem::path path(directory);
         path.has_relative_path() && !std::filesystem::exists(path, error);
         path = path.parent_path())
      created.push_back(path.string());
    std::filesystem::create_directories(directory, error);
    if (error)
      throw std::runtime_error("cannot create the output directory " +
                               directory + ": " + error.message());

    bool is_refused = false;
    try
      {
        // The process that held the lock before may remove the file between the
        // two steps below. The lock taken then is that of a file without a
        // name, which excludes nobody, and the loop begins again with a new
        // file.
        do
          {
            create_plain_file(file_name);
            lock       = boost::interprocess::file_lock(file_name.c_str());
            is_refused = !lock.try_lock();
          }
        while (!is_refused && !std::filesystem::exists(file_name, error));
      }
    catch (const interprocess_exception &)
      {
        // A file system without locks is no reason not to run.
      }
    if (is_refused)
      {
        // The holder has written who it is into the file that it locks, and a
        // lock of this kind does not keep others from reading it.
        std::ifstream file = open_plain_file(file_name);
        std::string   other;
        std::getline(file, other);
        throw std::runtime_error(
          directory + " is being written by " +
          (other.empty() ? "another process" : other) +
          "; wait for its end, or give another Output/Directory");
      }

    // The line is for the message above alone. The system drops all locks that
    // a process has on a file when that process closes any descriptor of it,
    // therefore this stream stays open as long as the lock is held.
    holder.open(file_name);
    holder << "process " << getpid() << " on "
           << dealii::Utilities::System::get_hostname() << std::endl;
    // An interruption ends the program by std::quick_exit(), which calls no
    // destructor. The handler takes no arguments, so that the name stands in a
    // variable of the file.
    name_of_lock = file_name;
    std::at_quick_exit([]() { unlink(name_of_lock.c_str()); });
  }



  DirectoryLock::~DirectoryLock()
  {
    name_of_lock.clear();
    unlink(file_name.c_str());
  }



  void
  DirectoryLock::withdraw()
  {
    unlink(file_name.c_str());
    file_name.clear();
    // remove() fails on a directory that is not empty, which is wanted: what
    // another program has put there stays.
    std::error_code not_empty;
    for (const std::string &directory : created)
      std::filesystem::remove(directory, not_empty);
  }
} // namespace Debond
