"""Parameters of graphs, as the framework reads them."""

from __future__ import annotations

from collections.abc import Mapping

Value = bool | int | float | str
Settings = Mapping[str, Value]


def texts(settings: Settings | None) -> list[str]:
    """{"bounces": 3, "blur.on": True} as ["bounces=3", "blur.on=true"]."""
    def text(value: Value) -> str:
        return ("true" if value else "false") if isinstance(value, bool) else str(value)

    return [f"{name}={text(value)}" for name, value in (settings or {}).items()]
