// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_output_record_h
#define debond_output_record_h

#include <debond/base/text.h>

#include <nlohmann/json.hpp>

#include <optional>
#include <ostream>

namespace Debond
{
  /**
   * A record of what a run says: numbers and words for summary.json, and the
   * lines of the log, so that both are written down in one place (report.h).
   */
  class Record
  {
  public:
    using Json = nlohmann::ordered_json;

    /// @p details: whether the log has what differs between machines.
    explicit Record(const bool details);

    bool
    has_details() const
    {
      return details;
    }

    /// Puts a value into summary.json at a JSON pointer such as "/iterations",
    /// by which studies find it; the entries of an object come behind those
    /// that are there.
    void
    add(const std::string &pointer, const Json &value)
    {
      Json &there = json[Json::json_pointer(pointer)];
      if (value.is_object())
        there.update(value);
      else
        there = value;
    }

    /// Puts the @p entries, an object, at the top of summary.json.
    void
    add(const Json &entries)
    {
      add("", entries);
    }

    /// A line of the log that has no label.
    void
    heading(const std::string &text)
    {
      log << text << '\n';
    }

    /// A line of the log of a label and words() of all parts.
    template <typename... Parts>
    void
    line(const std::string &label, const Parts &...parts)
    {
      constexpr int label_width = 21;
      log << words("  ", std::left, std::setw(label_width), label, std::right)
          << ' ' << words(parts...) << '\n';
    }

    /// Prints the lines since the last call.
    void
    print(std::ostream &out);

    /// Writes summary.json. Numbers that are not finite become null. Throws
    /// std::runtime_error naming the file if it cannot be written.
    void
    write(const std::string &file_name) const;

    /// Returns the number, or null without one.
    static Json
    json_of(const std::optional<double> &number)
    {
      return number ? Json(*number) : Json();
    }

  private:
    const bool         details;
    Json               json;
    std::ostringstream log;
  };
} // namespace Debond

#endif
