"""Hostile closed solids with known Betti numbers: embedded meshes made by a seeded program, as input for tests."""

from .solids import MadeSolid, made_solid, made_solids, names

__all__ = ["MadeSolid", "made_solid", "made_solids", "names"]
