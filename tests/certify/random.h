// SPDX-License-Identifier: LGPL-2.1-or-later
// Random numbers that are the same on all machines.
#ifndef debond_tests_certify_random_h
#define debond_tests_certify_random_h

#include <cmath>
#include <random>
#include <vector>

class Generator
{
public:
  explicit Generator(const unsigned int seed)
    : engine(seed)
  {}

  double
  uniform(const double a, const double b)
  {
    return a + (b - a) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  }

  /// 10 to the power of what is uniform.
  double
  magnitude(const double a, const double b)
  {
    return std::pow(10., uniform(a, b));
  }

  unsigned int
  below(const unsigned int n)
  {
    return static_cast<unsigned int>(engine() % n);
  }

  bool
  chance(const double probability)
  {
    return uniform(0., 1.) < probability;
  }

  template <typename T>
  T
  choice(const std::vector<T> &values)
  {
    return values[engine() % values.size()];
  }

private:
  std::mt19937_64 engine;
};

#endif
