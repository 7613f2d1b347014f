"""Passes Blum's collision candidates to ipctk, the IPC Toolkit; the barrier equals that of ipctk's broad phase.

    python candidates_for_ipctk.py [START END] [-o FORCES.csv] [--dhat DISTANCE]

START and END are frames of one mesh. Without them, the mesh is a rolled sheet that a wave pushes into itself.

Contact potentials need pairs closer than DISTANCE at the start. The step length needs pairs that collide on the way to
the end. Blum returns exactly these pairs. The broad phase of ipctk returns pairs with touching boxes, and ipctk then
discards most of them.

Blum does not need ipctk (pip install ipctk). Without ipctk, this program prints that and does nothing.
"""

import argparse
import os
import pathlib
import sys
import time

import blum
import numpy as np

try:
    import ipctk
except ImportError:
    ipctk = None

TURNS, GAP = 4, 0.02  # of the rolled sheet; GAP lies between its layers


def rolled_sheet(along=120, across=60):
    """A sheet rolled up around z that does not touch itself, and its vertices after a push."""
    turn, height = np.meshgrid(np.linspace(0, TURNS, along), np.linspace(0, 2, across), indexing="ij")
    outwards = np.stack([np.cos(2 * np.pi * turn), np.sin(2 * np.pi * turn), 0 * turn], axis=-1)
    start = (0.15 + GAP * turn)[..., None] * outwards
    start[..., 2] = height
    push = GAP * np.cos(np.pi * turn) * np.sin(2 * np.pi * height)  # opposite for neighbouring layers
    number = np.arange(along * across).reshape(along, across)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    triangles = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    end = start + push[..., None] * outwards
    return blum.Mesh(start.reshape(-1, 3), triangles), end.reshape(-1, 3)


def timed(work):
    """The result of a call, and its seconds."""
    begin = time.perf_counter()
    value = work()
    return value, time.perf_counter() - begin


def handed_over(vertex_face, edge_edge):
    """ipctk's candidates for pairs of vertex and face and pairs of edges, by numbers in the mesh."""
    candidates = ipctk.Candidates()
    vertices, faces = vertex_face.T.tolist()
    candidates.fv_candidates = list(map(ipctk.FaceVertexCandidate, faces, vertices))
    candidates.ee_candidates = list(map(ipctk.EdgeEdgeCandidate, *edge_edge.T.tolist()))
    return candidates


def edge_numbers(edges, ends):
    """The rows of `edges`, as sorted by close_features(), that have these ends."""
    count = int(edges.max()) + 1
    first, second = np.sort(ends.astype(np.int64), axis=-1).T
    return np.searchsorted(edges[:, 0].astype(np.int64) * count + edges[:, 1], first * count + second)


def pairs_of(candidates):
    """The sets of (face, vertex) and (edge, edge) numbers."""
    faces = {(one.face_id, one.vertex_id) for one in candidates.fv_candidates}
    return faces, {tuple(sorted((one.edge0_id, one.edge1_id))) for one in candidates.ee_candidates}


def collisions_of(candidates, shape, positions, dhat):
    """The collisions over which the barrier sums."""
    collisions = ipctk.NormalCollisions()
    collisions.build(candidates, shape, positions, dhat)
    return collisions


def built(*arguments):
    """Candidates of ipctk's own broad phase."""
    candidates = ipctk.Candidates()
    candidates.build(*arguments, broad_phase=ipctk.LBVH())
    return candidates


def size(candidates):
    return f"{len(candidates.fv_candidates):,} vertex-face, {len(candidates.ee_candidates):,} edge-edge"


def compare_barriers(close, seconds, shape, positions, dhat):
    """Compares the barriers of both candidates; returns the forces on the vertices."""
    ours, handing = timed(lambda: handed_over(close.vertex_face, close.edge_edge))
    own, building = timed(lambda: built(shape, positions, dhat / 2))
    print(f"within {dhat:.4g}:")
    print(f"  Blum   {size(ours)}; {seconds:.3f} s, and {handing:.3f} s to hand them over")
    print(f"  ipctk  {size(own)}; {building:.3f} s")
    potential = ipctk.BarrierPotential(dhat, 1.0)
    answers = []
    for name, candidates in (("Blum", ours), ("ipctk", own)):
        found, seconds = timed(lambda candidates=candidates: collisions_of(candidates, shape, positions, dhat))
        energy, gradient = potential(found, shape, positions), potential.gradient(found, shape, positions)
        distance = np.sqrt(found.compute_minimum_distance(shape, positions))  # ipctk returns the squared distance
        print(f"  barrier of {name}'s: {energy:.12g}, smallest distance {distance:.12g}; sorted out in {seconds:.3f} s")
        answers.append((energy, distance, gradient))
    (energy, distance, gradient), (its_energy, its_distance, its_gradient) = answers
    assert np.isclose(energy, its_energy, rtol=1e-9) and np.isclose(distance, its_distance, rtol=1e-9)
    assert np.allclose(gradient, its_gradient, rtol=1e-6, atol=1e-9 * np.abs(its_gradient).max())
    if np.isfinite(distance):
        assert np.isclose(distance, close.min_distance, rtol=1e-9)
    return -gradient.reshape(-1, 3)


