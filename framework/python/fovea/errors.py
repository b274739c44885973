"""Errors and warnings, with the places where they arise."""

from __future__ import annotations

import warnings
from collections.abc import Iterable

from ._core import Diagnostic, ExitCode


class Error(Exception):
    """A mistake in a graph, scene, pass or argument, or a failure of the device.

    `diagnostics` holds every mistake that was found; `file`, `line`, `column` and `remedy` are those of the first one.
    Lines and columns count from 1, and 0 means unknown. `code` tells what kind of error it is. The cause of an error
    in a pass that is written in Python is the exception of that pass.
    """

    def __init__(self, text: str, code: ExitCode, diagnostics: list[Diagnostic]) -> None:
        super().__init__(text)
        self.code = code
        self.diagnostics = diagnostics

    def __reduce__(self) -> tuple[type[RuntimeError], tuple[str]]:
        """Pickles an error as its text, as processes exchange it."""
        return RuntimeError, (str(self),)

    @property
    def file(self) -> str:
        """The file with the mistake, or ""."""
        return self.diagnostics[0].file if self.diagnostics else ""

    @property
    def line(self) -> int:
        return self.diagnostics[0].line if self.diagnostics else 0

    @property
    def column(self) -> int:
        return self.diagnostics[0].column if self.diagnostics else 0

    @property
    def remedy(self) -> str:
        """What to do about it, or ""."""
        return self.diagnostics[0].remedy if self.diagnostics else ""


class Warning(UserWarning):  # noqa: A001: always written as fovea.Warning
    """A warning: something that is allowed but probably not intended."""


def warn(messages: Iterable[Diagnostic]) -> None:
    for message in messages:
        warnings.warn(str(message), Warning, stacklevel=3)
