// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_nearest_name_h
#define debond_base_nearest_name_h

#include <string>
#include <vector>

namespace Debond
{
  /**
   * The number of insertions, deletions, substitutions and transpositions of
   * neighbours that turn one word into the other, upper and lower case being
   * equal (Damerau's distance in its restricted form, in which no part is
   * edited twice).
   */
  unsigned int
  edit_distance(const std::string &a, const std::string &b);

  /**
   * The known paths ("Section/Name") that a misspelt path may have meant, best
   * first, at most three. Names are compared before sections, so that the
   * right name in the wrong section is found. Empty if nothing is near: more
   * than a third of the letters (and more than two) differ, and none of the
   * names is part of the other.
   */
  std::vector<std::string>
  nearest_names(const std::string &path, const std::vector<std::string> &known);
} // namespace Debond

#endif
