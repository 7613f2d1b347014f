# Proves that pages of `blum view` hold the exact data of its files and name unreadable files.
# The server serves the page and the scene to this machine, and nothing else.
import http.client
import os
import re
import resource
import signal
import socket
import subprocess
import time

import numpy as np
import pytest

from scene import Scene, scene_of_page
from tool import BLUM, read_png, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


def test_help_describes_output_server_and_exit_status():
    out, _ = run("view", "--help")
    for words in ("--output", "--port", "--open", "only this machine", "Exit status 1"):
        assert words in out


def test_a_page_holds_a_mesh_and_a_field_exactly(tmp_path, shapes):
    page = tmp_path / "page.html"
    out, _ = run("view", shapes / "sphere.ply", shapes / "sphere.npz", shapes / "ball.nrrd", "-o", page)
    assert "sphere.ply (mesh), sphere.npz (field), ball.nrrd (image)" in out
    scene = scene_of_page(page)
    mesh, field, image = scene.header["items"]
    assert mesh["kind"] == "mesh" and mesh["closed"] and mesh["name"] == "sphere.ply"
    positions = scene.array(mesh["positions"]).reshape(-1, 3) + mesh["origin"]
    assert np.allclose(np.linalg.norm(positions, axis=1), 1, atol=1e-6)
    assert scene.array(mesh["triangles"]).max() == len(positions) - 1
    with np.load(shapes / "sphere.npz") as file:
        assert np.array_equal(scene.array(field["distance"]), file["distance"].ravel())
        assert np.array_equal(scene.array(field["sites"]), file["site"].ravel())
        assert field["grid"]["size"] == list(file["distance"].shape[::-1])
        assert field["grid"]["origin"] == file["origin"].tolist()
    assert field["signed"] and field["band"] > 0 and field["units"] == "mesh units"
    assert image["labels"] and set(np.unique(scene.array(image["values"]))) == {0, 1}


def test_pages_are_named_by_what_they_show(tmp_path):
    strange = tmp_path / "a&b<c>.ply"
    for file in (strange, tmp_path / "box.ply"):
        run("make", "box", "-o", file)
    run("view", strange, "-o", tmp_path / "one.html")
    run("view", strange, tmp_path / "box.ply", "-o", tmp_path / "two.html")
    assert "<title>a&amp;b&lt;c&gt;.ply - Blum</title>" in (tmp_path / "one.html").read_text()
    assert "<title>a&amp;b&lt;c&gt;.ply and 1 more - Blum</title>" in (tmp_path / "two.html").read_text()


def test_files_of_pairs_get_a_hint_for_frames(tmp_path):
    for name in ("box.ply", "other.ply"):
        run("make", "box", "-o", tmp_path / name)
    run("proximity", "separation", tmp_path / "box.ply", tmp_path / "other.ply", "-o", tmp_path / "s.vtp")
    _, err = run("view", tmp_path / "box.ply", tmp_path / "s.vtp", "-o", tmp_path / "page.html", warns=True)
    assert "blum view FRAME... --frames --pairs PAIRS.json" in err


def test_nrrd_fields_without_a_band_and_files_of_sites_are_shown(tmp_path, shapes):
    run("view", shapes / "sphere.nrrd", shapes / "sphere.site.nrrd", "-o", tmp_path / "page.html")
    scene = scene_of_page(tmp_path / "page.html")
    field, sites = scene.header["items"]
    assert field["band"] is None
    assert sites["kind"] == "image" and np.array_equal(scene.array(sites["values"]), scene.array(field["sites"]))


def test_a_page_holds_an_axis_exactly(tmp_path, axes):
    run("view", axes / "torus.npz", *(axes / f"box.{end}" for end in ("vtp", "ma")), "-o", tmp_path / "page.html")
    scene = scene_of_page(tmp_path / "page.html")
    torus, box, plain = scene.header["items"]
    with np.load(axes / "torus.npz") as file:
        assert np.array_equal(scene.array(torus["vertices"]["positions"]), file["vertices"].ravel())
        assert np.array_equal(scene.array(torus["vertices"]["radii"]), file["radius"])
        footprints = np.stack([file["footprint_0"], file["footprint_1"]], axis=1)
        assert np.array_equal(scene.array(torus["vertices"]["footprints"]), footprints.ravel())
        assert np.array_equal(scene.array(torus["triangles"]), file["triangles"].ravel())
        assert np.array_equal(scene.array(torus["edge_roles"]), file["edge_role"])
    assert torus["betti"] == [1, 1, 0] and box["betti"] == [1, 0, 0]
    assert "least_theta" not in torus
    assert "radii" in plain["vertices"] and "footprints" not in plain["vertices"]


