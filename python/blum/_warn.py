"""Warnings of results, as the library finds them."""

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
    """Warns where the package was called from."""
    frame, level = inspect.currentframe(), 1
    while frame is not None and os.path.dirname(frame.f_code.co_filename) == _FOLDER:
        frame, level = frame.f_back, level + 1
    warnings.warn(InputWarning(text, code), stacklevel=level)


def warn_all(found: Iterable[ResultWarning]) -> None:
    """The same of all that a result carries."""
    for warning in found:
        warn(warning.text, warning.code)
