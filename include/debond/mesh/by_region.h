// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_mesh_by_region_h
#define debond_mesh_by_region_h

#include <deal.II/base/types.h>

#include <map>

namespace Debond
{
  /// Something that every cell has: the same everywhere, but for regions that
  /// have one of their own.
  template <typename T>
  class ByRegion
  {
  public:
    ByRegion(const T &everywhere)
      : everywhere(everywhere)
    {}

    void
    set(const dealii::types::material_id region, const T &value)
    {
      others.insert_or_assign(region, value);
    }

    const T &
    operator()(const dealii::types::material_id region) const
    {
      if (others.empty())
        return everywhere;
      const auto other = others.find(region);
      return other != others.end() ? other->second : everywhere;
    }

    /// Returns the results of @p function for everywhere and for each region.
    template <typename Function>
    auto
    transformed(const Function &function) const
    {
      ByRegion<std::decay_t<decltype(function(everywhere))>> result(
        function(everywhere));
      for (const auto &[region, value] : others)
        result.set(region, function(value));
      return result;
    }

  private:
    T                                       everywhere;
    std::map<dealii::types::material_id, T> others;
  };
} // namespace Debond

#endif
