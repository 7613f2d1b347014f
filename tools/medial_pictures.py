#!/usr/bin/env python3
"""Draws a translucent solid with its medial axis from several sides as one PNG. Needs VTK and NumPy.

  medial_pictures.py MESH AXIS.npz ... -o OUT.png [--color radius|angle|sheet] [--views N] [--eye X,Y,Z]
                     [--size PIXELS]

MESH is .obj, .off, .stl or .ply; AXIS.npz comes from `blum medial`. Several axes stand side by side, each with its
theta, and share their colours. Sheets appear as surfaces, curves and narrow sheets as thick lines, isolated vertices as
dots.
"""

import argparse
import colorsys
import json
import os
import pathlib
import sys

if not os.environ.get("DISPLAY"):  # else VTK searches for a screen and reports an error
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

TITLES = {"radius": "Radius", "angle": "Separation angle (degrees)", "sheet": "Sheet"}
OVERSAMPLING = 2  # Drawn pixels per pixel of the picture, along each axis.
BAR_HEIGHT = 90  # pixels
CAPTION_HEIGHT = 36  # pixels
NARROW = 1 / 150  # Sheets with a smaller mean width, relative to the axis, appear as lines.
# Directions from the middle of the solid to the eye. The first directions show the most.
EYES = [(1, -1.6, 0.9), (-1.6, -1, 0.7), (0, 0, 1), (0, -1, 0), (1, 0, 0), (-1, 1.6, -0.9)]


def read_off(path: pathlib.Path) -> vtk.vtkPolyData:
    words = [word for line in path.read_text().splitlines() for word in line.split("#")[0].split()]
    if not words or words[0] != "OFF":
        sys.exit(f"{path}: no OFF file in text form")
    points, faces = int(words[1]), int(words[2])
    place = 4 + 3 * points
    vertices = np.array(words[4:place], dtype=float).reshape(-1, 3)
    polygons = []
    for _ in range(faces):
        count = int(words[place])
        polygons.append([int(word) for word in words[place + 1 : place + 1 + count]])
        place += 1 + count
    triangles = [[polygon[0], b, c] for polygon in polygons for b, c in zip(polygon[1:], polygon[2:])]
    return poly_data(vertices, triangles=np.array(triangles))


def read_mesh(path: pathlib.Path) -> vtk.vtkPolyData:
    readers = {".obj": vtk.vtkOBJReader, ".stl": vtk.vtkSTLReader, ".ply": vtk.vtkPLYReader}
    suffix = path.suffix.lower()
    if not path.is_file():
        sys.exit(f"{path}: no such file")
    if suffix == ".off":
        return read_off(path)
    if suffix not in readers:
        sys.exit(f"{path}: a mesh is .obj, .off, .stl or .ply")
    reader = readers[suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def cells(corners: np.ndarray) -> vtk.vtkCellArray:
    array = vtk.vtkCellArray()
    offsets = np.arange(0, corners.size + 1, corners.shape[1], dtype=np.int64)
    array.SetData(
        numpy_to_vtkIdTypeArray(offsets, deep=True),
        numpy_to_vtkIdTypeArray(np.ascontiguousarray(corners.ravel(), dtype=np.int64), deep=True),
    )
    return array


def poly_data(vertices: np.ndarray, *, triangles=None, edges=None, points=None) -> vtk.vtkPolyData:
    data = vtk.vtkPolyData()
    places = vtk.vtkPoints()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(vertices, dtype=float), deep=True))
    data.SetPoints(places)
    if triangles is not None:
        data.SetPolys(cells(triangles))
    if edges is not None:
        data.SetLines(cells(edges))
    if points is not None:
        data.SetVerts(cells(points.reshape(-1, 1)))
    return data


def sheet_table(count: int) -> vtk.vtkLookupTable:
    """Hues that differ most between sheets with neighbouring numbers; the last colour is for cells without a sheet."""
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(count + 1)
    for sheet in range(count):
        table.SetTableValue(sheet, *colorsys.hsv_to_rgb(sheet * 0.61803398875 % 1, 0.6, 0.9))
    table.SetTableValue(count, 0.2, 0.2, 0.2)
    table.SetRange(-0.5, count + 0.5)
    return table


