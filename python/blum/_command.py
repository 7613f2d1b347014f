"""Command-line tool of the package, which replaces this process."""

import os
import sys
from pathlib import Path
from typing import NoReturn


def main() -> NoReturn:
    """Replaces this process by the tool, with the same arguments."""
    program = Path(__file__).parent / "_bin" / "blum"
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