@pytest.fixture
def scene(tmp_path, solids):
    run("view", solids / "box.obj", "-o", tmp_path / "box.html")
    return scene_of_page(tmp_path / "box.html")


def slice_of_blocks(folder, distance, site, *options):
    """Colours [block, 3] in the picture of a field in which each block has one distance and one site."""
    blocks = [np.repeat(values, 8).reshape(1, 1, -1).repeat(8, axis=1) for values in (distance, site)]
    np.savez(folder / "blocks.npz", distance=blocks[0].astype("<f4"), site=blocks[1].astype("<i4"),
             origin=np.zeros(3), spacing=np.ones(3))
    run("slice", folder / "blocks.npz", "-o", folder / "blocks.png", "--scale", 5, *options)
    # Margins are 20 pixels wide, blocks 40.
    return read_png(folder / "blocks.png")[2][40, 40:40 + 40 * len(distance):40].astype(int)


@pytest.mark.parametrize(("ramp", "least"), [("diverging", -1), ("sequential", 0)])
def test_ramps_of_a_scene_are_those_of_pictures(tmp_path, scene, ramp, least):
    table = scene.array(scene.header["colors"][ramp]).reshape(-1, 4)
    assert table.shape == (512, 4) and (table[:, 3] == 255).all()
    entries = np.arange(0, 512, 73)
    distance = least + (1 - least) * entries / 511
    # Distances in single precision may round to the next byte.
    assert np.abs(slice_of_blocks(tmp_path, distance, 0 * entries) - table[entries, :3]).max() <= 1


def test_regions_of_a_scene_have_the_colours_of_pictures(tmp_path, scene):
    regions, palette = (scene.array(scene.header["colors"][name]).reshape(-1, 4) for name in ("regions", "palette"))
    ids = np.arange(len(regions))
    assert np.array_equal(slice_of_blocks(tmp_path, ids, ids, "--show", "sites"), regions[:, :3])
    assert palette.shape == (16 * 256, 4) and (palette[:, 3] == 255).all()
    # The palette has fewer hues, 1.4 degrees apart.
    away = np.abs(regions[:, None].astype(int) - palette[None]).max(axis=2)
    assert away.min(axis=1).max() <= 2


def test_a_scene_names_roles(scene):
    assert scene.header["roles"] == {"sheet": 0, "rim": 1, "seam": 2, "curve": 3, "junction": 4}


def test_nested_axes(tmp_path, solids):
    run("medial", solids / "box.obj", "-o", tmp_path / "box.npz", "--theta", 10, "--nested", "--resolution", 24)
    assert "all from 10 to 180 degrees" in run("info", tmp_path / "box.npz")[0]
    assert run_json("info", tmp_path / "box.npz")["nested_theta"] == 10
    whole = ["--resolution", 24, "--decimate", 0]
    run("medial", solids / "box.obj", "-o", tmp_path / "cut.npz", "--theta", "10,100", *whole)
    run("verify", solids / "box.obj", tmp_path / "box.npz")
    run("view", tmp_path / "box.npz", "-o", tmp_path / "page.html")
    scene = scene_of_page(tmp_path / "page.html")
    axis = scene.header["items"][0]
    assert axis["least_theta"] == 10
    until = scene.array(axis["triangle_until"])
    for theta in (10, 100):
        with np.load(tmp_path / f"cut-theta{theta}.npz") as file:
            corners = file["vertices"][file["triangles"]]
            flat = [(corners[:, a] == corners[:, b]).all(axis=1) for a, b in ((0, 1), (1, 2), (2, 0))]
            assert (until > theta).sum() == (~np.any(flat, axis=0)).sum()


