"""Options of functions, as the library describes them."""

from __future__ import annotations

import difflib
import functools
import inspect
import re
import textwrap
from collections.abc import Callable, Collection
from typing import Any, TypeVar, cast

from . import _arguments, _core, _structs

_Taker = TypeVar("_Taker", bound=Callable[..., Any])


def default_of(options: str, option: str) -> Any:
    """Returns the library's default of an option."""
    return next(default for name, _, default, _, _ in _core.described[options]["members"] if name == option)


def takes(options: str, *left_out: str) -> Callable[[_Taker], _Taker]:
    """Returns a decorator for functions and classes that take **options.

    Their signature then names each option with its default. A line ``**options`` in their docstring becomes the
    documentation of all options. A keyword that does not exist raises a TypeError with the most similar one. For type
    checkers, the annotation ``Unpack[...]`` of blum._structs lists the same options.
    """
    members = [member for member in _core.described[options]["members"] if member[0] not in left_out]

    def documented(taker: _Taker) -> _Taker:
        function: Any = taker.__init__ if isinstance(taker, type) else taker  # type: ignore[misc]
        signature = inspect.signature(function)
        own = [each for each in signature.parameters.values() if each.kind is not each.VAR_KEYWORD]
        named = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=_type(kind))
            for name, kind, default, _, _ in members
        ]
        known = [each.name for each in (*own, *named) if each.name != "self" and each.kind is not each.VAR_POSITIONAL]
        checked = _checked(function, taker.__qualname__, known, left_out)
        checked.__signature__ = signature.replace(parameters=[*own, *named])
        made: Any = taker if isinstance(taker, type) else checked
        if isinstance(taker, type):
            made.__init__ = checked
        if taker.__doc__ is not None:
            text = "".join(_documented(*each) for each in members)
            indented = re.compile(r"^    ( *)\*\*options\n", re.MULTILINE)
            made.__doc__ = indented.sub(lambda line: textwrap.indent(text, line[1]), taker.__doc__)
        return cast(_Taker, made)

    return documented


def _checked(function: Any, name: str, known: list[str], left_out: tuple[str, ...]) -> Any:
    """Returns the function with a check of its keywords. Keywords that are left out are checked by the function."""
    accepted = {*known, *left_out}

    @functools.wraps(function)
    def checked(*arguments: Any, **keywords: Any) -> Any:
        for keyword in keywords:
            if keyword not in accepted:
                raise TypeError(f"{name}() has no option {keyword!r}: {_advice(keyword, known)}")
        return function(*arguments, **keywords)

    return checked


def _advice(keyword: str, known: Collection[str]) -> str:
    """Returns the most similar of the known keywords as a question, or all of them."""
    near = difflib.get_close_matches(keyword.lower(), known, 1)
    return f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known)}"


def _type(kind: str) -> Any:
    """Returns the type of a name that the library uses."""
    return eval(kind, {**vars(_arguments), **vars(_structs)})


def _documented(name: str, kind: str, default: Any, unit: str, doc: str) -> str:
    """Returns the documentation of one option."""
    text = f"{doc}{f' ({unit})' if unit else ''}. Default: {default!r}."
    lines = textwrap.fill(text[0].upper() + text[1:], 110, initial_indent=8 * " ", subsequent_indent=8 * " ")
    return f"    {name} : {_core.enums.get(kind, kind)}\n{lines}\n"