def compare_steps(mesh, shape, edges, positions, end):
    """Compares the steps that ipctk allows towards the end with the candidates of both."""
    found, seconds = timed(lambda: blum.continuous_collisions(mesh, end))
    vertex_face = np.column_stack([found.vertex_face[:, 0], found.face])
    edge_edge = np.column_stack([edge_numbers(edges, found.edge_edge[:, k : k + 2]) for k in (0, 2)])
    ours, handing = timed(lambda: handed_over(vertex_face, edge_edge))
    own, building = timed(lambda: built(shape, positions, end))
    print("between the frames:")
    print(f"  Blum   {size(ours)}; {seconds:.3f} s, and {handing:.3f} s to hand them over; first at {found.earliest}")
    print(f"  ipctk  {size(own)}; {building:.3f} s")
    assert all(mine <= theirs for mine, theirs in zip(pairs_of(ours), pairs_of(own), strict=True))
    steps = []
    for name, candidates in (("Blum", ours), ("ipctk", own)):
        step, seconds = timed(
            lambda candidates=candidates: candidates.compute_collision_free_stepsize(shape, positions, end)
        )
        print(f"  step by {name}'s: {step:.6f}, {seconds:.3f} s")
        steps.append(step)
    # ipctk stops before contact, and also for pairs that only pass close by. Its own candidates include such pairs.
    first = 1 if found.earliest is None else found.earliest
    assert steps[1] - 1e-5 <= steps[0] <= first + 1e-5  # times are early by at most 1e-6
    shorter = mesh.vertices + steps[0] * (end - mesh.vertices)
    assert steps[0] == 1 or blum.continuous_collisions(mesh, shorter).earliest is None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("frames", nargs="*", metavar="START END")
    parser.add_argument("-o", "--output", default="forces.csv")
    parser.add_argument("--dhat", type=float, default=1.2 * GAP)
    arguments = parser.parse_args()
    if len(arguments.frames) not in (0, 2):
        parser.error("give two frames of one mesh, or none")
    if not (arguments.dhat > 0 and np.isfinite(arguments.dhat)):
        parser.error(f"--dhat is {arguments.dhat}, but must be a distance above 0")
    output = pathlib.Path(arguments.output)
    if output.is_dir() or not os.access(output.resolve().parent, os.W_OK):
        parser.error(f"-o {output}: its folder is not there or may not be written, or it is a folder itself")
    if ipctk is None:
        print("skipped: ipctk is not installed; pip install ipctk")
        sys.exit()

    if arguments.frames:
        mesh, end = (blum.read_mesh(frame) for frame in arguments.frames)
        if not np.array_equal(mesh.triangles, end.triangles):
            parser.error("the frames must have the same triangles")
        end = end.vertices
    else:
        mesh, end = rolled_sheet()
    print(mesh)
    positions, end = np.asfortranarray(mesh.vertices), np.asfortranarray(end)
    # The barrier is 0 at dhat. A slightly larger distance prevents rounding from dropping pairs.
    close, seconds = timed(lambda: blum.close_features(mesh, arguments.dhat * (1 + 1e-9)))
    shape = ipctk.CollisionMesh(positions, close.edges, mesh.triangles)
    forces = compare_barriers(close, seconds, shape, positions, arguments.dhat)
    compare_steps(mesh, shape, close.edges, positions, end)

    rows = np.column_stack([mesh.vertices, forces])
    lines = ["x,y,z,force x,force y,force z", *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    output.write_text("\n".join(lines) + "\n")
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    try:
        main()
    except (OSError, blum.Error) as error:
        sys.exit(f"candidates_for_ipctk: error: {error}")
