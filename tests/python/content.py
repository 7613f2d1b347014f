"""Content of results, for tests that compare results. Representations are short, so equal ones prove little."""

import dataclasses

import blum
import numpy as np

#: Members that differ between calls, or belong to the input.
LEFT_OUT = ("seconds", "_handle", "_mesh", "_others")


def content_of(value):
    """The content of a result as bytes, without times and the sources of meshes."""
    if isinstance(value, np.ndarray):
        return str(value.dtype), value.shape, value.tobytes()
    if isinstance(value, (tuple, list)):
        return [content_of(part) for part in value]
    if isinstance(value, dict):
        return {name: content_of(part) for name, part in value.items()}
    if isinstance(value, blum.Mesh):
        return [content_of(part) for part in (value.vertices, value.triangles, value.segments, value.points)]
    if isinstance(value, blum.Field):
        arrays = (value.distance, value.site, value.distance2, value.site2)
        return [content_of(part) for part in (*arrays, value.sign_rule, value.grid)]
    if isinstance(value, blum.Complex):
        columns = (value.vertex_columns, value.edge_columns, value.triangle_columns)
        return [content_of(part) for part in (value.vertices, value.edges, value.triangles, *map(dict, columns))]
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if field.name not in LEFT_OUT]
        return type(value).__name__, {name: content_of(getattr(value, name)) for name in names}
    return repr(value)
