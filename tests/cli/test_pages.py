"""Each guide shows what the tool prints: commands of its code blocks run in order, and their output is compared.

Lines "..." stand for any lines. Times, memory and devices are not compared. A command is left out if it reads a file
that no command before it has made.
"""

import pathlib
import re
import shlex
import subprocess

import pytest
from tool import BLUM

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

PROJECT = pathlib.Path(__file__).resolve().parents[2]
PAGES = sorted((PROJECT / "docs/guide").glob("*.md"))
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"[\w*/.-]+\.(?:ply|obj|stl|off|nrrd|npy|npz|csv|vtp|vti|json|ma|xyz|nii\.gz|png|glb|html)$")
WRITES = {"-o", "--output", "--graph", "--extend", "--cleaned", "--json"}


def commands(text):
    """Pairs (command, expected lines) of a page. Output follows its command, or is the block after the commands."""
    found = []
    for _, block in BLOCK.findall(text):
        lines = block.replace("\\\n", " ").splitlines()
        if not any(re.match(r"(\$ )?blum ", line) for line in lines):
            is_code = any(line.startswith(("import ", "from ", "#", "make ", "python")) for line in lines)
            if found and lines and not is_code:
                found[-1][1].extend(lines if not found[-1][1] else [])
            continue
        for line in lines:
            if line.startswith(("$ ", "blum ")):
                found.append((line.removeprefix("$ "), []))
            elif found:
                found[-1][1].append(line)
    return found


def words_of(command):
    return shlex.split(command, comments=True)[1:]


def missing(words, folder):
    """Files that a command reads and that do not exist."""
    pairs = zip(["", *words], words, strict=False)
    read = [word for before, word in pairs if FILE.match(word) and before not in WRITES]
    return [name for name in read if not list(folder.glob(name))]


def same(line):
    """A line without what differs from run to run."""
    line = re.sub(r"\s+", " ", line).strip()
    return re.sub(r"^(time|wall|device) .*", "...", line)


def differences(expected, printed):
    """Expected lines that the output lacks, in order."""
    left = [same(line) for line in printed]
    gone = []
    for line in map(same, expected):
        if line in ("", "..."):
            continue
        if line in left:
            del left[: left.index(line) + 1]
        else:
            gone.append(line)
    return gone


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_pages_show_what_the_tool_prints(page, tmp_path):
    wrong = []
    for command, expected in commands(page.read_text(encoding="utf-8")):
        words = words_of(command) if command.startswith("blum ") else []
        serves = words[:1] == ["view"] and "-o" not in words
        if not words or serves or missing(words, tmp_path) or any(sign in words for sign in ("|", ">", "&&")):
            continue
        found = ((sorted(p.name for p in tmp_path.glob(word)) if "*" in word else [word]) for word in words)
        names = [name for group in found for name in group]
        done = subprocess.run([BLUM, *names], capture_output=True, timeout=300, check=False, cwd=tmp_path, text=True)
        for line in differences(expected, (done.stdout + done.stderr).splitlines()):
            wrong.append(f"{command}\n    {line}")
        if not expected:
            assert done.returncode in (0, 3), f"{command}\n{done.stderr}"
    assert not wrong, "\n".join(wrong)
