// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/atomic_file.h>
#include <debond/output/record.h>

namespace Debond
{
  Record::Record(const bool details)
    : details(details)
  {}



  void
  Record::print(std::ostream &out)
  {
    // The lines are flushed, since what follows may take long or be killed. The
    // numbers for summary.json stay: they are written once, at the end.
    out << log.str() << std::flush;
    log.str("");
  }



  void
  Record::write(const std::string &file_name) const
  {
    // A path need not be valid UTF-8; that is no reason to lose the summary.
    const std::string text =
      json.dump(2, ' ', false, Json::error_handler_t::replace);
    write_atomically(file_name,
                     [&](std::ostream &out) { out << text << '\n'; });
  }
} // namespace Debond
