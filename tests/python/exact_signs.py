"""Exact signs for the oracle of exact_structure.py, in Python's integers.

A face has an integer normal N, an integer offset D, and the length of N, which is the square root of an integer. The
distance from a point x inside to its plane is (D - N.x) / |N|. Four planes in (x, h) space meet in one point, and the
sign of a fifth one there is a determinant. It is linear in the lengths, so it is a sum of integers times square roots
of integers. Such a sum has an exact sign: it is zero exactly if the terms of each class of radicands cancel. Radicands
are in one class if their product is a square, and roots of different classes are independent over the rationals
(Besicovitch 1940).
"""

import itertools
import math
from fractions import Fraction

import numpy as np


def integers(points):
    """Float coordinates [n, 3] as integers, and the power of two by which they were multiplied."""
    ratios = [[float(x).as_integer_ratio() for x in point] for point in points]
    scale = max((denominator for point in ratios for _, denominator in point), default=1)
    return [tuple(n * (scale // d) for n, d in point) for point in ratios], scale


def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def determinant(rows):
    """The determinant of a square matrix of integers, by expansion along the first column."""
    if len(rows) == 2:
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    if len(rows) == 3:
        return dot(rows[0], cross(rows[1], rows[2]))
    total = 0
    for k, row in enumerate(rows):
        if row[0]:
            rest = determinant([other[1:] for i, other in enumerate(rows) if i != k])
            total += -row[0] * rest if k % 2 else row[0] * rest
    return total


def is_zero_root_sum(factors, radicands):
    """If the sum of factors times square roots of positive integers is zero."""
    classes = []
    for factor, radicand in zip(factors, radicands, strict=True):
        for entry in classes:
            root = math.isqrt(radicand * entry[0])
            if root * root == radicand * entry[0]:
                entry[1] += Fraction(factor * root, entry[0])
                break
        else:
            classes.append([radicand, Fraction(factor)])
    return all(total == 0 for _, total in classes)


def root_sum_sign(factors, radicands):
    """The sign (-1, 0, 1) of the sum of integer factors times square roots of positive integers. Exact."""
    for bits in itertools.count(64, 192):
        total = sum(c * math.isqrt(s << (2 * bits)) for c, s in zip(factors, radicands, strict=True))
        if abs(total) > sum(map(abs, factors)):  # Each root is short by less than one unit.
            return 1 if total > 0 else -1
        if bits == 64 and is_zero_root_sum(factors, radicands):
            return 0
    raise AssertionError("unreachable")


class ExactPlanes:
    """Half-spaces N.x + |N| h <= D of faces, followed by the half-space -h <= 0, with exact signs."""

    def __init__(self, normals, offsets):
        self.normals = [*normals, (0, 0, 0)]
        self.offsets = [*offsets, 0]
        self.squares = [*(dot(n, n) for n in normals), 1]
        self.directions = [1] * len(normals) + [-1]
        self._four, self._five = {}, {}

    def _sign(self, chosen, minors):
        factors = [
            self.directions[i] * (m if k % 2 else -m) for k, (i, m) in enumerate(zip(chosen, minors, strict=True))
        ]
        return root_sum_sign(factors, [self.squares[i] for i in chosen])

    def sign_of_four(self, chosen):
        """The sign of det(N, |N|) of four rows. They are sorted, and zero means that they meet in more than a point."""
        if chosen not in self._four:
            minors = [determinant([self.normals[i] for i in chosen if i != k]) for k in chosen]
            self._four[chosen] = self._sign(chosen, minors)
        return self._four[chosen]

    def sign_of_five(self, chosen):
        """The sign of det(N, |N|, D) of five sorted rows. Zero means that all of them pass one point."""
        if chosen not in self._five:
            rows = {i: (*self.normals[i], self.offsets[i]) for i in chosen}
            minors = [determinant([rows[i] for i in chosen if i != k]) for k in chosen]
            self._five[chosen] = self._sign(chosen, minors)
        return self._five[chosen]

    def beyond(self, three, j):
        """The sign of det(N, |N|) of three sorted rows, followed by row j."""
        sign = self.sign_of_four(tuple(sorted((*three, j))))
        return -sign if sum(i > j for i in three) % 2 else sign

    def side(self, four, j):
        """1 if the point of four sorted rows lies inside half-space j, 0 if it lies on its border, -1 outside."""
        if j in four:
            return 0
        chosen = tuple(sorted((*four, j)))
        below = sum(i > j for i in four)  # Row j moves from the last place across so many rows.
        sign = self.sign_of_five(chosen) * self.sign_of_four(four)
        return -sign if below % 2 else sign

    def point(self, four, bits=512):
        """The point (x, h) of four rows as floats, in the units of the integers. Right to the last digits."""
        rows = []
        for i in four:
            length = self.directions[i] * math.isqrt(self.squares[i] << (2 * bits))
            rows.append((*self.normals[i], length, self.offsets[i]))
        whole = determinant([row[:4] for row in rows])
        parts = [determinant([(*row[:k], row[4], *row[k + 1 : 4]) for row in rows]) for k in range(4)]
        parts[3] <<= bits
        return np.array([float(Fraction(part, whole)) for part in parts])


def exact_plane(a, b, c):
    """The integer normal of a triangle of integer points, and its offset."""
    normal = cross(minus(b, a), minus(c, a))
    return normal, dot(normal, a)


def float_plane(normal, offset, scale):
    """The unit normal and the offset of an integer plane as floats, each rounded a few times only."""
    bits = 128
    length = math.isqrt(dot(normal, normal) << (2 * bits))
    unit = np.array([float(Fraction(n << bits, length)) for n in normal])
    return unit, float(Fraction(offset << bits, length * scale))
