"""Tables of numbers: of pandas where it is installed."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def table(rows: list[dict[str, Any]]) -> Any:
    """A pandas.DataFrame, or without pandas the rows themselves."""
    try:
        return import_module("pandas").DataFrame(rows)
    except ImportError:
        return rows
