"""Chooses how many cases of large families are tested.

`make test` tests a part of each family. If the environment variable BLUM_TESTS is "all", tests take all cases.
"""

import os

EVERYTHING = os.environ.get("BLUM_TESTS") == "all"


def some(items, count):
    """Returns all items if all cases are tested, else `count` of them, evenly spread."""
    items = list(items)
    if EVERYTHING or count >= len(items):
        return items
    return [items[k * len(items) // count] for k in range(count)]


def number(everything, usual):
    """Returns the number of random cases."""
    return everything if EVERYTHING else usual
