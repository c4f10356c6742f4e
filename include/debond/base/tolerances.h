// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef debond_base_tolerances_h
#define debond_base_tolerances_h

#include <limits>

namespace Debond
{
  /**
   * The numbers that decide what counts as zero, the same, or converged,
   * relative to what is named. Beside their formulas are: bounds of rounding
   * that are counted term by term (of proofs and energies), parameters of
   * scenes and their defaults, and starting values.
   */
  namespace Tolerance
  {
    constexpr double epsilon = std::numeric_limits<double>::epsilon();

    // -------------------------------------------------------------- geometry

    /// Components of unit normals: sides along the axes have exact ones.
    constexpr double zero_in_normal = 1e-14;

    /// Unit normals of one flat side: far above rounding of vertices.
    constexpr double same_normal = 1e-8;

    /// Part of a unit normal that supports leave free: frames are means of
    /// normals, and a digit less is lost for each face.
    constexpr double free_normal = 1e-6;

    /// Determinant of normals at a vertex: groups of them are 31 degrees apart,
    /// so that a small one means opposite ones, or three in a plane.
    constexpr double dependent_normals = 1e-3;

    /// Coordinates of contact nodes in their order, to the size of Gamma_C.
    constexpr double same_coordinate = 1e-10;

    /// Corners of two cells that are the same but for their place, and points
    /// in a cell: a few digits more than coordinates lose.
    constexpr double same_cell = 1e-12;

    /// Points of probes beside the body, in barycentric coordinates: users give
    /// them with few digits.
    constexpr double point_in_body = 1e-8;

    /// Weights of interpolation: what rounding makes of a zero on curved sides.
    constexpr double zero_weight = 1e-6;

    /// Volume of a simplex to the cube of its size: aspects of 1e4 in 3D have
    /// more, rounding makes less.
    constexpr double flat_simplex = 1e-13;

    /// Nodes of Gmsh's files on one place or plane, to the size of a face.
    constexpr double same_node = 1e-8;

    /// The sum of the normals of a closed surface to its area, and components
    /// of such sums that are the same: by rounded coordinates of files.
    constexpr double closed_surface = 1e-6;

    /// The part of the way from a vertex to the centre at which parts are asked
    /// for beside the vertex.
    constexpr double beside_vertex = 1e-3;

    /// Distance of sides that are looked at as lying on each other, to the
    /// length of an edge: facets that turn by 45 degrees are off a curve by it.
    constexpr double touching = 0.1;

    /// The part of a face that the other side of an interface has to cover:
    /// normals of facets let a little go past the end of a curved side.
    constexpr double covered = 0.9;

    /// Entries of a mortar projection that are zero but for rounding.
    constexpr double zero_in_projection = 1e-13;

    /// Middles of contact sides on a certified one, to its length.
    constexpr double on_side = 1e-9;

    // ------------------------------------------------------ supports and data

    /// Spread of supports to the body's diameter, below which it has no part in
    /// the length of a lever.
    constexpr double one_support = 1e-12;

    /// Eigenvalues of the supports' Gram matrix, and entries of projectors that
    /// are 1: motions are free by rounding alone.
    constexpr double free_motion = 1e-12, pure_motion = 1e-6;

    /// A stiffness of bonds that an expression takes below zero where it ends,
    /// and a prescribed opening that reaches the gap.
    constexpr double rounding_of_data = 1e-12;

    /// Factors of a load path that a step leads to or that are zero, and
    /// energies that its steps dissipate: sums of decimals.
    constexpr double decimals = 1e-9;

    /// The part of the integral of loads below which what is lost of it has no
    /// note.
    constexpr double load_integral = 1e-6;

    // ------------------------------------------------------------------ laws

    /// Nodes on both sides of an interface, to the length of an edge.
    constexpr double same_place = 1e-6;

    /// Energies of bonds that are not negative, to the largest one.
    constexpr double negative_energy = 1e-12;

    /// A step is done again, or a note is due, if the mode of bonds that are
    /// damaged lags by this part of the energy that they take.
    constexpr double lag_of_mode = 0.02;

