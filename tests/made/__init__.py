"""Hostile closed solids with known Betti numbers, as input for tests: embedded meshes from a seeded program."""

from .solids import MadeSolid, made_solid, made_solids, names

__all__ = ["MadeSolid", "made_solid", "made_solids", "names"]