@pytest.mark.parametrize("arguments", [("-o", "axis.vtp"), ("-o", "axis.npz", "--theta", "20,60"),
                                       ("-o", "axis.npz", "--prune", "sheets")])
def test_nested_is_rejected_with_options_that_exclude_it(tmp_path, solids, arguments):
    arguments = [tmp_path / word if word.startswith("axis") else word for word in arguments]
    _, err = run("medial", solids / "box.obj", "--nested", *arguments, status=2)
    assert "--nested" in err


def test_few_or_blockwise_whole_numbers_are_labels(tmp_path):
    rng = np.random.default_rng(1)
    few = rng.integers(0, 5, (8, 8, 8)).astype(np.uint8)
    grey = rng.integers(0, 4000, (16, 16, 16)).astype(np.int16)
    grey[:8] = 0
    many = np.kron(np.arange(1, 513, dtype=np.int32).reshape(8, 8, 8), np.ones((4, 4, 4), np.int32))
    for name, values, labels in (("few", few, True), ("grey", grey, False), ("many", many, True),
                                 ("real", few.astype(np.float32), False)):
        np.save(tmp_path / f"{name}.npy", values)
        run("view", tmp_path / f"{name}.npy", "-o", tmp_path / "page.html")
        item = scene_of_page(tmp_path / "page.html").header["items"][0]
        assert item["labels"] == labels, name


@pytest.mark.parametrize(("size", "shown"), [(1e-30, False), (1e-11, True), (1e29, True), (1e31, False)])
def test_sizes_that_browsers_cannot_draw_are_rejected(tmp_path, size, shown):
    (tmp_path / "part.obj").write_text(f"v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n")
    if shown:
        run("view", tmp_path / "part.obj", "-o", tmp_path / "page.html")
    else:
        _, err = run("view", tmp_path / "part.obj", "-o", tmp_path / "page.html", status=1)
        assert "cannot be drawn" in err and "scale it" in err


def test_whole_numbers_beyond_doubles_are_rejected(tmp_path):
    np.save(tmp_path / "big.npy", np.full((2, 2, 2), 2**53 + 1, dtype=np.int64))
    _, err = run("view", tmp_path / "big.npy", "-o", tmp_path / "page.html", status=1)
    assert "2^53" in err


def test_files_that_cannot_be_read_are_named_in_the_page(tmp_path, shapes):
    broken = tmp_path / "broken.ply"
    broken.write_text("ply\nformat nonsense\n")
    page = tmp_path / "page.html"
    _, err = run("view", broken, shapes / "sphere.ply", tmp_path / "gone.nrrd", "-o", page, warns=True)
    assert "broken.ply" in err and "gone.nrrd" in err
    first, mesh, last = scene_of_page(page).header["items"]
    assert first["kind"] == "error" and "broken.ply" in first["message"]
    assert mesh["kind"] == "mesh"
    assert last["kind"] == "error" and "gone.nrrd" in last["message"]


def test_nothing_is_written_if_no_file_is_readable(tmp_path):
    page = tmp_path / "page.html"
    page.write_text("before")
    _, err = run("view", tmp_path / "gone.ply", "-o", page, status=1)
    assert "gone.ply" in err and page.read_text() == "before"


@pytest.mark.parametrize("arguments, words", [
    (("-o", "page.txt"), ".html"),
    (("-o", "page.html", "--port", "8000"), "--port"),
    (("-o", "page.html", "--open"), "--open"),
    (("--port", "70000"), "65535"),
    (("--port", "x"), "--port"),
])
def test_bad_usage(tmp_path, shapes, arguments, words):
    arguments = [tmp_path / word if word.startswith("page") else word for word in arguments]
    _, err = run("view", shapes / "sphere.ply", *arguments, status=2)
    assert words in err


def serve(*files, **options):
    process = subprocess.Popen([BLUM, "view", *files], stdout=subprocess.PIPE, text=True, **options)
    text = process.stdout.readline() + process.stdout.readline()
    return process, int(re.search(r"http://127\.0\.0\.1:(\d+)/", text)[1])


@pytest.fixture
def server(shapes):
    process, port = serve(shapes / "sphere.ply")
    yield port
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=10) == 0, "Ctrl-C ends it cleanly"


