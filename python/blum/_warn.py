"""Warnings of results."""

from __future__ import annotations

import inspect
import os
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ._errors import InputWarning

if TYPE_CHECKING:
    from ._structs import ResultWarning, WarningCode

_FOLDER = os.path.dirname(__file__)


def warn(text: str, code: WarningCode) -> None:
    """Issues an InputWarning at the line that called the package."""
    frame, level = inspect.currentframe(), 1
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == _FOLDER:
        frame, level = frame.f_back, level + 1
    warnings.warn(InputWarning(text, code), stacklevel=level)


def warn_all(found: Iterable[ResultWarning]) -> None:
    """Issues all warnings of a result."""
    for warning in found:
        warn(warning.text, warning.code)
