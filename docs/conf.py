"""How Sphinx builds the manual; `make docs` runs it."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "src")]

import pictures  # noqa: E402
import sphinx.ext.autosummary as autosummary  # noqa: E402
from sphinx_gallery.sorting import ExplicitOrder  # noqa: E402

project = "nonsmooth"
author = "The nonsmooth developers"
copyright = "the nonsmooth developers, MIT licence"
html_show_sphinx = False

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # formulas are set without a connection
    "myst_parser",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
default_role = "literal"  # of names in docstrings
exclude_patterns = ["_build", "gallery/**/README.rst", "sg_execution_times.rst"]
# the same fence as on GitHub, and headings that other pages can name
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_fence_as_directive = []

html_theme = "pydata_sphinx_theme"
html_title = "nonsmooth"
# pages without others below them
html_sidebars = {
    page: [] for page in ("index", "problem", "how_a_number_is_made", "errors", "workflow", "costs")
}
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_theme_options = {
    "show_toc_level": 2,
    "header_links_before_dropdown": 7,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_context = {"default_mode": "light"}
html_copy_source = False
html_show_sourcelink = False

autosummary_generate = True
# no ends of sentences
autosummary.WELL_KNOWN_ABBREVIATIONS = (*autosummary.WELL_KNOWN_ABBREVIATIONS, "eq.", "eqs.")
autodoc_default_options = {"members": False}
autodoc_typehints = "none"  # the Parameters sections have the types
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

# the types in signatures and docstrings are words for people, not names of pages
nitpick_ignore_regex = [("py:.*", ".*")]

sphinx_gallery_conf = {
    "examples_dirs": ["../examples"],
    "gallery_dirs": ["gallery"],
    "filename_pattern": r"\.py$",
    "within_subsection_order": ExplicitOrder(
        [
            "first_number.py",
            "my_oscillator.py",
            "which_method.py",
            "own_formulas.py",
            "dead_zone.py",
            "far_start.py",
            "earthquake.py",
            "stiffer_and_stiffer.py",
            "error_bars.py",
            "sliding_isolator.py",
            "reading_an_artifact.py",
            "trajectories.py",
            "yielding_oscillator.py",
            "obstacle_density.py",
            "friction_crossing.py",
            "rare_crossing.py",
            "corrected_formula.py",
            "*",
        ]
    ),
    "abort_on_example_error": True,
    "show_memory": False,
    "show_signature": False,
    "download_all_examples": False,
    "min_reported_time": 10_000,
    "reset_modules": ("matplotlib",),
}


def _plain(_app, _what, _name, _object, _options, lines):
    """Keep |x| and names such as C_b in docstrings from being read as markup."""
    lines[:] = [re.sub(r"(?<![`\\])\|", r"\|", line) for line in lines]


def setup(app):
    """Draw the manual's pictures before the pages are read."""
    pictures.draw_all(HERE / "generated")
    app.connect("autodoc-process-docstring", _plain, priority=900)
