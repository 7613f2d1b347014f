#!/usr/bin/env python3
"""Checks the English of documents, comments, docstrings and messages (CONTRIBUTING.md, "Words").

  tools/check_words.py              checks the files in tools/words-checked.txt; exits with 1 if a rule is broken
  tools/check_words.py PATH ...     checks these files or folders instead
  tools/check_words.py --count      counts broken rules in each folder, for all files

Rules:
- Programs return, report, list, contain or compute; they never tell.
- No sentence starts with "What", "Whether" or "Of", unless it is a question.
- Not "is no", except "there is no": "is not a", or another verb.
- A sentence has at most 25 words. Code in backquotes, a link's address, a formula and a number are one word each.
"""

import ast
import io
import pathlib
import re
import sys
import tokenize
from collections.abc import Iterator

from check_text import PROJECT, tracked_files

CHECKED = PROJECT / "tools/words-checked.txt"
MOST_WORDS = 25
FOLDERS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")
FOLDERS += ("docs", "include", "src", "apps", "python", "examples", "bench", "tests")
SUFFIXES = {".md", ".hpp", ".cpp", ".cu", ".cuh", ".py", ".ts"}

TELL = re.compile(r"\b(tells?|told|telling|retold)\b", re.IGNORECASE)
COMPARED = "more|less|larger|smaller|longer|shorter|further|farther|closer|later|wider"
IS_NO = re.compile(rf"(?<!there )\b(is|are|was|were) no\b(?! ({COMPARED})\b)", re.IGNORECASE)
FIRST_WORD = re.compile(r"^(What|Whether|Of)\b")
SENTENCE_END = re.compile(r"(?<=[.!?])[)\"']*\s+(?=[\"'(*]*[A-Z`\[])|(?<=:)\s*\n\s*\n")
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|cf|vs|etc|Fig|Sec|Eq|approx|ca|al|no|resp)\.$", re.IGNORECASE)
WORD = re.compile(r"[^\W_][\w'\u2019-]*")
# Neighbouring words that operators join.
FORMULA = re.compile(r"[\w.]+(\s*[=<>+*/^|\u2264\u2265\u00b7\u00d7]+\s*[\w.]+)+")

#: The first line of a piece of text, and the text.
Piece = tuple[int, str]


def markdown_pieces(text: str) -> Iterator[Piece]:
    """Paragraphs, list items, headings and table cells, without code."""
    start, lines, in_fence = 0, [], False
    for number, line in enumerate([*text.split("\n"), ""], 1):
        bare = line.strip()
        if bare.startswith(("```", "~~~")):
            in_fence = not in_fence
            bare = ""
        elif in_fence or (re.match(r"( {4}|\t)\S", line) and not lines):
            bare = ""
        is_row = bare.startswith("|")
        begins = not bare or is_row or re.match(r"([-*+]|\d+\.|#+|>)\s", bare)
        if begins and lines:
            yield start, " ".join(lines)
            lines = []
        if is_row:
            for cell in re.split(r"(?<!\\)\|", bare.strip("|")):
                yield number, cell.strip()
        elif bare and not bare.startswith(("<", "![")):
            if not lines:
                start = number
            lines.append(re.sub(r"^([-*+]|\d+\.|#+|>)\s+(\[[ x]\]\s+)?", "", bare))


CPP_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'', re.DOTALL)
TAG = re.compile(
    r"@(param|tparam)\s+[\w.\[\]]+(,\s*[\w.]+)*|@(returns?|throws?|pre|post|note|brief|error)\s*([A-Z]\w+,?\s)*"
)


def cpp_pieces(text: str, with_strings: bool) -> Iterator[Piece]:
    """Comments, with successive ones as one paragraph, and literals, with adjacent ones as one message."""
    comments: list[str] = []
    literals: list[str] = []
    comment_at = literal_at = last_comment = last_literal_end = 0
    for match in CPP_TOKEN.finditer(text):
        token, number = match[0], text.count("\n", 0, match.start()) + 1
        if token.startswith("'"):
            continue
        if token.startswith('"'):
            if not with_strings:
                continue
            if literals and text[last_literal_end : match.start()].strip(" \n") != "":
                yield literal_at, "".join(literals)
                literals = []
            if not literals:
                literal_at = number
            literals.append(token[1:-1].replace('\\"', '"').replace("\\n", "\n"))
            last_literal_end = match.end()
            continue
        said = re.sub(r"^(//[/!]?<?|/\*+)\s?|\*/$", "", token)
        begins_tag = re.match(r"\s*@\w+", said)
        alone = text[text.rfind("\n", 0, match.start()) + 1 : match.start()].strip() == ""
        if comments and (number != last_comment + 1 or begins_tag or not said.strip() or not alone):
            yield comment_at, " ".join(comments)
            comments = []
        if "NOLINT" in said or "clang-format" in said or "SPDX" in said:
            continue
        if said.strip():
            if not comments:
                comment_at = number
            comments.append(TAG.sub("", said).strip())
            last_comment = number + token.count("\n")
    if comments:
        yield comment_at, " ".join(comments)
    if literals:
        yield literal_at, "".join(literals)


