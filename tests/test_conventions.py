"""Conventions of the sources that no linter knows; each message names who breaks which."""

import ast
import re
from functools import cache
from itertools import chain

import pytest

from support import ROOT

SOURCES = ("src", "workflow", "benchmarks", "examples", "tests")
LONGEST_BODY = 60  # lines of a function without its docstring
MOST_FILES = 12  # in a folder of the packages
# public in spite of their names: of named tuples, and what notebooks call
PUBLIC = {"_replace", "_fields", "_asdict", "_make", "_repr_html_", "_repr_latex_", "_exit"}


def files(*folders):
    """Python files of some folders of the repository."""
    return sorted(chain.from_iterable((ROOT / folder).rglob("*.py") for folder in folders))


@cache
def parsed(path):
    """Syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"))


def told(path, line=1):
    """Place in the repository, as messages name it."""
    return f"{path.relative_to(ROOT)}:{line}"


def is_private(name):
    """Whether a name has a single leading underscore."""
    return name.startswith("_") and not name.startswith("__") and name.strip("_") != ""


def defined(tree):
    """Names that a module defines or assigns, those of its classes and instances too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.id if isinstance(node, ast.Name) else node.attr


def private_names(path):
    """Private names that a module takes from elsewhere, with their lines."""
    tree = parsed(path)
    own = set(defined(tree)) | PUBLIC
    package = ".".join(path.relative_to(ROOT / "src").parent.parts) if "src" in path.parts else ""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").rpartition(".")[0] != package:
            yield from ((alias.name, node.lineno) for alias in node.names if is_private(alias.name))
        elif isinstance(node, ast.Attribute) and is_private(node.attr) and node.attr not in own:
            yield node.attr, node.lineno
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("setattr", "getattr")):
            # the name as a text, of a module or of an object
            texts = [a.value for a in node.args[:2] if isinstance(a, ast.Constant)]
            texts = [str(text).rpartition(".")[2] for text in texts]
            yield from ((text, node.lineno) for text in texts if is_private(text))


@pytest.mark.parametrize("folder", SOURCES)
def test_private_names_stay_in_their_package(folder):
    """A name with a leading underscore is neither imported nor read from outside."""
    found = [
        (told(path, line), name) for path in files(folder) for name, line in private_names(path)
    ]
    assert not found, "private names used from outside: " + ", ".join(map(" ".join, found))


@pytest.mark.parametrize("folder", ["src", "workflow", "benchmarks", "examples"])
def test_functions_are_short(folder):
    """No function has more than sixty lines, its docstring not counted."""
    found = []
    for path in files(folder):
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.FunctionDef):
                body = node.body[ast.get_docstring(node) is not None :]
                lines = body[-1].end_lineno - body[0].lineno + 1 if body else 0
                if lines > LONGEST_BODY:
                    found.append(f"{told(path, node.lineno)} {node.name} ({lines} lines)")
    assert not found, "split these functions: " + ", ".join(found)


def packages():
    """Folders of the two packages."""
    return sorted({path.parent for path in files("src")})


def test_folders_are_small():
    """No folder of the packages holds more than a dozen files."""
    counts = {told(p): sum(child.is_file() for child in p.iterdir()) for p in packages()}
    found = [f"{name} ({count} files)" for name, count in counts.items() if count > MOST_FILES]
    assert not found, "divide these folders: " + ", ".join(found)


@pytest.mark.parametrize(
    "package", packages(), ids=lambda p: p.relative_to(ROOT / "src").as_posix()
)
class TestPackages:
    """Every package says what is in it, and does nothing else."""

    def test_has_a_docstring_and_no_code(self, package):
        """Only the table of what `nonsmooth` itself offers is code."""
        body = parsed(package / "__init__.py").body
        assert ast.get_docstring(ast.Module(body, [])), f"{told(package)} has no docstring"
        assert len(body) == 1 or package.name == "nonsmooth", f"{told(package)} holds code"

    def test_names_what_others_use(self, package):
        """The docstring names every module that is imported from outside the package."""
        text = ast.get_docstring(parsed(package / "__init__.py"))
        name = ".".join(package.relative_to(ROOT / "src").parts)
        words = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", text))))
        if package.name != "nonsmooth":
            others = {module for path, module in imports() if package not in path.parents}
            modules = {p.stem for p in package.glob("*.py")} - {"__init__", "tuning", *words}
            found = sorted({f"{name}.{module}" for module in modules} & others)
            assert not found, f"{told(package)} does not name {', '.join(found)}"

    def test_names_what_exists(self, package):
        """Every `module.name` of the docstring is there."""
        text = ast.get_docstring(parsed(package / "__init__.py"))
        for module, name in re.findall(r"`(?:[a-z_]+\.)*([a-z_]+)\.(\w+)`", text):
            path = package / f"{module}.py"
            if module != "__init__" and path.exists():
                assert name in set(defined(parsed(path))), f"{told(path)} has no {name}"


@cache
def imports():
    """Modules that files import, as pairs of the file and the dotted name."""
    found = set()
    for path in files("src", "workflow", "benchmarks", "examples"):
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.ImportFrom) and node.module:
                found.add((path, node.module))
                found |= {(path, f"{node.module}.{alias.name}") for alias in node.names}
    return found


def test_modules_are_imported_where_they_stand():
    """Packages and scripts take no name from `nonsmooth` itself, which would import it later.

    The workflow follows imports to know which results a change concerns.
    """
    found = []
    for path in files("src", "workflow"):
        tree = parsed(path)
        aliases = {
            alias.asname or alias.name
            for node in ast.walk(tree)
            if isinstance(node, ast.Import)
            for alias in node.names
            if alias.name == "nonsmooth"
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module == "nonsmooth":
                places = [ROOT / "src" / "nonsmooth" / alias.name for alias in node.names]
                late = [p for p in places if not (p.is_dir() or p.with_suffix(".py").exists())]
                found += [f"{told(path, node.lineno)} {p.name}" for p in late]
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                late = node.value.id in aliases and not node.attr.startswith("__")
                found += [f"{told(path, node.lineno)} {node.attr}"] if late else []
    assert not found, "import these from their modules: " + ", ".join(found)


def test_tests_stand_where_the_sources_do():
    """tests/a/b/test_c.py tests the module or package src/a/b/c."""
    found = []
    for path in files("tests/nonsmooth", "tests/reproduction"):
        if path.name not in (
            "test_public_interface.py",
            "test_extremes.py",
        ):  # of the whole library
            place = path.relative_to(ROOT / "tests").with_name(path.stem.removeprefix("test_"))
            source = ROOT / "src" / place
            if not (source.is_dir() or source.with_suffix(".py").exists()):
                found.append(told(path))
    assert not found, "no module of their names: " + ", ".join(found)
