"""Compiled building blocks of the simulation: loops over the paths of one block.

The paths of a block lie side by side in the columns of an array; a column is called a lane. Loops
over lanes have no branches, so that the compiler turns them into vector instructions, which advance
several paths at once.

- `panel`: the arrays that hold a block of paths, one path in each column
- `random_numbers`: a stream of normal numbers for each path
- `exact_flows`: exact flows of the piecewise linear parts of the equations of motion
- `vector_math`: elementary functions that a loop over paths can vectorise, in the precision of
  `single_precision` or `double_precision`; all are made of `instructions`
- `compiled_formulas`: potentials and observables given as formulas
- `histogram`: cells of values, and counts in them
- `compilation.kernel`, `compilation.inlined`, `compilation.merged`: how all of these are compiled
  and cached
"""