    /// The rounding of forces to forces from which on displacements of a body
    /// that friction holds are lost.
    constexpr double lost_beside_friction = 1e-3;

    /// A step has the pressures of Coulomb's friction if what they lead to
    /// differs by no more than this part of the largest.
    constexpr double pressure_of_friction = 1e-11;

    /// States of Coulomb's friction are two if they differ by this part of
    /// their displacements.
    constexpr double other_friction = 1e-6;

    /// Openings of bonds that bear nothing yet, to that at which they begin to
    /// be damaged.
    constexpr double bears_nothing = 0.1;

    /// Displacements at a kink, to themselves: a point so close to it may be on
    /// the other side on another machine.
    constexpr double at_kink = 1e-6;

    // --------------------------------------------------------- linear systems

    /// A row of a product with the terms that cancel in it, and what a
    /// factorisation loses with them.
    constexpr double row_of_product = 4. * epsilon;

    /// Entries of a truncated cycle's matrices, which are in single precision:
    /// what is left of a held unknown.
    constexpr double held_diagonal = 1e-6;

    /// The part of the diagonal that makes the coarsest matrix regular where
    /// aggregates have dependent modes: far above rounding, far below what
    /// slows a cycle down.
    constexpr double regular_diagonal = 1e-10;

    /// Largest part by which a diagonal is enlarged where rounding has made
    /// S + E indefinite.
    constexpr double largest_shift = 1e-3;

    /// Residuals of columns of S by multigrid: what is aimed at, and what is
    /// enough if rounding leaves more.
    constexpr double wanted_residual = 1e-14, required_residual = 1e-9;

    /// Least reciprocal condition of the free part of S along a path.
    constexpr double condition_on_path = 1e-13;

    // ---------------------------------------------------------- minimisation

    /// Majorants that are the same: forces and curvatures but for rounding.
    constexpr double same_majorant = 1e-12;

    /// Part by which the opening at which bonds that soften are broken exceeds
    /// that at which they begin to: with less they break at once.
    constexpr double brittle = 1e-9;

    /// Part of Phi's second derivative by which that of bonds on the same
    /// pieces changes in a refinement.
    constexpr double same_curvature = 1e-6;

    /// Part of J's first slope on a line where it has stopped falling.
    constexpr double end_of_fall = 1e-10;

    /// Part of the largest displacement by which a line goes on behind a kink.
    constexpr double past_kink = 4. * epsilon;

    /// Part of the place of a kink below which the way from it has no
    /// direction.
    constexpr double at_cone = 4. * epsilon;

    /// That where pairs go to and fro, at most.
    constexpr double longest_no_way = 1e-9;

    /// Displacements and pressures that an active set takes for zero.
    constexpr double active_set = 16. * epsilon;

    /// Part of the first-order descent that a step on the projected path has to
    /// bring (Armijo's rule).
    constexpr double least_descent = 1e-4;

    /// Bonds that hold a motion by less than this part of the body's stiffness
    /// are lost in the rounding of S + E.
    constexpr double least_stiffness = 1e-12;

    /// A motion is loose if bonds hold it by less than this part of what all of
    /// them hold: by rounding, not by bonds.
    constexpr double loose_motion = 1e-10;

    /// Proximal terms, relative to the body's: small, so that few steps do, but
    /// far from rounding.
    constexpr double proximal_stiffness = 1e-8;

    /// The rest of a resultant, to the forces, that counts as balanced.
    constexpr double balanced = 1e-12;

    /// A proximal step that repeats the one before, to the step.
    constexpr double same_step = 1e-3;

    /// The way towards the foundation that a motion away from it may take: a
    /// long thin body that turns about an end presses there by little.
    constexpr double towards_foundation = 1e-7;

    /// Displacements by which a body comes off, to the largest normal one.
    constexpr double motion_off = 1e-9;

    /// Part of the work that forces could do, had they the same sign, below
    /// which what they do is rounding.
    constexpr double work = 1e-12;

    /// Directions of a cone that are the same or opposite.
    constexpr double dependent = 1e-12;

    /// Forces against a cone: what rounding leaves of balanced ones.
    constexpr double in_cone = 16. * epsilon;

