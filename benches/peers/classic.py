"""The classic scene with walls of another radius, from scenes/two-spheres.toml."""

import copy
import json
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Mitsuba meets spheres in f32 as they stand: at 1e4 a quarter of the light is gone.
WALL_RADIUS = 100.0

# Walls of this radius stand for planes: over the room they stray by 4e-8 from one.
PLANES = 1e9

# A sphere at least this large is a wall.
WALLS_FROM = 1e4


def classic(wall_radius=WALL_RADIUS):
    """The scene file as a dictionary, with walls of this radius in the same places."""
    text = (ROOT / "scenes" / "two-spheres.toml").read_text(encoding="utf-8")
    scene = copy.deepcopy(tomllib.loads(text))
    for sphere in scene["spheres"]:
        if sphere["radius"] >= WALLS_FROM:
            shrink = sphere["radius"] - wall_radius
            # The one coordinate that is not zero points from the room to the centre.
            sphere["center"] = [moved(x, shrink) for x in sphere["center"]]
            sphere["radius"] = wall_radius
    return scene


def moved(coordinate, by):
    """The coordinate, `by` nearer to zero; zero stays."""
    if coordinate == 0.0:
        return 0.0
    return coordinate - by if coordinate > 0.0 else coordinate + by


def as_toml(scene):
    """The scene as candor reads it."""
    lines = []
    for table in ("camera", "image", "render"):
        lines += [f"[{table}]", *pairs(scene[table])]
    for name, material in scene["materials"].items():
        lines += [f"[materials.{name}]", *pairs(material)]
    for sphere in scene["spheres"]:
        lines += ["[[spheres]]", *pairs(sphere)]
    return "\n".join(lines) + "\n"


def pairs(table):
    """Numbers, strings and lists of numbers are written in TOML as in JSON."""
    return [f"{key} = {json.dumps(value)}" for key, value in table.items()]
