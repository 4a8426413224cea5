"""The scenes that the renderers are compared on, each described once: SCENES maps a name to what makes it.

As a program it writes them as files of the renderers: scenes.py FOLDER [--size PIXELS] [--suffix S] [NAME...].
"""
import argparse
from pathlib import Path

import numpy as np

from shapes import (BLACK, Camera, Diffuse, Mesh, Rectangle, RoughMetal, Scene, Sphere, Texels, block, ceiling_lamp,
                    floor, grid_mesh, join)

WHITE, RED, GREEN = Diffuse((0.73, 0.73, 0.73)), Diffuse((0.63, 0.06, 0.05)), Diffuse((0.14, 0.45, 0.09))
BLUE, SAND = Diffuse((0.2, 0.35, 0.6)), Diffuse((0.6, 0.5, 0.38))
STEEL = ((2.9, 2.9, 2.6), (3.1, 3.0, 2.8))  # eta and k


def metal(alpha):
    return RoughMetal(alpha, *STEEL)


def room(scene, half, left, right, is_closed):
    """Walls that face inwards around the cube of that half edge; the wall towards +z only where closed."""
    scene.add("floor", Rectangle((0, -half, 0), (half, 0, 0), (0, 0, -half)), WHITE)
    scene.add("ceiling", Rectangle((0, half, 0), (half, 0, 0), (0, 0, half)), WHITE)
    scene.add("back", Rectangle((0, 0, -half), (half, 0, 0), (0, half, 0)), WHITE)
    scene.add("left", Rectangle((-half, 0, 0), (0, 0, -half), (0, half, 0)), left)
    scene.add("right", Rectangle((half, 0, 0), (0, 0, half), (0, half, 0)), right)
    if is_closed:
        scene.add("front", Rectangle((0, 0, half), (-half, 0, 0), (0, half, 0)), WHITE)


def two_blocks(scene):
    scene.add("tall", block((-0.65, -1, -0.65), (-0.1, 0.2, -0.1), 18), WHITE)
    scene.add("short", block((0.05, -1, -0.35), (0.6, -0.45, 0.2), -17), WHITE)


def box():
    scene = Scene("box", "a closed diffuse box with two blocks under one square in the ceiling",
                  Camera((0, 0.1, 0.98), (0, -0.25, -1), 72))
    room(scene, 1, RED, GREEN, is_closed=True)
    two_blocks(scene)
    scene.add("lamp", ceiling_lamp((0, 0.995, -0.1), 0.3, 0.3), BLACK, (12, 10, 8))
    return scene


def cornell():
    scene = Scene("cornell", "a Cornell box by paths, light at any number of bounces",
                  Camera((0, 0, 3.9), (0, 0, 0), 38), is_by_paths=True)
    room(scene, 1, RED, GREEN, is_closed=False)
    two_blocks(scene)
    scene.add("lamp", ceiling_lamp((0, 0.995, 0), 0.25, 0.2), BLACK, (17, 12, 7))
    return scene


def plates():
    """After Veach 1997, figure 9.2: lamps of equal power and different size, plates of different roughness, each
    plate tilted so that the camera sees the lamps mirrored in its middle."""
    eye = np.array([0, 2.6, 8.5])
    scene = Scene("plates", "four squares of different size and equal power over three rough metal plates, smooth to "
                  "rough", Camera(tuple(eye), (0, 0.8, 0), 36))
    scene.add("floor", floor(12), Diffuse((0.25, 0.25, 0.25)))
    scene.add("back", Rectangle((0, 12, -4), (12, 0, 0), (0, 12, 0)), Diffuse((0.25, 0.25, 0.25)))
    lamps = np.array([0.0, 4.2, -1.0])
    for number, (height, depth, alpha) in enumerate([(1.6, -1.2, 0.01), (0.9, 0.6, 0.04), (0.45, 2.4, 0.12)]):
        middle = np.array([0, height, depth])
        to_eye, to_lamps = eye - middle, lamps - middle
        normal = to_eye / np.linalg.norm(to_eye) + to_lamps / np.linalg.norm(to_lamps)
        normal /= np.linalg.norm(normal)
        across = np.array([1.0, 0, 0])
        scene.add(f"plate_{number}", Rectangle(tuple(middle), tuple(2.6 * across),
                                               tuple(0.55 * np.cross(normal, across))), metal(alpha))
    colours = np.array([(1, 0.5, 0.4), (0.9, 0.9, 0.4), (0.5, 1, 0.6), (0.5, 0.6, 1)])
    for number, half in enumerate([0.03, 0.09, 0.27, 0.6]):
        place = lamps + (-2.25 + 1.5 * number, 0, 0)
        facing = np.array([0, -1.0, 0.9])
        facing /= np.linalg.norm(facing)
        lamp = Rectangle(tuple(place), (half, 0, 0), tuple(half * np.cross(facing, (1.0, 0, 0))))
        scene.add(f"lamp_{number}", lamp, BLACK, tuple(colours[number] * 6 / lamp.area()))
    return scene


