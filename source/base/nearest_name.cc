// SPDX-License-Identifier: LGPL-2.1-or-later
#include <debond/base/nearest_name.h>

#include <algorithm>
#include <cctype>
#include <tuple>

namespace Debond
{
  namespace
  {
    std::string
    lower_case(std::string word)
    {
      for (char &letter : word)
        letter =
          static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
      return word;
    }
  } // namespace



  unsigned int
  edit_distance(const std::string &a, const std::string &b)
  {
    const std::string s = lower_case(a);
    const std::string t = lower_case(b);

    // distance[i][j] is that of the first i letters of s and j of t.
    std::vector<std::vector<std::size_t>> distance(
      s.size() + 1, std::vector<std::size_t>(t.size() + 1));
    for (std::size_t i = 0; i <= s.size(); ++i)
      for (std::size_t j = 0; j <= t.size(); ++j)
        {
          if (i == 0 || j == 0)
            {
              distance[i][j] = i + j;
              continue;
            }
          const std::size_t substitution = s[i - 1] == t[j - 1] ? 0 : 1;
          distance[i][j]                 = std::min({distance[i - 1][j] + 1,
                                                     distance[i][j - 1] + 1,
                                                     distance[i - 1][j - 1] + substitution});
          if (i > 1 && j > 1 && s[i - 1] == t[j - 2] && s[i - 2] == t[j - 1])
            distance[i][j] =
              std::min(distance[i][j], distance[i - 2][j - 2] + 1);
        }
    return static_cast<unsigned int>(distance[s.size()][t.size()]);
  }



  std::vector<std::string>
  nearest_names(const std::string &path, const std::vector<std::string> &known)
  {
    const auto split = [](const std::string &text) {
      const std::size_t slash = text.rfind('/');
      return slash == std::string::npos ?
               std::make_pair(std::string(), text) :
               std::make_pair(text.substr(0, slash), text.substr(slash + 1));
    };
    const auto contains = [](const std::string &word, const std::string &part) {
      return part.size() > 2 &&
             lower_case(word).find(lower_case(part)) != std::string::npos;
    };

    const auto [section, name] = split(path);
    const unsigned int largest =
      std::max<unsigned int>(2, static_cast<unsigned int>(name.size() / 3));

    std::vector<std::tuple<unsigned int, unsigned int, std::string>> near;
    for (const std::string &candidate : known)
      {
        const auto [known_section, known_name] = split(candidate);
        const unsigned int distance = edit_distance(name, known_name);
        if (distance <= largest || contains(known_name, name) ||
            contains(name, known_name))
          near.emplace_back(distance,
                            edit_distance(section, known_section),
                            candidate);
      }
    std::sort(near.begin(), near.end());

    std::vector<std::string> names;
    for (const auto &entry : near)
      if (names.size() < 3)
        names.push_back(std::get<2>(entry));
    return names;
  }
} // namespace Debond
