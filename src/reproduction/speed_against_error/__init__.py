"""Speed against error: how long methods take, those of the library and others, for an accuracy.

- `work_precision.measured`: runs methods at several sizes and returns times and errors
- `work_precision.peer`: measures programs that run in another environment
- `pathwise.BrownianPaths`: strong errors of the Strang splitting
"""
