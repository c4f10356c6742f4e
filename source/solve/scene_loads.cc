// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/function.h>

#include <debond/input/expression.h>
#include <debond/solve/scene_loads.h>

#include <memory>
#include <stdexcept>

namespace Debond
{
  namespace
  {
    using Vector = DofVector;

    /// The sum of tractions on faces that have several names.
    template <int dim>
    class Sum : public dealii::Function<dim>
    {
    public:
      using Term = std::shared_ptr<const dealii::Function<dim>>;

      Sum(const Term &first, const Term &second)
        : dealii::Function<dim>(dim)
        , first(first)
        , second(second)
      {}

      double
      value(const dealii::Point<dim> &point,
            const unsigned int        component) const override
      {
        return first->value(point, component) + second->value(point, component);
      }

    private:
      const Term first;
      const Term second;
    };
  } // namespace



  std::string
  traction_entry(const LoadParameters            &loads,
                 const BoundaryNames             &boundaries,
                 const dealii::types::boundary_id id)
  {
    for (const auto &[name, unused] : loads.tractions)
      if (boundaries.at(name).count(id) > 0)
        return "Loads/Traction " + name;
    throw std::logic_error("There is no traction on this boundary.");
  }



  template <int dim>
  Loads<dim>
  make_loads(const LoadParameters        &parameters,
             const std::set<std::string> &dead_loads,
             const bool                   wants_dead,
             const BoundaryNames         &boundaries)
  {
    const auto is_wanted = [&](const std::string &name) {
      return wants_dead == (dead_loads.count(name) > 0);
    };
    Loads<dim> loads;
    loads.boundary_names = boundaries;
    if (!parameters.body_force.empty() && is_wanted("body force"))
      loads.body_force =
        make_function<dim>(parameters.body_force, parameters.constants);
    if (!parameters.temperature_change.empty() && !wants_dead)
      loads.temperature_change =
        make_function<dim>(parameters.temperature_change,
                           parameters.constants,
                           1);
    for (const auto &[name, expression] : parameters.tractions)
      for (const dealii::types::boundary_id id : boundaries.at(name))
        {
          if (!is_wanted(name))
            continue;
          const std::shared_ptr<const dealii::Function<dim>> added =
            make_function<dim>(expression, parameters.constants);
          auto &traction = loads.tractions[id];
          traction       = traction ?
                             std::make_shared<const Sum<dim>>(traction, added) :
                             added;
        }
    return loads;
  }



  template decltype(make_loads<2>) make_loads<2>;
  template decltype(make_loads<3>) make_loads<3>;
} // namespace Debond
