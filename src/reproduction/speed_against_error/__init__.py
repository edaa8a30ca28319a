"""Speed against error: what the methods of the library and of others take for their accuracy.

- `work_precision.measured`: runs methods at several sizes and returns times and errors
- `work_precision.peer`: measures programs that run in another environment
- `pathwise.BrownianPaths`: strong errors of the Strang splitting
"""
