// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/base/checkpoint.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/crc.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/string.hpp>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace Debond
{
  template <typename Archive>
  void
  serialize(Archive &archive, CheckpointOrigin &origin, const unsigned int)
  {
    archive &origin.settings;
    archive &origin.revision;
    archive &origin.iterations;
  }



  namespace
  {
    /// To be raised with each change of what any state holds.
    constexpr unsigned int checkpoint_format = 1;

    const std::string checkpoint_title = "Debond checkpoint, format ";



    /// Length and checksum of the bytes that follow the first line.
    struct Content
    {
      std::uint64_t length   = 0;
      std::uint32_t checksum = 0;
    };



    /// The first line; as long for any content, so that it can be written
    /// again when the content is known.
    std::string
    first_line(const Content &content)
    {
      std::ostringstream line;
      line << checkpoint_title << checkpoint_format << ", " << std::setw(20)
           << content.length << " bytes, checksum " << std::setw(10)
           << content.checksum << '\n';
      return line.str();
    }



    /// Passes on what is written to it, and sums it up.
    class SummingBuffer : public std::streambuf
    {
    public:
      explicit SummingBuffer(std::streambuf &target)
        : target(target)
      {}

      Content
      content() const
      {
        return {length, sum.checksum()};
      }

    protected:
      std::streamsize
      xsputn(const char *const bytes, const std::streamsize count) override
      {
        sum.process_bytes(bytes, count);
        length += count;
        return target.sputn(bytes, count);
      }

      int_type
      overflow(const int_type character) override
      {
        const char byte = traits_type::to_char_type(character);
        return xsputn(&byte, 1) == 1 ? character : traits_type::eof();
      }

    private:
      std::streambuf    &target;
      std::uint64_t      length = 0;
      boost::crc_32_type sum;
    };



    Content
    sum_up(std::istream &rest)
    {
      Content                    content;
      boost::crc_32_type         sum;
      std::array<char, 1U << 16> block;
      while (rest.read(block.data(), block.size()) || rest.gcount() > 0)
        {
          sum.process_bytes(block.data(), rest.gcount());
          content.length += rest.gcount();
        }
      content.checksum = sum.checksum();
      return content;
    }



    [[noreturn]] void
    refuse(const std::string &file_name, const std::string &reason)
    {
      throw std::invalid_argument("the checkpoint " + file_name + " " + reason);
    }



    /// Leaves the stream behind the first line of a whole file.
    void
    check_whole(const std::string &file_name, std::istream &file)
    {
      std::string line;
      std::getline(file, line);
      if (line.compare(0, checkpoint_title.size(), checkpoint_title) != 0)
        refuse(file_name, "is no checkpoint of Debond, or is damaged");

      std::istringstream words(line.substr(checkpoint_title.size()));
      unsigned int       format = 0;
      Content            stated;
      std::string        word;
      words >> format;
      if (format != checkpoint_format)
        refuse(file_name,
               "has format " + std::to_string(format) +
                 ", this program reads format " +
                 std::to_string(checkpoint_format));
      words >> word >> stated.length >> word >> word >> stated.checksum;

      const Content found = sum_up(file);
      if (!words || found.length != stated.length)
        refuse(file_name,
               "is truncated: it has " + std::to_string(found.length) + " of " +
                 std::to_string(stated.length) + " bytes");
      if (found.checksum != stated.checksum)
        refuse(file_name, "is damaged: its checksum is wrong");
      file.clear();
      file.seekg(line.size() + 1);
    }
  } // namespace



  void
  write_checkpoint(const std::string                              &file_name,
                   const CheckpointOrigin                         &origin,
                   const std::function<void(OutArchive &archive)> &save)
  {
    write_atomically(file_name, [&](std::ostream &file) {
      file << first_line(Content());
      SummingBuffer buffer(*file.rdbuf());
      try
        {
          OutArchive archive(buffer);
          archive << origin;
          save(archive);
        }
      catch (const boost::archive::archive_exception &)
        {
          // The file system's reason is found where the file is closed.
          file.setstate(std::ios::badbit);
        }
      file.seekp(0);
      file << first_line(buffer.content());
    });
  }



  CheckpointReader::CheckpointReader(const std::string &file_name)
    : file(open_plain_file(file_name))
  {
    if (!file)
      refuse(file_name, std::string("cannot be read: ") + std::strerror(errno));
    check_whole(file_name, file);
    try
      {
        archive = std::make_unique<InArchive>(file);
        *archive >> read_origin;
      }
    catch (const boost::archive::archive_exception &error)
      {
        // Written on another kind of machine, or by another version of Boost.
        refuse(file_name, std::string("cannot be read: ") + error.what());
      }
  }



  CheckpointReader::~CheckpointReader() = default;



  const CheckpointOrigin &
  CheckpointReader::origin() const
  {
    return read_origin;
  }



  InArchive &
  CheckpointReader::state()
  {
    return *archive;
  }
} // namespace Debond
