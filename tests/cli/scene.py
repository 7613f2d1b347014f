# Reads the scene of a viewer page.
import base64
import json
import re
import struct
import zlib

import numpy as np


class Scene:
    """The scene of a page or a server, as apps/cli/view/scene_blob.hpp lays it out."""

    def __init__(self, data):
        assert data[:8] == b"BLUMVIEW"
        version, length = struct.unpack("<II", data[8:16])
        assert version == 2 and length % 8 == 0
        self.header = json.loads(data[16:16 + length])
        self.body = data[16 + length:]

    def array(self, entry):
        assert entry["offset"] % 8 == 0
        stored = self.body[entry["offset"]:entry["offset"] + entry["bytes"]]
        assert len(stored) == entry["bytes"]
        raw = stored if entry["coding"] == "raw" else zlib.decompress(stored)
        if entry["coding"] == "delta":
            planes = np.frombuffer(raw, dtype=np.uint8).reshape(4, -1).astype(np.uint32)
            differences = planes[0] | planes[1] << 8 | planes[2] << 16 | planes[3] << 24
            raw = np.cumsum(differences, dtype=np.uint32).tobytes()
        values = np.frombuffer(raw, dtype="<" + entry["type"])
        assert len(values) == entry["count"]
        return values


def scene_of_page(path):
    text = path.read_text(encoding="utf-8")
    parts = re.findall(r'<script type="application/octet-stream" class="scene">([^<]*)</script>', text)
    assert parts
    return Scene(b"".join(base64.b64decode(part, validate=True) for part in parts))
