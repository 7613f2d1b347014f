"""Runs the command-line tool that comes with the package, in place of this process."""

import os
import sys
from pathlib import Path
from typing import NoReturn


def main() -> NoReturn:
    program = Path(__file__).parent / "_bin" / "blum"
    os.execv(program, [str(program), *sys.argv[1:]])


if __name__ == "__main__":
    main()