def smooth_table(low: float, high: float) -> vtk.vtkColorTransferFunction:
    """Dark blue over green to yellow, with rising lightness for grey prints and colour-blind readers."""
    colors = [(0.27, 0.0, 0.33), (0.23, 0.32, 0.55), (0.13, 0.57, 0.55), (0.37, 0.79, 0.38), (0.99, 0.91, 0.15)]
    table = vtk.vtkColorTransferFunction()
    for place, color in zip(np.linspace(low, high if high > low else low + 1, len(colors)), colors):
        table.AddRGBPoint(place, *color)
    return table


class Axis:
    """The arrays of a medial axis, and the numbers that colour its cells."""

    def __init__(self, path: pathlib.Path, color: str):
        if not path.is_file():
            sys.exit(f"{path}: no such file")
        try:
            file = np.load(path)
        except (ValueError, OSError) as error:
            sys.exit(f"{path}: not an .npz file: {error}")
        with file:
            if "vertices" not in file or "edges" not in file or "triangles" not in file:
                sys.exit(f"{path}: not a medial axis: vertices, edges or triangles are missing")
            arrays = {name: file[name] for name in file.files}
        self.vertices = arrays["vertices"]
        self.edges = arrays["edges"].reshape(-1, 2).astype(np.int64)
        self.triangles = arrays["triangles"].reshape(-1, 3).astype(np.int64)
        self.edges = self.curves()
        sheet = arrays["triangle_sheet"] if "triangle_sheet" in arrays else np.zeros(len(self.triangles), dtype=np.int64)
        self.edges = np.concatenate([self.edges, self.sides_of_narrow_sheets(sheet)])
        used = np.zeros(len(self.vertices), dtype=bool)
        used[self.edges.ravel()] = True
        used[self.triangles.ravel()] = True
        self.points = np.flatnonzero(~used)
        self.on_cells = color == "sheet"
        name = {"radius": "radius", "angle": "separation_angle", "sheet": "triangle_sheet"}[color]
        if name not in arrays:
            sys.exit(f"{path}: no array {name}, which --color {color} needs")
        self.values = arrays[name].astype(float)
        metadata = json.loads(str(arrays["metadata"])) if "metadata" in arrays else {}
        theta = metadata.get("theta")
        self.caption = path.stem if theta is None else f"theta {theta} degrees"

    def curves(self) -> np.ndarray:
        """The edges that are not sides of a triangle."""
        count = len(self.vertices)
        sides = np.sort(self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges = np.sort(self.edges, axis=1)
        return self.edges[~np.isin(edges @ [count, 1], sides @ [count, 1])]

    def sides_of_narrow_sheets(self, sheet: np.ndarray) -> np.ndarray:
        """The sides of triangles of sheets that would be too narrow to see as surfaces."""
        if len(self.triangles) == 0:
            return self.triangles[:, :2]
        corners = self.vertices[self.triangles]
        sides = np.roll(corners, -1, axis=1) - corners
        area = np.bincount(sheet, weights=0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1))
        low = np.full((len(area), 3), np.inf)
        high = np.full((len(area), 3), -np.inf)
        for corner in range(3):
            np.minimum.at(low, sheet, corners[:, corner])
            np.maximum.at(high, sheet, corners[:, corner])
        length = np.linalg.norm(high - low, axis=1)
        whole = np.ptp(self.vertices, axis=0).max()
        narrow = self.triangles[(area < NARROW * whole * length)[sheet]]
        return np.concatenate([narrow[:, [0, 1]], narrow[:, [1, 2]], narrow[:, [2, 0]]])

    def sheet_count(self) -> int:
        return int(self.values.max()) + 1 if len(self.values) else 0

    def part(self, kind: str) -> vtk.vtkPolyData:
        corners = getattr(self, kind)
        data = poly_data(self.vertices, **{kind: corners})
        if self.on_cells:
            values = self.values if kind == "triangles" else np.full(len(corners), float(self.sheet_count()))
            data.GetCellData().SetScalars(numpy_to_vtk(values, deep=True))
        else:
            data.GetPointData().SetScalars(numpy_to_vtk(self.values, deep=True))
        return data


