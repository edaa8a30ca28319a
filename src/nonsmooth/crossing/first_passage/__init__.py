"""First passage: when int_0^t g first leaves an interval, without Monte Carlo.

The Laplace transform of the first passage time solves the kinetic equation (`nonsmooth.kinetic`).
Here it is inverted, or the probability is computed by steps in time, on finer and finer levels
until two agree, or, for two variables, until no part of the resolution changes it. The manual page
is `docs/methods/first_passage.md`; to add a problem see
`docs/how_to/add_a_first_passage_problem.md`.

- `distribution.deterministic_crossing`: probabilities with their errors, for scenes of one and two
  state variables; `distribution.default_tolerance`: for which scenes, and how accurate;
  `distribution.refined`: the same for any problem.
- `problem.LaplaceProblem`, `problem.DirectProblem`, `problem.Settings`: the contract of a problem.
- `line.LineProblem`, `plane.PlaneProblem`: the problems; `plane.inverted`, `time_stepping.stepped`:
  how the second is solved at late and at early times.
- `each_part.refine_each_part`: refinement of one part of a resolution at a time.
- `inversion.contour_solver`: the inverse Laplace transform for many times.
- `vertical_lines.inverted`: the same by rational fits, for one variable.
- `saddle_points.saddle_points`, `contours.hyperbola`, `contours.through_saddle`,
  `contours.inverted`, `contours.inverted_together`: its parts.
"""
