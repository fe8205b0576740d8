"""Lines of numbers read by C: by pyarrow if it is installed, else by numpy; or not at all."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.log import Array

#: How a cell says that there is no sample, in small letters.
NO_SAMPLE = ("", "nan", "na", "n/a", "null", "none")

_FEW = 100  # lines; fewer are not worth the start


def by_c(lines: list[str], separator: str, columns: int) -> Array | None:
    """The numbers in lines of equally many cells, the same doubles as `float` gives.

    None where a cell holds anything else than a number (pyarrow: or says that there is none), or a
    line has another number of cells: then each line has to be looked at.
    """
    if len(lines) < _FEW:
        return None
    text = "".join(lines)
    if '"' in text or "#" in text:
        return None
    try:
        return _by_arrow(text, separator, columns)
    except ImportError:
        return _by_numpy(lines, separator, columns)


def _by_arrow(text: str, separator: str, columns: int) -> Array | None:
    import pyarrow
    import pyarrow.csv

    data = text.encode("utf-8", "surrogatepass")
    names = [str(k) for k in range(columns)]
    try:
        table = pyarrow.csv.read_csv(
            pyarrow.BufferReader(data),
            pyarrow.csv.ReadOptions(column_names=names, block_size=len(data) + 1),
            pyarrow.csv.ParseOptions(delimiter=separator, quote_char=False),
            pyarrow.csv.ConvertOptions(
                column_types=dict.fromkeys(names, pyarrow.float64()),
                null_values=[word for n in NO_SAMPLE for word in dict.fromkeys((n, n.upper()))],
            ),
        )
    except pyarrow.ArrowInvalid:
        return None
    values = np.empty((table.num_rows, columns))
    for k, column in enumerate(table.columns):
        values[:, k] = column.to_numpy()
    return values


def _by_numpy(lines: list[str], separator: str, columns: int) -> Array | None:
    if all(not line.strip() for line in lines):
        return None
    try:
        values = np.loadtxt(lines, delimiter=separator, comments=None, ndmin=2)
    except ValueError:
        return None
    return values if values.shape[1] == columns else None
