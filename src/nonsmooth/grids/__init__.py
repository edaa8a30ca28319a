"""Functions of several state variables, on tensor grids of elements.

Here the generator A of a scene is discretised and the Poisson equation -A u = f - E f is solved, of
which gamma^2, invariant densities, spectral gaps and boundary layers are made. A box that holds the
invariant density is cut into elements along each variable (`mesh`); the generator is assembled on
their tensor product; up to two variables are solved directly, more by an iteration; and grids are
refined until the result settles.

- `elements.continuous`, `elements.discontinuous`: one variable, an `elements.Axis`
- `grading`: edges that crowd together at a point; `mesh`: the edges and axes of a scene
- `generator.assemble`, `generator.evaluate`: the generator and formulas on a tensor grid
- `solver.PoissonSolver`: what a solver must do; `direct_solver.DirectSolver` and
  `alternating_solver.AlternatingSolver` do it
- `tensor_grid.Grid`, `tensor_grid.fitted`, `tensor_grid.solver`: resolution, box and solver
- `uniform_refinement.refined`: two variables, refined alike until two levels agree
- `combination_technique.Combination`: more variables, each refined as far as it matters
- `potential_wells.starts`: the wells in which paths may be held
- `tuning`: the numbers that were chosen
"""
