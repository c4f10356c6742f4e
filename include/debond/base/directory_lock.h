// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_directory_lock_h
#define debond_base_directory_lock_h

#include <boost/interprocess/sync/file_lock.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace Debond
{
  /**
   * Keeps other processes from writing into a directory, by a lock on its file
   * `.lock`, which says who holds it. The file is removed at the end; if the
   * process is killed it stays, but the system has taken the lock off it, so
   * that the next process takes it over. A process does not exclude itself.
   */
  class DirectoryLock
  {
  public:
    /// Creates the directory. Throws std::runtime_error, naming it and the
    /// process, if another one holds the lock, or with the reason if the
    /// directory or the file cannot be written.
    explicit DirectoryLock(const std::string &directory);

    ~DirectoryLock();

    DirectoryLock(const DirectoryLock &) = delete;

    /// Takes back what the constructor did: the file, and the directories that
    /// it created, if nothing is in them.
    void
    withdraw();

  private:
    std::string file_name;

    /// The innermost one first.
    std::vector<std::string> created;

    boost::interprocess::file_lock lock;
    std::ofstream                  holder;
  };
} // namespace Debond

#endif
