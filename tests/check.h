// SPDX-License-Identifier: LGPL-2.1-or-later
// What the tests print: what does not hold and by how much, and at the end the
// number of all checks, so that none is left out. With an argument, which sets
// print_figures, all of them.
#ifndef debond_tests_check_h
#define debond_tests_check_h

#include <exception>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <type_traits>

/// Whether to print the figures behind the verdicts; the tests set it if they
/// get any argument.
inline bool print_figures = false;



inline const char *
verdict(const bool good)
{
  return good ? "yes" : "NO";
}



/// The larger of the two; what is not a number stays.
template <typename Number>
void
raise(Number &largest, const std::common_type_t<Number> value)
{
  if (!(value <= largest) && largest == largest)
    largest = value;
}



/// Whether the value is at most the bound; if not, or if it is not a number,
/// the value and the bound are said.
inline std::string
verdict(const double value, const double bound)
{
  std::ostringstream text;
  text << verdict(value <= bound);
  if (!(value <= bound))
    text << ", it is " << value << ", at most " << bound << " is allowed";
  else if (print_figures)
    text << " (" << value << ')';
  return text.str();
}



/// Prints how many there were, when the program ends.
struct NumberOfChecks
{
  unsigned int n = 0;

  ~NumberOfChecks()
  {
    if (n > 0)
      std::cout << n << " checks" << std::endl;
  }
};

inline NumberOfChecks number_of_checks;

inline std::string section_name;



/// What the checks that follow are about: printed above the first one that
/// fails.
template <typename... Parts>
void
section(const Parts &...parts)
{
  std::ostringstream name;
  (name << ... << parts);
  section_name = name.str();
}



/// The name of a check, below that of its section.
inline std::string
in_section(const std::string &name)
{
  const std::string above = section_name.empty() ? "" : section_name + '\n';
  section_name.clear();
  return above + name;
}



/// Prints a line with the name if it does not hold.
inline void
check(const std::string &name, const bool holds)
{
  ++number_of_checks.n;
  if (!holds || print_figures)
    std::cout << in_section(name) << ": " << verdict(holds) << std::endl;
}



/// Prints a line with the name, the value and the bound if it does not hold.
inline void
check(const std::string &name, const double value, const double bound)
{
  ++number_of_checks.n;
  if (!(value <= bound) || print_figures)
    std::cout << in_section(name) << ", at most " << bound << ": "
              << verdict(value, bound) << std::endl;
}



/// Prints the message of the exception that the action throws.
inline void
print_error(const std::function<void()> &action)
{
  try
    {
      action();
      std::cout << "NO ERROR" << std::endl;
    }
  catch (const std::exception &error)
    {
      std::cout << error.what() << std::endl;
    }
}

#endif
