"""What is asked of a configuration before anything runs.

`configuration`
    `check`: all of it, in the order in which the answers are quick.
`outputs`
    `check_outputs`: nothing is written where a source, or somebody's file, would be lost.
`meaning`
    `check_meaning`: formulas, names, and sizes that fit each other.
`costs`
    `check_costs`: time and memory, estimated.
`scenes`
    `scene_of`: the scenes of the configuration, each made once.
"""
