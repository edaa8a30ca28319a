"""The workflow's own Python: helpers of the rules that contain no science.

Importing this package makes the process and the jobs that it starts use the sources in `src`, even
if the packages are also installed elsewhere. The rules list these sources as their inputs.
"""

import os
import sys
from pathlib import Path

SOURCES = str(Path(__file__).parents[1] / "src")
os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [SOURCES, os.environ.get("PYTHONPATH")]))
sys.path.insert(0, SOURCES)
