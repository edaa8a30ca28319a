"""The workflow's own Python: what the rules need besides the science.

Importing it makes this process and the jobs it starts use the package's sources beside it,
wherever else the package may be installed: they are the files the rules list as inputs.
"""

import os
import sys
from pathlib import Path

SOURCES = str(Path(__file__).parents[1] / "src")
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [SOURCES, os.environ.get("PYTHONPATH")]))
sys.path.insert(0, SOURCES)
