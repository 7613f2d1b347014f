"""Progress of long calls."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

ProgressCallback = Callable[[float, str], object]
Progress = bool | ProgressCallback


@contextmanager
def reporting(progress: Progress) -> Iterator[ProgressCallback | None]:
    """Returns a context with the callback that the library calls with (fraction, phase).

    It is a tqdm bar for True, None for False, or the given function.
    """
    if progress is False or progress is None:
        yield None
    elif progress is True:
        with _Bar() as bar:
            yield bar.show
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress must be True, False or a function, not {type(progress).__name__}")


class _Bar:
    """Bar of tqdm that starts again with each phase."""

    def __init__(self) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError as error:
            raise ImportError("progress=True needs tqdm: pip install tqdm, or blum[progress]") from error
        self._bar: Any = tqdm(total=100, bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}", leave=False)

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.close()

    def show(self, fraction: float, phase: str) -> None:
        self._bar.set_description_str(phase, refresh=False)
        self._bar.n = round(100 * fraction, 1)
        self._bar.refresh()