def table_of(axes: list[Axis], color: str):
    """The common colours of all axes."""
    if color == "sheet":
        return sheet_table(max(axis.sheet_count() for axis in axes))
    values = np.concatenate([axis.values for axis in axes])
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    return smooth_table(low if low > 0.1 * high else 0.0, 180.0 if color == "angle" else high)


def solid_actor(mesh: vtk.vtkPolyData) -> vtk.vtkActor:
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(mesh)
    normals.SetFeatureAngle(30)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.62, 0.68, 0.76)
    actor.GetProperty().SetOpacity(0.16)
    actor.GetProperty().SetSpecular(0.2)
    return actor


def axis_actor(axis: Axis, kind: str, table, pixels: int) -> vtk.vtkActor:
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(axis.part(kind))
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetInterpolationToFlat()
    look.SetAmbient(0.35)
    look.SetDiffuse(0.65)
    look.SetLineWidth(pixels / 120)
    look.SetPointSize(pixels / 90)
    look.RenderLinesAsTubesOn()
    look.RenderPointsAsSpheresOn()
    return actor


def empty_view() -> vtk.vtkRenderer:
    view = vtk.vtkRenderer()
    view.SetBackground(1, 1, 1)
    return view


def frame(camera: vtk.vtkCamera, eye: tuple[float, float, float], points: np.ndarray) -> None:
    """Sets a parallel projection from the direction of the eye in which all points just fit."""
    back = np.array(eye, dtype=float) / np.linalg.norm(eye)
    up = np.array((0, 1, 0) if eye[0] == eye[1] == 0 else (0, 0, 1), dtype=float)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    axes = np.array([right, up, back])
    low, high = (points @ axes.T).min(axis=0), (points @ axes.T).max(axis=0)
    middle = axes.T @ ((low + high) / 2)
    size = float(np.linalg.norm(high - low)) or 1.0
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + 2 * size * back))
    camera.SetViewUp(*up)
    camera.SetParallelScale(0.53 * max(high[0] - low[0], high[1] - low[1], 1e-6 * size))
    camera.SetClippingRange(size, 3 * size)


def view_of(actors: list[vtk.vtkActor], eye: tuple[float, float, float], points: np.ndarray) -> vtk.vtkRenderer:
    view = empty_view()
    for actor in actors:
        view.AddActor(actor)
    view.SetUseDepthPeeling(True)
    view.SetMaximumNumberOfPeels(12)
    view.SetOcclusionRatio(0.0)
    kit = vtk.vtkLightKit()
    kit.SetKeyLightIntensity(0.8)
    kit.SetKeyToFillRatio(1.6)
    kit.AddLightsToRenderer(view)
    frame(view.GetActiveCamera(), eye, points)
    return view


