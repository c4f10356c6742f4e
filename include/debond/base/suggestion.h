// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_suggestion_h
#define debond_base_suggestion_h

#include <string>
#include <vector>

namespace Debond
{
  /// Returns "; did you mean ...?" for the path "Section/Name" of an entry or a
  /// section that is not @p known, with at most three that it may have meant,
  /// best first: of these no more than a third of the letters (or two) differ,
  /// or one name is a part of the other, whatever the section. The path may
  /// also have a word of other programs, and of a family "Section/Words NAME"
  /// the words before NAME count. If there is none, returns what there is in
  /// the same section, or that there is no such thing in Debond.
  std::string
  suggestion(const std::string &path, const std::vector<std::string> &known);
} // namespace Debond

#endif
