// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/output/output_file.h>

#include <filesystem>

namespace Debond
{
  void
  remove_files(const std::vector<OutputFile> &files,
               const std::string             &directory)
  {
    for (const OutputFile &file : files)
      for (const std::string &name : file.names)
        {
          const auto      path = std::filesystem::path(directory) / name;
          std::error_code error;
          if (std::filesystem::is_regular_file(path, error))
            std::filesystem::remove(path, error);
        }
  }



  std::vector<std::string>
  write_files(const std::vector<OutputFile> &files,
              const std::string             &directory)
  {
    std::vector<std::string> written;
    for (const OutputFile &file : files)
      {
        if (!file.is_wanted())
          continue;
        const std::filesystem::path folder = directory;
        file.write((folder / file.names.front()).string());
        // Some are not written if others cannot be made, such as pictures.
        for (const std::string &name : file.names)
          if (std::filesystem::exists(folder / name))
            written.push_back((folder / name).string());
      }
    return written;
  }
} // namespace Debond
