# Runs the command-line tool for the tests in this folder, and reads pictures.
import json
import os
import struct
import subprocess
import zlib
from pathlib import Path

import numpy as np

BLUM = os.environ.get("BLUM_CLI", "")
FORMATS = ["vtp", "ply", "obj", "ma", "npz"]  # file formats of medial axes


def run(*arguments, status=0, timeout=60, warns=False):
    """Runs the tool, and checks its exit status and stderr: warnings only if `warns`, and one error only on failure."""
    done = subprocess.run([BLUM, *map(str, arguments)], capture_output=True, timeout=timeout, check=False)
    out, err = done.stdout.decode(), done.stderr.decode()
    assert done.returncode == status, f"{arguments}: status {done.returncode}, expected {status}\n{out}\n{err}"
    lines = err.splitlines()
    first = next((k for k, line in enumerate(lines) if not line.startswith("blum: warning: ")), len(lines))
    assert status != 0 or first == len(lines), err
    assert (first > 0) == warns, err
    if status != 0:
        assert first < len(lines) <= first + 3 and lines[first].startswith("blum: error: "), err
    return out, err


def run_json(*arguments, warns=False):
    out, _ = run(*arguments, "--json", "-", warns=warns)
    return json.loads(out)


def names(folder):
    return sorted(path.name for path in Path(folder).iterdir())


def png_rows(path):
    """Width, height and filtered rows of a PNG of 8-bit RGB, after a test of its checksums."""
    data = Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(data):
        (size,) = struct.unpack(">I", data[at:at + 4])
        name, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        assert zlib.crc32(name + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
        chunks[name] = chunks.get(name, b"") + body
        at += 12 + size
    width, height, depth, kind = struct.unpack(">IIBB", chunks[b"IHDR"][:10])
    assert (depth, kind) == (8, 2) and b"IEND" in chunks
    return width, height, np.frombuffer(zlib.decompress(chunks[b"IDAT"]), dtype=np.uint8).reshape(height, 1 + 3 * width)


def read_png(path):
    """Width, height and pixels [row, column, 3] of a PNG of 8-bit RGB."""
    width, height, raw = png_rows(path)
    rows, above = [], np.zeros(3 * width, dtype=np.int64)
    for line in raw:
        row = unfilter(int(line[0]), line[1:].astype(np.int64), above)
        rows.append(row)
        above = row
    return width, height, np.array(rows, dtype=np.uint8).reshape(height, width, 3)


def unfilter(kind, line, above):
    if kind == 0:
        return line
    if kind == 2:
        return (line + above) % 256
    row = np.zeros_like(line)
    for i, value in enumerate(line):
        left = row[i - 3] if i >= 3 else 0
        corner = above[i - 3] if i >= 3 else 0
        if kind == 1:
            guess = left
        elif kind == 3:
            guess = (left + above[i]) // 2
        else:
            estimate = left + above[i] - corner
            guess = min((left, above[i], corner), key=lambda n, e=estimate: abs(e - n))
        row[i] = (value + guess) % 256
    return row