def ask(port, path, method="GET", host=None):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.putrequest(method, path, skip_host=True)
    connection.putheader("Host", host or f"127.0.0.1:{port}")
    connection.endheaders()
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer, body


def test_the_server_serves_the_page_and_the_scene(server):
    answer, page = ask(server, "/")
    assert answer.status == 200 and page.startswith(b"<!doctype html>")
    assert b"<title>sphere.ply" in page and int(answer.headers["Content-Length"]) == len(page)
    assert answer.headers["Content-Type"].startswith("text/html")
    assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
    answer, data = ask(server, "/scene.bin?again", host=f"localhost:{server}")
    assert answer.status == 200 and Scene(data).header["items"][0]["name"] == "sphere.ply"
    answer, body = ask(server, "/scene.bin", method="HEAD")
    assert answer.status == 200 and body == b"" and int(answer.headers["Content-Length"]) == len(data)


@pytest.mark.parametrize("path", ["/sphere.ply", "/../sphere.ply", "//etc/passwd", "/%2e%2e/sphere.ply", "/scene.bin/..",
                                  "/index.html", "/favicon.ico", "scene.bin", "*"])
def test_the_server_serves_nothing_else(server, path):
    assert ask(server, path)[0].status == 404


def test_the_server_answers_no_other_host_and_no_other_method(server):
    for host in ("evil.example", f"evil.example:{server}", "127.0.0.1", f"127.0.0.1.evil.example:{server}"):
        assert ask(server, "/", host=host)[0].status == 403
    for method in ("POST", "PUT", "DELETE", "OPTIONS"):
        assert ask(server, "/", method=method)[0].status == 405


def test_the_server_survives_malformed_requests(server):
    for data in (b"", b"nonsense\r\n\r\n", b"GET / HTTP/1.1\r\n\r\n", b"\0" * 20000, b"GET  HTTP/1.1\r\nHost: x\r\n\r\n",
                 b"GET / HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nHost: evil\r\n\r\n" % server):
        with socket.create_connection(("127.0.0.1", server), timeout=10) as connection:
            connection.sendall(data)
            if data:
                head = connection.recv(100)
                assert head == b"" or re.match(rb"HTTP/1.1 4\d\d", head)
    assert ask(server, "/")[0].status == 200


def test_a_client_that_reads_nothing_does_not_block_others(shapes, tmp_path):
    np.save(tmp_path / "big.npy", np.random.default_rng(1).random((200, 200, 200), dtype=np.float32))
    process, port = serve(tmp_path / "big.npy")
    with socket.socket() as lazy:
        lazy.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        lazy.connect(("127.0.0.1", port))
        lazy.sendall(b"GET /scene.bin HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n" % port)
        answer, body = ask(port, "/scene.bin")
        assert answer.status == 200 and len(body) == int(answer.headers["Content-Length"]) > 32_000_000
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=10) == 0


def test_idle_connections_do_not_block_others(server):
    idle = [socket.create_connection(("127.0.0.1", server), timeout=10) for _ in range(80)]
    assert ask(server, "/")[0].status == 200
    for connection in idle:
        connection.close()


def test_the_server_waits_for_file_descriptors(shapes):
    process, port = serve(shapes / "sphere.ply", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (12, 12)))
    idle = [socket.create_connection(("127.0.0.1", port), timeout=10) for _ in range(20)]
    before = cpu_seconds(process)
    time.sleep(1)
    assert cpu_seconds(process) - before < 0.3, "it does not spin"
    for connection in idle:
        connection.close()
    assert ask(port, "/")[0].status == 200
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=10) == 0


def cpu_seconds(process):
    with open(f"/proc/{process.pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_the_server_is_on_the_loopback_only(server):
    address = "".join(f"{part:02X}" for part in (1, 0, 0, 127))
    with open("/proc/net/tcp", encoding="ascii") as table:
        listening = [line.split()[1] for line in table if line.split()[3] == "0A"]
    assert f"{address}:{server:04X}" in listening
    assert f"00000000:{server:04X}" not in listening


def test_a_port_in_use_is_reported(server, shapes):
    _, err = run("view", shapes / "sphere.ply", "--port", server, status=1)
    assert f"port {server}" in err