    /// Speeds along a path to the fastest one, which are rounding of that.
    constexpr double no_speed = 1e-12;

    /// Breakpoints of a path that coincide, to the interval.
    constexpr double same_breakpoint = 1e-11;

    /// Steps of a line search that are none.
    constexpr double no_step = 1e-12;

    /// Residual of the bundle's direction, above which it is not used.
    constexpr double direction = 1e-9;

    // ------------------------------------------------------ search and proof

    /// Residual that a trial of the search may have where the method's own
    /// tolerance was not reached: rounding leaves 1e-8 on a body of 100 x 1.
    constexpr double trial = 1e-6;

    /// Majorants of trials are minimised roughly down to this: below, the
    /// majorant is nearly the last one.
    constexpr double rough_majorant = 1e-9;

    /// Intervals, their ends being roots and inverses, are taken outwards by
    /// this: rounding must not leave out a point.
    constexpr double outwards = 1e-6;

    /// Convexity that a bound at a point takes more than it needs, and at least
    /// of the curvature: a residual d of s then costs d^2 / (2 D).
    constexpr double excess_at_point = 1e-2, floor_at_point = 1e-8;

    /// Changes of log det A by a coordinate of the shift that are not worth
    /// their update.
    constexpr double shift_step = 1e-3;

    // ------------------------------------------- refinement and verification

    /// Corrections of a refinement, in the energy norm.
    constexpr double refinement = 1e-13;

    /// Rounding of J, relative to it, that needs no refinement: what results
    /// are printed with, and less on small meshes.
    constexpr double least_energy_rounding   = 1e-10,
                     largest_energy_rounding = 1e-9;

    /// Rounding of stresses to these, from which on they are rounding alone.
    constexpr double no_stresses = 1e-2;

    /// The contact law, by which success is decided.
    constexpr double contact_law = 1e-6;

    /// The part by which J may still fall: energies are off by the square of
    /// what displacements are.
    constexpr double descent = 1e-6;

    /// Rounding of nodal forces, to them, from which on nothing is verified;
    /// forces have to be so many times it to be resolved.
    constexpr double force_rounding = 0.1, resolved = 1e4;

    /// Forces beside the largest one that rounding of gaps may make.
    constexpr double negligible_force = 1e-7;

    /// The scale of forces in contact, to that of the body's.
    constexpr double contact_force = 1e-3;

    /// The size of cells where bonds end, to E* / a: with it a front of bonds
    /// breaks at a load that is 5 % too high (doc/guide/load-path.md).
    constexpr double cell_size_at_edge = 1. / 32.;

    /// Gaps under pressure that an iterative method has not closed yet.
    constexpr double open_contact = 1e-3;

    /// Displacements of iterative methods, in the estimated error.
    constexpr double estimated_contact = 1e-6;

    // ---------------------------------------------------------- certificates

    /// The part that computations may have lost of J, tractions, constants of
    /// cells, shapes and displacements in contact: a thousand times what they
    /// lose.
    constexpr double certificate = 1e-9;

    /// Loads in a cell, bonds, gaps and tractions along a side that have to be
    /// constant or linear.
    constexpr double linear_data = 1e-10;
  } // namespace Tolerance



  /// The tolerances of BundleQP.
  namespace QPTolerance
  {
    /// Units of rounding by which terms may miss zero.
    constexpr double rounding = 64. * Tolerance::epsilon;

    /// Part of its squared length by which a cut (or bound) has to stand out
    /// of the working set to enter it. The Gram matrix has the square of the
    /// relative accuracy of the subgradients, so this is close to rounding.
    constexpr double independence = 1e-13;

    /// A cut enters if it exceeds v by more than this part of |v|.
    constexpr double cut = 1e-12;

    /// A bound enters if d exceeds it by more than this part of |d|.
    constexpr double bound = 1e-13;

    /// Residual of the linear system above which it is refined.
    constexpr double refinement = 1e-14;

    /// Residual of a solution above which the factor is made anew, once.
    constexpr double repair = 1e-10;

    /// Range of kappa over the mean diagonal of H in which the factor is kept.
    constexpr double kappa_range = 1e2;
  } // namespace QPTolerance
} // namespace Debond

#endif
