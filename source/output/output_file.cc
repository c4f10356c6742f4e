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
      {
        const auto      path = std::filesystem::path(directory) / file.name;
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
      if (file.is_wanted())
        {
          written.push_back(
            (std::filesystem::path(directory) / file.name).string());
          file.write(written.back());
        }
    return written;
  }
} // namespace Debond