def stand(scene, ground=SAND):
    """A floor with a few things on it, diffuse and metal by turns."""
    scene.add("floor", floor(10), ground)
    scene.add("back", Rectangle((0, 3, -4.5), (10, 0, 0), (0, 3, 0)), SAND)
    scene.add("diffuse_block", block((-1.9, 0, -1.2), (-0.9, 1.1, -0.2), 25), BLUE)
    scene.add("metal_block", block((0.7, 0, -1.4), (1.7, 0.9, -0.4), -20), metal(0.15))
    scene.add("metal_ball", Sphere((-0.1, 0.45, 0.5), 0.45), metal(0.08))
    scene.add("diffuse_ball", Sphere((1.3, 0.35, 0.9), 0.35), RED)


# Lamps are above what it sees, lest their edges in the picture be most of the variance.
STAND_CAMERA = Camera((0, 2.1, 6.5), (0, 0.45, 0), 28)


def mesh_light():
    scene = Scene("mesh_light", "one lamp of 20,000 triangles, a ring with bumps, over a floor with five things",
                  STAND_CAMERA)
    stand(scene)

    def ring(u, v):
        angle, around = 2 * np.pi * u, 2 * np.pi * v
        radius = 0.28 * (1 + 0.25 * np.sin(9 * angle) * np.cos(3 * around))
        far = 1.1 + radius * np.cos(around)
        flat = np.stack([far * np.cos(angle), radius * np.sin(around), -far * np.sin(angle)], -1)
        tilt = np.radians(35)
        turn = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
        return flat @ turn.T + (0, 3.1, -0.3)

    scene.add("lamp", grid_mesh(ring, 50, 200), BLACK, (4, 3.4, 2.6))
    return scene


