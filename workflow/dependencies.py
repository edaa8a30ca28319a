"""The source files on which a script depends; Snakemake does not find them by itself."""

import ast
from collections.abc import Iterable
from functools import cache, lru_cache
from pathlib import Path

import grimp

PACKAGES = ("nonsmooth", "reproduction", "studies")
ROOT = Path(__file__).resolve().parents[1]


@lru_cache(maxsize=1)
def _graph():
    return grimp.build_graph(*PACKAGES, cache_dir=None)


@cache
def sources(script: str) -> list[str]:
    """List the modules of the packages that a script imports, directly or through others.

    Parameters
    ----------
    script : str
        Path of the script, relative to the repository.

    Returns
    -------
    list of str
        Paths relative to the repository, sorted.
    """
    tree = ast.parse((ROOT / script).read_text(encoding="utf-8"))
    named = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PACKAGES):
            named |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            named |= {alias.name for alias in node.names}
    return imported(name for name in named if name in _graph().modules)


def imported(modules: Iterable[str]) -> list[str]:
    """List modules of the packages and what they import, directly or through others.

    Parameters
    ----------
    modules : iterable of str
        As Python names them.

    Returns
    -------
    list of str
        Paths relative to the repository, sorted.
    """
    direct = set(modules) - set(PACKAGES)
    needed = direct.union(*(_graph().find_upstream_modules(name) for name in direct))
    return sorted(map(_file, needed - set(PACKAGES)))


@cache
def _file(module):
    path = Path("src", *module.split("."))
    return str(path / "__init__.py" if (ROOT / path).is_dir() else path.with_suffix(".py"))
