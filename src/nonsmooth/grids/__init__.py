"""Functions of several state variables, on tensor grids of elements.

Here the generator A of a scene is discretised and the Poisson equation -A u = f - E f is solved.
From this follow gamma^2, invariant densities, spectral gaps and boundary layers. A box that holds
the invariant density is cut into elements along each variable (`mesh`), and the generator is
assembled on their tensor product. With up to two variables the equation is solved directly, with
more by an iteration. Grids are refined until the result settles.

- `elements.continuous`, `elements.discontinuous`: one variable, an `elements.Axis`
- `grading`: edges that crowd together at a point; `mesh`: the edges and axes of a scene
- `generator.assemble`, `generator.evaluate`: the generator and formulas on a tensor grid
- `solver.PoissonSolver`: what a solver must do; `direct_solver.DirectSolver` and
  `alternating_solver.AlternatingSolver` do it
- `tensor_grid.Grid`, `tensor_grid.fitted`, `tensor_grid.solver`: resolution, box and solver;
  `tensor_grid.invariant_measure`
- `uniform_refinement.refined`: grids of two variables, both refined until two levels agree
- `combination_technique.Combination`: grids of more variables, each refined as far as it matters
- `potential_wells.starts`: one starting point in each well that paths rarely leave
- `tuning`: resolutions and other numbers that were chosen, with the reasons
"""
