// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenes and their solutions by the method that the program would choose.
#ifndef debond_tests_solved_h
#define debond_tests_solved_h

#include <debond/solve/minimum/method_choice.h>
#include <debond/solve/minimum/solve.h>
#include <debond/solve/scene/scene.h>

#include "parameters_of.h"

inline Debond::MethodChoice
choice_of(const Debond::Parameters &parameters)
{
  return Debond::choose_method(parameters, parameters.solver);
}



template <int dim>
Debond::Scene<dim>
scene_of(const Debond::Parameters &parameters)
{
  return Debond::Scene<dim>(parameters);
}



/// With the linear solver for the scene's mesh.
template <int dim>
Debond::MethodChoice
choice_on(const Debond::Parameters &parameters, const Debond::Scene<dim> &scene)
{
  Debond::MethodChoice choice = choice_of(parameters);
  Debond::choose_linear_solver(scene, parameters.solver, choice);
  return choice;
}



/// From rest or from @p start.
template <int dim>
Debond::Solution
solved(const Debond::Parameters &parameters,
       const Debond::Scene<dim> &scene,
       const Debond::DofVector  *start = nullptr)
{
  return Debond::solve(
    choice_on(parameters, scene), parameters.solver, scene, {}, start);
}

#endif