def swarm(scene, count, groups, corners, low, high):
    """Small lamps between two corners, turned anyhow but rather down, of areas over a factor of 16; groups meshes of
    radiances over a factor of 64. All together always have 2 m^2 and 40 W, before colours."""
    random = np.random.default_rng(count)
    place = random.uniform(low, high, (count, 3))
    facing = random.normal(size=(count, 3)) + (0, -0.7, 0)
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    across = np.cross(facing, random.normal(size=(count, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    up = np.cross(facing, across)
    area = 2.0 ** random.uniform(0, 4, count)
    area *= 2 / area.sum()
    # The distance of a corner from the middle, of a regular polygon of unit area
    reach = np.sqrt(area * 2 / (corners * np.sin(2 * np.pi / corners)))
    angles = 2 * np.pi * np.arange(corners) / corners
    points = place[:, None] + reach[:, None, None] * (np.cos(angles)[None, :, None] * across[:, None] +
                                                      np.sin(angles)[None, :, None] * up[:, None])
    group = random.integers(0, groups, count)
    strength = 2.0 ** (6 * np.arange(groups) / max(groups - 1, 1))
    strength *= 40 / (np.pi * float((area * strength[group]).sum()))
    fan = np.array([(0, i, i + 1) for i in range(1, corners - 1)])
    for number in range(groups):
        mine = np.flatnonzero(group == number)
        faces = (np.arange(len(mine)) * corners)[:, None, None] + fan[None]
        hue = 2 * np.pi * number / groups
        colour = 1 + 0.4 * np.cos(hue + np.array([0, 2.1, 4.2]))
        scene.add(f"lamps_{number}", Mesh(points[mine].reshape(-1, 3), faces.reshape(-1, 3)), BLACK,
                  tuple(strength[number] * colour))


def many_lights(count, groups, corners):
    shape = {3: "triangles", 4: "squares"}[corners]
    meshes = f"{groups} meshes of different radiance" if groups > 1 else "one mesh of one radiance"
    scene = Scene(f"many_lights_{count}", f"{count:,} small {shape} in {meshes} over a floor with five things",
                  STAND_CAMERA)
    stand(scene)
    swarm(scene, count, groups, corners, (-3, 2.2, -2.5), (3, 3.8, 2))
    return scene


def glossy_floor():
    scene = Scene("glossy_floor", "1,000 small squares in 8 meshes over a floor of rough metal", STAND_CAMERA)
    stand(scene, metal(0.1))
    swarm(scene, 1000, 8, 4, (-3, 2.2, -2.5), (3, 3.8, 2))
    return scene


def hidden_lights():
    """Rooms of 4 m x 4 m x 2.6 m, five by four. Walls between neighbours have a gap of a door with the door in it,
    turned open by 25 degrees."""
    columns, rows, size, height, thick, gap, open_deg = 5, 4, 4.0, 2.6, 0.1, 0.9, 25
    home = (2, 1)
    center = size * (np.array(home) + 0.5)
    scene = Scene("hidden_lights", "20 rooms with 10 lamps each, doors ajar, the camera in one of them",
                  Camera((center[0] - 1.7, 1.6, center[1] + 1.7), (center[0] + 0.6, 0.4, center[1] - 0.6), 52))
    wide, deep = columns * size, rows * size
    scene.add("floor", Rectangle((wide / 2, 0, deep / 2), (wide / 2, 0, 0), (0, 0, -deep / 2)), SAND)
    scene.add("ceiling", Rectangle((wide / 2, height, deep / 2), (wide / 2, 0, 0), (0, 0, deep / 2)), WHITE)
    walls, doors = [], []

    def wall(start, end, has_door):
        """Upright along x or z; with a door in the middle."""
        start, end = np.array(start, float), np.array(end, float)
        along = (end - start) / np.linalg.norm(end - start)
        side = np.abs(along[::-1]) * thick / 2
        pieces = [(start, end)]
        if has_door:
            middle = (start + end) / 2
            hinge, latch = middle - along * gap / 2, middle + along * gap / 2
            pieces = [(start, hinge), (latch, end)]
            lintel = (hinge - side, latch + side)
            walls.append(block((lintel[0][0], 2.1, lintel[0][1]), (lintel[1][0], height, lintel[1][1])))
            angle = np.radians(open_deg)
            turned = np.array([along[0] * np.cos(angle) - along[1] * np.sin(angle),
                               along[0] * np.sin(angle) + along[1] * np.cos(angle)])
            leaf = hinge + turned * gap / 2
            doors.append(block((leaf[0] - gap / 2, 0.01, leaf[1] - 0.02), (leaf[0] + gap / 2, 2.09, leaf[1] + 0.02),
                               -np.degrees(np.arctan2(turned[1], turned[0]))))
        for low, high in pieces:
            walls.append(block((low[0] - side[0], 0, low[1] - side[1]), (high[0] + side[0], height, high[1] + side[1])))

    for i in range(columns + 1):
        for j in range(rows):
            wall((i * size, j * size), (i * size, (j + 1) * size), 0 < i < columns)
    for j in range(rows + 1):
        for i in range(columns):
            wall((i * size, j * size), ((i + 1) * size, j * size), 0 < j < rows)
    scene.add("walls", join(walls), WHITE)
    scene.add("doors", join(doors), RED)
    tables = [block((x * size + 1.4, 0, z * size + 1.5), (x * size + 2.6, 0.75, z * size + 2.3), 15)
              for x in range(columns) for z in range(rows)]
    scene.add("tables", join(tables), BLUE)
    random = np.random.default_rng(20)
    for x in range(columns):
        for z in range(rows):
            for number in range(10):
                place = (x * size + random.uniform(0.5, size - 0.5), height - random.uniform(0.02, 0.6),
                         z * size + random.uniform(0.5, size - 0.5))
                half = random.uniform(0.04, 0.14)
                power = 2.0 ** random.uniform(0, 3)
                scene.add(f"lamp_{x}_{z}_{number}", ceiling_lamp(place, half, half), BLACK,
                          tuple(np.array([1, 0.85, 0.7]) * power / (4 * half * half)))
    return scene


def sliver_light():
    scene = Scene("sliver_light", "a lamp of 3 m by 2 mm over a floor with five things", STAND_CAMERA)
    stand(scene)
    scene.add("lamp", ceiling_lamp((0, 2.6, -0.2), 1.5, 0.001), BLACK, (4000, 3600, 3000))
    return scene


def wall_light():
    scene = Scene("wall_light", "a square lamp that touches a wall, and one that stands on the floor",
                  Camera((2.2, 2.3, 5.0), (-0.3, 0.8, -0.6), 40))
    scene.add("floor", floor(6), SAND)
    scene.add("wall", Rectangle((0, 3, -2), (6, 0, 0), (0, 3, 0)), WHITE)
    scene.add("block", block((-1.6, 0, -1.2), (-0.8, 0.9, -0.4), 25), BLUE)
    scene.add("ball", Sphere((0.8, 0.4, -0.6), 0.4), metal(0.15))
    scene.add("shelf_lamp", ceiling_lamp((0, 2, -1.5), 0.5, 0.5), BLACK, (6, 5, 4))
    scene.add("standing_lamp", Rectangle((-1.9, 0.3, 0.2), (-0.4, 0, 0), (0, 0.3, 0)), BLACK, (5, 5, 6))
    return scene


def textured_emitter():
    """Like a wall of screens: a dim picture, few bright windows, one spot a thousand times as bright."""
    random = np.random.default_rng(6)
    y, x = np.mgrid[0:96, 0:160]
    colors = 0.4 + 0.3 * np.stack([np.sin(x / 9), np.cos(y / 7), np.sin((x + y) / 13)], -1)
    for _ in range(12):
        left, top = random.integers(0, 150), random.integers(0, 88)
        colors[top:top + 6, left:left + 8] = random.uniform(4, 30, 3)
    colors[40:60, 20:50] = 0
    colors[70, 120] = (4000, 3200, 2400)
    scene = Scene("textured_emitter", "a picture of 160 x 96 texels that shines, one of them most, over a floor with five "
                  "things", STAND_CAMERA)
    stand(scene)
    scene.add("screen", Rectangle((0, 2.2, -0.4), (1.2, 0, 0), (0, 0, 0.72)), BLACK, Texels(colors))
    return scene


SCENES = {
    "box": box,
    "plates": plates,
    "mesh_light": mesh_light,
    "many_lights_100": lambda: many_lights(100, 8, 4),
    "many_lights_10000": lambda: many_lights(10_000, 8, 3),
    "many_lights_200000": lambda: many_lights(200_000, 1, 3),
    "cornell": cornell,
    "hidden_lights": hidden_lights,
    "sliver_light": sliver_light,
    "wall_light": wall_light,
    "glossy_floor": glossy_floor,
    "textured_emitter": textured_emitter,
}


def main():
    from scene_files import write_scene  # It needs what is above through its callers only.
    parser = argparse.ArgumentParser(description="Write the scenes as files of Etendue and Mitsuba 3.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help=f"of {', '.join(SCENES)} (default: all)")
    parser.add_argument("--size", type=int, default=512, help="pixels each way [512]")
    parser.add_argument("--suffix", default="", help="after each file's name")
    options = parser.parse_args()
    for name in options.names or SCENES:
        if name not in SCENES:
            parser.error(f"unknown scene '{name}'; known: {', '.join(SCENES)}")
        scene = SCENES[name]()
        for path in write_scene(scene, options.folder, options.size, options.suffix):
            print(f"{path}: {scene.about}")


if __name__ == "__main__":
    main()
