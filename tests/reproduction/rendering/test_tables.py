"""Tables keep their content in every form."""

import pandas as pd
import typst

from reproduction.rendering import tables


def test_widths_of_columns():
    """Typst breaks text in columns of given widths; without them columns are as wide as needed."""
    cells = pd.DataFrame([{"a": "$x^2$", "b": "some text that is long " * 20}])
    assert "columns: 2," in tables.typst(cells)
    cells.attrs["widths"] = ("auto", "1fr")
    source = tables.typst(cells)
    assert "columns: (auto, 1fr)," in source
    assert source.count("some text") == 20
    assert typst.compile(source.encode()).startswith(b"%PDF")