def color_bar(table, title: str) -> vtk.vtkRenderer:
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.3g")
    bar.SetMaximumNumberOfColors(256)
    bar.UnconstrainedFontSizeOn()
    heading = vtk.vtkTextActor()
    heading.SetInput(title)
    heading.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    heading.GetPositionCoordinate().SetValue(0.5, 0.72)
    heading.GetTextProperty().SetJustificationToCentered()
    for text in (heading.GetTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.SetFontFamilyToArial()
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
        text.SetFontSize(15 * OVERSAMPLING)
    bar.SetPosition(0.2, 0.05)
    bar.SetWidth(0.6)
    bar.SetHeight(0.6)
    strip = empty_view()
    strip.AddViewProp(bar)
    strip.AddViewProp(heading)
    return strip


def caption(text: str) -> vtk.vtkRenderer:
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.GetPositionCoordinate().SetValue(0.5, 0.25)
    look = actor.GetTextProperty()
    look.SetJustificationToCentered()
    look.SetColor(0.1, 0.1, 0.1)
    look.SetFontFamilyToArial()
    look.SetFontSize(17 * OVERSAMPLING)
    strip = empty_view()
    strip.AddViewProp(actor)
    return strip


class Panels:
    """Parts of a picture with their contents. Pixels count from the upper left corner."""

    def __init__(self, width: int, height: int):
        self.size = (width, height)
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetAlphaBitPlanes(1)
        self.window.SetMultiSamples(0)  # depth peeling, which orders translucent surfaces, excludes it
        self.window.SetSize(width * OVERSAMPLING, height * OVERSAMPLING)

    def add(self, view: vtk.vtkRenderer, left: int, top: int, width: int, height: int) -> None:
        across, down = self.size
        view.SetViewport(left / across, 1 - (top + height) / down, (left + width) / across, 1 - top / down)
        self.window.AddRenderer(view)


def draw(mesh: vtk.vtkPolyData, axes: list[Axis], options: argparse.Namespace) -> None:
    table = table_of(axes, options.color)
    size = options.size
    eyes = ([options.eye] if options.eye else []) + EYES
    points = np.concatenate([vtk_to_numpy(mesh.GetPoints().GetData())] + [axis.vertices for axis in axes])
    has_captions = len(axes) > 1
    # Several axes have one column each and one row for each view. The views of one axis fill row after row.
    columns = len(axes) if has_captions else 2 if options.views == 4 else min(options.views, 3)
    rows = options.views if has_captions else -(-options.views // columns)
    top = CAPTION_HEIGHT if has_captions else 0
    bar_height = 0 if options.color == "sheet" else BAR_HEIGHT  # numbers of sheets have no meaning
    panels = Panels(columns * size, top + rows * size + bar_height)
    actors = []
    for axis in axes:
        kinds = [kind for kind in ("triangles", "edges", "points") if len(getattr(axis, kind))]
        actors.append([axis_actor(axis, kind, table, size * OVERSAMPLING) for kind in kinds] + [solid_actor(mesh)])
    for place in range(rows * columns):
        column, row = place % columns, place // columns
        which, eye = (column, row) if has_captions else (0, place)
        view = view_of(actors[which], eyes[eye], points) if eye < options.views else empty_view()
        panels.add(view, column * size, top + row * size, size, size)
    for column, axis in enumerate(axes if has_captions else []):
        panels.add(caption(axis.caption), column * size, 0, size, CAPTION_HEIGHT)
    if bar_height:
        panels.add(color_bar(table, TITLES[options.color]), 0, top + rows * size, columns * size, bar_height)
    panels.window.Render()
    save(panels.window, options.output, panels.size)


def save(window: vtk.vtkRenderWindow, path: pathlib.Path, size: tuple[int, int]) -> None:
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.SetInputBufferTypeToRGB()
    image.ReadFrontBufferOff()
    image.Update()
    drawn = image.GetOutput()
    pixels = vtk_to_numpy(drawn.GetPointData().GetScalars()).astype(float)
    blocks = pixels.reshape(size[1], OVERSAMPLING, size[0], OVERSAMPLING, 3)
    mean = np.round(blocks.mean(axis=(1, 3))).astype(np.uint8).reshape(-1, 3)
    result = vtk.vtkImageData()
    result.SetDimensions(size[0], size[1], 1)
    result.GetPointData().SetScalars(numpy_to_vtk(mean, deep=True, array_type=vtk.VTK_UNSIGNED_CHAR))
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(result)
    writer.Write()
    if writer.GetErrorCode() != 0:
        sys.exit(f"{path}: cannot be written")


def direction(text: str) -> tuple[float, ...]:
    numbers = tuple(float(part) for part in text.split(","))
    if len(numbers) != 3 or not any(numbers):
        raise argparse.ArgumentTypeError("three numbers, not all 0")
    return numbers


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Draws a solid and its medial axis, seen from several sides.")
    parser.add_argument("mesh", type=pathlib.Path, help="the solid: .obj, .off, .stl or .ply")
    parser.add_argument("axes", type=pathlib.Path, nargs="+", metavar="AXIS", help="its medial axis, or several: .npz")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the picture: .png")
    parser.add_argument("--color", choices=list(TITLES), default="radius")
    parser.add_argument("--views", type=int, default=3, choices=range(1, len(EYES) + 1), help="number of sides")
    parser.add_argument("--eye", type=direction, metavar="X,Y,Z", help="where the first view is from")
    parser.add_argument("--size", type=int, default=700, help="pixels along the sides of each view")
    options = parser.parse_args()
    if not 100 <= options.size <= 4000:
        parser.error("--size must be 100 to 4000")
    return options


def main() -> None:
    options = parse()
    draw(read_mesh(options.mesh), [Axis(path, options.color) for path in options.axes], options)


if __name__ == "__main__":
    main()