def python_pieces(text: str, with_strings: bool) -> Iterator[Piece]:
    """Comments, docstrings without their examples, and other strings."""
    comments: list[str] = []
    start = last = 0
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            if comments and token.start[0] != last + 1:
                yield start, " ".join(comments)
                comments = []
            if not comments:
                start = token.start[0]
            comments.append(token.string.lstrip("#: "))
            last = token.start[0]
    if comments:
        yield start, " ".join(comments)
    nodes = list(ast.walk(ast.parse(text)))
    parts = {part for node in nodes if isinstance(node, ast.JoinedStr) for part in node.values}
    if not with_strings:
        nodes = [node.value for node in nodes if isinstance(node, ast.Expr)]  # docstrings
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in parts:
            yield from string_pieces(node.lineno, node.value)
        elif isinstance(node, ast.JoinedStr):
            said = "".join(part.value if isinstance(part, ast.Constant) else "1" for part in node.values)
            yield node.lineno, str(said)


def string_pieces(line: int, said: str) -> Iterator[Piece]:
    """Paragraphs of a docstring, without examples and names of parameters."""
    paragraph: list[str] = []
    start = line
    for offset, row in enumerate([*said.split("\n"), ""]):
        bare = row.strip()
        is_code = bare.startswith((">>>", "...", "---", "==="))
        is_name = re.fullmatch(r"\**[\w., *]+( : .*)?", bare) is not None and not bare.endswith(".")
        if (not bare or is_code or is_name) and paragraph:
            yield start, " ".join(paragraph)
            paragraph = []
        if bare and not is_code and not (is_name and "\n" in said):
            if not paragraph:
                start = line + offset
            paragraph.append(bare)


def sentences(piece: str) -> Iterator[str]:
    plain = re.sub(r"``?[^`]+``?", "Code", piece)
    plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", plain)
    plain = re.sub(r"https?://\S+", "Address", plain)
    held = ""
    for part in SENTENCE_END.split(plain):
        if part is None:
            continue
        held = f"{held} {part}".strip()
        if not ABBREVIATION.search(held.rstrip(")\"'")):
            yield held
            held = ""
    if held:
        yield held


def problems_of(sentence: str) -> list[str]:
    if len(re.findall(r"[A-Za-z]{2,}", sentence)) < 3:
        return []
    found = []
    if match := TELL.search(sentence):
        found.append(f"'{match[0]}'")
    if match := IS_NO.search(sentence):
        found.append(f"'{match[0]}'")
    start = sentence.lstrip("*_\"'( ")
    if (match := FIRST_WORD.match(start)) and not sentence.rstrip("*_\"') ").endswith("?"):
        found.append(f"starts with '{match[0]}'")
    words = len(WORD.findall(FORMULA.sub("Formula", sentence)))
    if words > MOST_WORDS:
        found.append(f"{words} words")
    return found


def pieces_of(path: pathlib.Path, text: str) -> Iterator[Piece]:
    """The texts of a file. Strings of tests are left out, because most of them are contents of files."""
    if path.suffix == ".md":
        return markdown_pieces(text)
    with_strings = not path.is_relative_to(PROJECT / "tests")
    if path.suffix == ".py":
        return python_pieces(text, with_strings)
    return cpp_pieces(text, with_strings)


def check(path: pathlib.Path) -> list[str]:
    text = path.read_text(encoding="utf-8")
    found = []
    for line, piece in pieces_of(path, text):
        for sentence in sentences(piece):
            start = " ".join(sentence.split())[:70]
            name = path.relative_to(PROJECT).as_posix()
            found += [f"{name}:{line}: {problem}: {start}" for problem in problems_of(sentence)]
    return found


def files_below(names: list[str]) -> list[pathlib.Path]:
    chosen = [PROJECT / name for name in names]
    return [
        path
        for path in tracked_files()
        if path.suffix in SUFFIXES and any(path == one or path.is_relative_to(one) for one in chosen)
    ]


def count() -> int:
    for folder in FOLDERS:
        found = [problem for path in files_below([folder]) for problem in check(path)]
        long = sum(" words: " in problem for problem in found)
        print(f"{folder:16} {len(found) - long:5} words and openings, {long:5} long sentences")
    return 0


def main(arguments: list[str]) -> int:
    if arguments == ["--count"]:
        return count()
    names = arguments or [
        line for line in CHECKED.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")
    ]
    files = files_below([name.rstrip("/") for name in names])
    found = [problem for path in files for problem in check(path)]
    print(*found, sep="\n", end="\n" if found else "")
    print(f"check_words: {len(files)} files, {len(found)} problems")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
