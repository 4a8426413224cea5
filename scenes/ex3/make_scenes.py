#!/usr/bin/env python3
"""Makes the two scenes of exercise 3: meshes, XML files and the regions that the report measures.

Plain Python without packages, and deterministic: running it again changes no byte. Lengths in the still life are in
decimetres, in the plate scene in metres.
"""
import json
import math
from pathlib import Path

HERE = Path(__file__).resolve().parent
MESHES = HERE / "meshes"
WIDTH, HEIGHT = 768, 512


# --- vectors ---------------------------------------------------------------------------------------------------------

def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return mul(a, 1.0 / math.sqrt(dot(a, a)))


# --- meshes: a list of points and a list of faces (indices, counter-clockwise seen from the front) -------------------

def vertex_normals(points, faces):
    """Area-weighted mean of the normals of the faces around each vertex."""
    sums = [(0.0, 0.0, 0.0)] * len(points)
    for a, b, c in faces:
        n = cross(sub(points[b], points[a]), sub(points[c], points[a]))
        for i in (a, b, c):
            sums[i] = add(sums[i], n)
    return [unit(n) for n in sums]


def write_obj(name, what, points, faces):
    lines = [f"# {what}; written by make_scenes.py"]
    lines += ["v %.5f %.5f %.5f" % p for p in points]
    lines += ["vn %.4f %.4f %.4f" % n for n in vertex_normals(points, faces)]
    lines += ["f " + " ".join(f"{i + 1}//{i + 1}" for i in face) for face in faces]
    # "-0.00000" and "0.00000" are one number: write one text for it
    text = "\n".join(lines).replace(" -0.00000", " 0.00000").replace(" -0.0000", " 0.0000")
    (MESHES / f"{name}.obj").write_text(text + "\n")


def grid_faces(rows, columns, wrap_rows=False, wrap_columns=False):
    """Two triangles for each cell of a grid whose vertex (row, column) has the index row * columns + column."""
    faces = []
    for r in range(rows if wrap_rows else rows - 1):
        for c in range(columns if wrap_columns else columns - 1):
            r1, c1 = (r + 1) % rows, (c + 1) % columns
            a, b, d, e = r * columns + c, r * columns + c1, r1 * columns + c, r1 * columns + c1
            faces += [(a, b, e), (a, e, d)]
    return faces


def spline(knots, steps):
    """Centripetal-free Catmull-Rom curve through 2D knots; the end knots are reached."""
    points = []
    k = [knots[0]] + list(knots) + [knots[-1]]
    for i in range(1, len(k) - 2):
        for s in range(steps):
            t = s / steps
            points.append(tuple(
                0.5 * (2 * k[i][d] + (k[i + 1][d] - k[i - 1][d]) * t
                       + (2 * k[i - 1][d] - 5 * k[i][d] + 4 * k[i + 1][d] - k[i + 2][d]) * t * t
                       + (3 * k[i][d] - k[i - 1][d] - 3 * k[i + 1][d] + k[i + 2][d]) * t ** 3) for d in (0, 1)))
    return points + [knots[-1]]


def lathe(profile, segments):
    """Turns a profile of (radius, height) about the y axis. It runs from the axis to the axis, counter-clockwise in
    the (radius, height) plane: up along the outside, so that the front of every face is outside."""
    ring = [(math.cos(2 * math.pi * j / segments), -math.sin(2 * math.pi * j / segments)) for j in range(segments)]
    inner = profile[1:-1]
    points = [(r * c, y, r * s) for r, y in inner for c, s in ring]
    faces = grid_faces(len(inner), segments, wrap_columns=True)
    first, last = len(points), len(points) + 1
    points += [(0.0, profile[0][1], 0.0), (0.0, profile[-1][1], 0.0)]
    top = (len(inner) - 1) * segments
    for j in range(segments):
        k = (j + 1) % segments
        faces.append((first, k, j))
        faces.append((last, top + j, top + k))
    return points, faces


def sphere(radius, rings, segments):
    profile = [(radius * math.sin(math.pi * i / rings), -radius * math.cos(math.pi * i / rings))
               for i in range(rings + 1)]
    return lathe(profile, segments)


def tube(path, radius, segments):
    """A closed-ended pipe along a path in the xy plane; its ends are open and belong inside another mesh."""
    points = []
    for i, (x, y) in enumerate(path):
        x0, y0 = path[max(i - 1, 0)]
        x1, y1 = path[min(i + 1, len(path) - 1)]
        length = math.hypot(x1 - x0, y1 - y0)
        nx, ny = (y1 - y0) / length, -(x1 - x0) / length
        for j in range(segments):
            a = 2 * math.pi * j / segments
            points.append((x + radius * math.cos(a) * nx, y + radius * math.cos(a) * ny, 1.25 * radius * math.sin(a)))
    return points, [(a, c, b) for a, b, c in grid_faces(len(path), segments, wrap_columns=True)]


def join(*meshes):
    points, faces = [], []
    for p, f in meshes:
        faces += [tuple(i + len(points) for i in face) for face in f]
        points += p
    return points, faces


def rectangle(center, half_u, half_v):
    """Front side towards half_u x half_v."""
    corners = [sub(sub(center, half_u), half_v), sub(add(center, half_u), half_v),
               add(add(center, half_u), half_v), add(sub(center, half_u), half_v)]
    return corners, [(0, 1, 2), (0, 2, 3)]


def frame_towards(position, target):
    """Two unit vectors u, v with u x v pointing from position to target, u level."""
    w = unit(sub(target, position))
    u = unit(cross((0.0, 1.0, 0.0), w))
    return u, cross(w, u)


def area(points, faces):
    total = 0.0
    for a, b, c in faces:
        n = cross(sub(points[b], points[a]), sub(points[c], points[a]))
        total += 0.5 * math.sqrt(dot(n, n))
    return total


# --- camera ----------------------------------------------------------------------------------------------------------

class Camera:
    def __init__(self, origin, target, fov_deg):
        self.origin, self.target, self.fov_deg = origin, target, fov_deg
        self.forward = unit(sub(target, origin))
        self.right = unit(cross(self.forward, (0.0, 1.0, 0.0)))
        self.up = cross(self.right, self.forward)
        self.half_width = math.tan(math.radians(fov_deg) / 2)

    def project(self, point):
        """Image fractions (x from the left, y from the top)."""
        d = sub(point, self.origin)
        z = dot(d, self.forward) * self.half_width
        return 0.5 + 0.5 * dot(d, self.right) / z, 0.5 - 0.5 * dot(d, self.up) / z * WIDTH / HEIGHT

    def direction(self, x, y):
        sx = (2 * x - 1) * self.half_width
        sy = (1 - 2 * y) * self.half_width * HEIGHT / WIDTH
        return unit(add(self.forward, add(mul(self.right, sx), mul(self.up, sy))))

    def xml(self):
        text = lambda v: ", ".join(f"{x:g}" for x in v)
        return f"""\
	<!-- In this dialect a bare lookat gives a mirror image: the scale turns it back. -->
	<camera type="perspective">
		<transform name="toWorld">
			<scale value="-1, 1, 1"/>
			<lookat origin="{text(self.origin)}" target="{text(self.target)}" up="0, 1, 0"/>
		</transform>
		<float name="fov" value="{self.fov_deg:g}"/>
		<integer name="width" value="{WIDTH}"/>
		<integer name="height" value="{HEIGHT}"/>
	</camera>
"""


# --- XML -------------------------------------------------------------------------------------------------------------

def numbers(values):
    return ", ".join(f"{v:.6g}" for v in values)


def mesh_xml(file, inside, moves=()):
    transform = ""
    if moves:
        transform = "\t\t<transform name=\"toWorld\">\n" + "".join(f"\t\t\t{m}\n" for m in moves) + "\t\t</transform>\n"
    return (f'\t<mesh type="obj">\n\t\t<string name="filename" value="meshes/{file}.obj"/>\n{transform}'
            + "".join(f"\t\t{line}\n" for line in inside.strip().split("\n")) + "\t</mesh>\n")


def diffuse(color):
    return f'<bsdf type="diffuse">\n\t<color name="albedo" value="{numbers(color)}"/>\n</bsdf>'


def phong(kd, ks, n):
    return (f'<bsdf type="phong">\n\t<color name="kd" value="{numbers(kd)}"/>\n'
            f'\t<color name="ks" value="{numbers(ks)}"/>\n\t<float name="n" value="{n:g}"/>\n</bsdf>')


def light(radiance):
    return (f'<luminaire type="area">\n\t<color name="radiance" value="{numbers(radiance)}"/>\n</luminaire>\n'
            + diffuse((0, 0, 0)))


def scene_xml(comment, samples, camera, body):
    return f"""<?xml version="1.0" encoding="utf-8"?>
<!-- {comment} -->
<scene>
	<!-- light: area sampling of the lights. The others: direct (BRDF sampling), average, mis. -->
	<integrator type="light"/>

	<sampler type="sobol">
		<integer name="sampleCount" value="{samples}"/>
	</sampler>

{camera.xml()}
{body}</scene>
"""


# --- the still life --------------------------------------------------------------------------------------------------

def cloth():
    """A napkin of 2.6 x 2.0 with folds that run across it; it lies on the table with its rim just above it."""
    rows, columns = 57, 73
    points = []
    for i in range(rows):
        v = i / (rows - 1)
        for j in range(columns):
            u = j / (columns - 1)
            rim = min(1.0, 7 * min(u, 1 - u, 1 - v, 0.05 + v))
            fold = 0.5 + 0.5 * math.sin(2 * math.pi * (2.6 * u + 0.55 * v + 0.13 * math.sin(5 * v + 1)))
            ripple = 0.5 + 0.5 * math.sin(9 * u - 7 * v + 2 * math.sin(4 * u))
            y = 0.01 + rim * (0.38 * fold ** 2 * (0.35 + 0.65 * v) + 0.05 * ripple)
            x = 2.6 * (u - 0.5) + 0.10 * math.sin(4.2 * v + 0.4)
            z = 2.0 * (0.5 - v) + 0.08 * math.sin(5.1 * u)
            points.append((x, y, z))
    return points, grid_faces(rows, columns)


def backdrop():
    """The table, curving up into a wall behind it."""
    profile = [(14.0, 0.0), (-4.0, 0.0)]
    profile += [(-4.0 - 3.5 * math.sin(a), 3.5 - 3.5 * math.cos(a))
                for a in (math.pi / 2 * i / 24 for i in range(1, 25))]
    profile += [(-7.5, 16.0)]
    points = [(x, y, z) for z, y in profile for x in (-18.0, 18.0)]
    return points, grid_faces(len(profile), 2)


def make_still_life():
    vase = lathe(spline([(0, 0.0), (0.55, 0.0), (0.66, 0.08), (0.95, 0.75), (1.12, 1.45), (0.92, 2.2), (0.50, 2.85),
                         (0.40, 3.2), (0.52, 3.52), (0.60, 3.62), (0.56, 3.66), (0.45, 3.5), (0.32, 3.2),
                         (0.42, 2.8), (0.6, 2.2), (0.5, 1.0), (0, 0.5)], 5), 64)
    bowl = lathe(spline([(0, 0.0), (0.62, 0.0), (0.70, 0.05), (0.72, 0.16), (1.10, 0.38), (1.45, 0.74), (1.62, 1.12),
                         (1.60, 1.17), (1.54, 1.13), (1.36, 0.78), (1.0, 0.46), (0.5, 0.28), (0, 0.24)], 4), 72)
    cup = lathe(spline([(0, 0.0), (0.36, 0.0), (0.43, 0.05), (0.55, 0.35), (0.60, 0.75), (0.62, 1.06), (0.60, 1.09),
                        (0.57, 1.05), (0.54, 0.75), (0.49, 0.38), (0.38, 0.14), (0, 0.10)], 4), 56)
    handle = tube(spline([(0.52, 0.90), (0.74, 0.93), (0.95, 0.78), (0.93, 0.50), (0.74, 0.31), (0.47, 0.30)], 6), 0.06,
                  14)
    apple = lathe(spline([(0, 0.10), (0.14, 0.04), (0.28, 0.03), (0.52, 0.25), (0.60, 0.58), (0.50, 0.88), (0.28, 1.0),
                          (0.12, 0.95), (0, 0.84)], 5), 44)
    pear = lathe(spline([(0, 0.05), (0.16, 0.0), (0.40, 0.12), (0.56, 0.45), (0.52, 0.78), (0.34, 1.08), (0.22, 1.36),
                         (0.17, 1.52), (0.09, 1.58), (0, 1.56)], 5), 44)
    egg = lathe([(0.36 * math.sin(t) * (1 + 0.16 * math.cos(t)), -0.47 * math.cos(t))
                 for t in (math.pi * i / 28 for i in range(29))], 40)
    stem = lathe(spline([(0, 0.0), (0.03, 0.0), (0.025, 0.15), (0.035, 0.3), (0, 0.31)], 3), 10)
    write_obj("vase", "vase: a lathed shell with an outside and an inside", *vase)
    write_obj("bowl", "bowl", *bowl)
    write_obj("cup", "cup with a handle", *join(cup, handle))
    write_obj("apple", "apple", *apple)
    write_obj("pear", "pear", *pear)
    write_obj("stem", "stem of an apple or a pear", *stem)
    write_obj("egg", "egg, long axis upright", *egg)
    write_obj("cloth", "folded napkin", *cloth())
    write_obj("backdrop", "table that curves up into a wall", *backdrop())

    window_at, lamp_at, tube_at = (-7.0, 5.6, 3.0), (4.6, 6.4, 1.6), (0.5, 7.6, -3.4)
    for name, what, at, target, half in (
            ("light_window", "large light: a window of 4.4 x 3.2", window_at, (0.0, 0.5, 0.0), (2.2, 1.6)),
            ("light_lamp", "small light: 0.7 x 0.7", lamp_at, (0.2, 0.5, 0.2), (0.35, 0.35)),
            ("light_tube", "narrow light: a tube of 6 x 0.16", tube_at, (0.2, 0.8, 0.0), (3.0, 0.08))):
        u, v = frame_towards(at, target)
        write_obj(name, what, *rectangle(at, mul(u, half[0]), mul(v, half[1])))

    camera = Camera((0.1, 5.6, 15.0), (0.15, 1.1, 0.0), 30)

    def at(x, y, z, *before):
        return [*before, f'<translate value="{x:g}, {y:g}, {z:g}"/>']

    def turn(axis, angle):
        return f'<rotate axis="{axis}" angle="{angle:g}"/>'

    red, green, skin = phong((0.50, 0.05, 0.04), (0.04, 0.04, 0.04), 60), \
        phong((0.38, 0.42, 0.07), (0.04, 0.04, 0.04), 60), phong((0.62, 0.50, 0.12), (0.03, 0.03, 0.03), 40)
    wood = diffuse((0.16, 0.09, 0.05))
    body = f"""\
	<!-- Lights: three, all outside the picture. They emit towards the still life only. -->

	<!-- A large cool one from the left: wide penumbras. -->
{mesh_xml("light_window", light((5.4, 6.5, 8.2)))}
	<!-- A small warm one from the right: shadows with a narrow penumbra. -->
{mesh_xml("light_lamp", light((230, 165, 92)))}
	<!-- A long narrow one from behind: shadows that are soft along it and sharp across it. -->
{mesh_xml("light_tube", light((30, 27, 31)))}
	<!-- The table. -->
{mesh_xml("backdrop", diffuse((0.60, 0.58, 0.54)))}
	<!-- On the left: a glazed vase and a folded napkin. -->
{mesh_xml("vase", phong((0.03, 0.10, 0.20), (0.10, 0.10, 0.10), 80), at(-2.3, 0, -0.8, '<scale value="0.86, 0.86, 0.86"/>'))}
{mesh_xml("cloth", diffuse((0.62, 0.27, 0.17)), at(-1.75, 0, 2.15, turn("0, 1, 0", 24)))}
	<!-- In the middle: a bowl of fruit. -->
{mesh_xml("bowl", phong((0.55, 0.52, 0.46), (0.08, 0.08, 0.08), 40), at(0.55, 0, -0.55))}
{mesh_xml("apple", red, at(0.0, 0.50, -0.86, turn("0, 0, 1", 14)))}
{mesh_xml("stem", wood, at(-0.21, 1.32, -0.86, turn("0, 0, 1", 24)))}
{mesh_xml("apple", green, at(1.10, 0.52, -0.84, turn("0, 0, 1", -18)))}
{mesh_xml("stem", wood, at(1.36, 1.33, -0.84, turn("0, 0, 1", -30)))}
{mesh_xml("apple", red, at(0.58, 0.50, 0.05, turn("1, 0, 0", 18)))}
{mesh_xml("stem", wood, at(0.58, 1.31, 0.31, turn("1, 0, 0", 30)))}
	<!-- Behind the cup: a pear. -->
{mesh_xml("pear", skin, at(2.45, 0, -1.0))}
{mesh_xml("stem", wood, at(2.45, 1.52, -1.0, turn("0, 0, 1", -20)))}
	<!-- On the right: a cup; in front: two eggs, lying. -->
{mesh_xml("cup", phong((0.60, 0.62, 0.64), (0.10, 0.10, 0.10), 120), at(3.0, 0, 0.8, turn("0, 1, 0", -32)))}
{mesh_xml("egg", diffuse((0.72, 0.58, 0.46)), at(0.62, 0.37, 2.2, turn("0, 0, 1", 90), turn("0, 1, 0", 25)))}
{mesh_xml("egg", diffuse((0.74, 0.70, 0.64)), at(1.50, 0.37, 1.9, turn("0, 0, 1", 90), turn("0, 1, 0", -50)))}
"""
    (HERE / "area_sampling.xml").write_text(scene_xml(
        "Exercise 3, area sampling: a small still life under area lights with soft shadows. "
        "Written by make_scenes.py. Lengths in decimetres.", 64, camera, body))

    # Places on the table: centre, half width, and what hides which light there.
    places = {
        "open table": ((3.0, 0.0, 2.6), 0.3, "all three lights are seen, nothing hides them"),
        "umbra": ((-4.04, 0.0, -1.37), 0.25, "the shadow of the vase left of it: the small light is hidden"),
        "penumbra": ((-3.82, 0.0, -0.26), 0.12, "the edge of that shadow: the small light is partly hidden"),
        "contact shadow": ((1.54, 0.0, 2.13), 0.05, "the table beneath the right egg: nearly everything is hidden"),
    }
    regions = []
    for name, (center, half, what) in places.items():
        corners = [camera.project(add(center, (dx, 0, dz))) for dx in (-half, half) for dz in (-half, half)]
        regions.append({"name": name, "what": what, "rect": bounds(corners)})
    write_json("area_sampling.regions.json", {"scene": "area_sampling.xml", "regions": regions})


def bounds(points):
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    return [round(v, 5) for v in (min(xs), min(ys), max(xs), max(ys))]


def write_json(name, data):
    (HERE / name).write_text(json.dumps(data, indent=1) + "\n")


# --- the Phong plates ------------------------------------------------------------------------------------------------

CAMERA = Camera((0.0, 2.0, 15.0), (0.0, -1.28, 2.5), 30)
LIGHT_X = (-3.0, -1.0, 1.0, 3.0)
LIGHT_RADII = (0.04, 0.10, 0.24, 0.56)
LIGHT_POWER = 40.0  # W, of each light, in each colour channel
# name, top and bottom edge as fractions of the image height, z of the centre, exponent: the shiniest on top
PLATES = (("top", 0.325, 0.515, 1.3, 20000), ("middle", 0.545, 0.735, 4.2, 1000), ("bottom", 0.765, 0.955, 7.0, 200))
PLATE_KD, PLATE_KS = (0.012, 0.015, 0.020), (0.50, 0.50, 0.50)


class Plate:
    """A rectangle that mirrors the middle of the row of lights to the camera."""

    def __init__(self, name, top, bottom, z, n):
        self.name, self.n = name, n
        ray = CAMERA.direction(0.5, (top + bottom) / 2)
        self.center = add(CAMERA.origin, mul(ray, (z - CAMERA.origin[2]) / ray[2]))
        self.normal = unit(add(unit(sub(CAMERA.origin, self.center)), unit(mul(self.center, -1.0))))
        self.right = (1.0, 0.0, 0.0)
        self.back = cross(self.normal, self.right)
        self.near, self.far = (dot(sub(self.hit(CAMERA.direction(0.5, y))[1], self.center), self.back)
                               for y in (bottom, top))
        self.half_width = 0.92 * CAMERA.half_width * -dot(sub(CAMERA.origin, self.center), CAMERA.forward)

    def hit(self, direction):
        """Distance and point where a camera ray meets the plane of the plate."""
        distance = dot(sub(self.center, CAMERA.origin), self.normal) / dot(direction, self.normal)
        return distance, add(CAMERA.origin, mul(direction, distance))

    def covers(self, point):
        offset = sub(point, self.center)
        return abs(offset[0]) <= self.half_width and self.near <= dot(offset, self.back) <= self.far

    def mesh(self):
        middle = add(self.center, mul(self.back, (self.near + self.far) / 2))
        return rectangle(middle, mul(self.right, self.half_width), mul(self.back, (self.far - self.near) / 2))


def make_plates():
    powers = []
    spheres = []
    for i, radius in enumerate(LIGHT_RADII):
        mesh = sphere(radius, 16, 32)
        write_obj(f"light_{i + 1}", f"light {i + 1}: a sphere of radius {radius:g}", *mesh)
        radiance = LIGHT_POWER / (math.pi * area(*mesh))
        powers.append(radiance * math.pi * area(*mesh))
        spheres.append(f"\t<!-- Light {i + 1}: radius {radius:g}, {LIGHT_POWER:g} W. -->\n" + mesh_xml(
            f"light_{i + 1}", light((radiance,) * 3), [f'<translate value="{LIGHT_X[i]:g}, 0, 0"/>']))
    plates = []
    for plate in map(lambda p: Plate(*p), PLATES):
        write_obj(f"plate_{plate.name}", f"{plate.name} plate", *plate.mesh())
        plates.append(f"\t<!-- The {plate.name} plate. -->\n"
                      + mesh_xml(f"plate_{plate.name}", phong(PLATE_KD, PLATE_KS, plate.n)))
    wall = [(x, y, z) for z, y in [(16.0, -5.0), (0.0, -5.0)] + [
        (-4.0 * math.sin(a), -1.0 - 4.0 * math.cos(a)) for a in (math.pi / 2 * i / 24 for i in range(1, 25))]
        + [(-4.0, 12.0)] for x in (-24.0, 24.0)]
    write_obj("plates_backdrop", "floor that curves up into a wall", wall, grid_faces(len(wall) // 2, 2))

    body = f"""\
	<!-- Four lights of equal power, small to large: radiance times area is the same for all. -->

{chr(10).join(spheres)}
	<!-- Three plates of one colour, f = kd / pi + ks (n + 2) / (2 pi) cos^n(alpha), tilted so that each mirrors the
	     row of lights to the camera. Only the exponent n differs: the shiniest is on top. -->

{chr(10).join(plates)}
	<!-- A dark floor and wall. -->
{mesh_xml("plates_backdrop", diffuse((0.035, 0.035, 0.038)))}"""
    (HERE / "phong_plates.xml").write_text(scene_xml(
        "Exercise 3, directional against area sampling: four lights of equal power and three Phong plates, "
        "arranged as in Veach's thesis (1997, figure 9.2). Written by make_scenes.py. Lengths in metres.", 64, CAMERA,
        body))
    write_json("phong_plates.regions.json", {
        "scene": "phong_plates.xml",
        "plates": [{"name": p[0], "n": p[4], "kd": PLATE_KD, "ks": PLATE_KS} for p in PLATES],
        "lights": [{"name": f"light {i + 1}", "radius": r, "power": round(powers[i], 6)}
                   for i, r in enumerate(LIGHT_RADII)],
        "lights_end": PLATES[0][1],  # above this fraction of the height, the lights; below, the plates
        "regions": highlight_regions()})


def highlight_regions():
    """For each plate and light, the rectangle around the pixels whose mirror direction meets the light, or passes it
    within the angle at which cos^n has fallen to one half."""
    boxes = {}
    plates = [Plate(*p) for p in PLATES]
    for row in range(HEIGHT):
        for column in range(WIDTH):
            direction = CAMERA.direction((column + 0.5) / WIDTH, (row + 0.5) / HEIGHT)
            for p, plate in enumerate(plates):  # in the picture no plate hides another
                point = plate.hit(direction)[1]
                if not plate.covers(point):
                    continue
                mirrored = sub(direction, mul(plate.normal, 2 * dot(direction, plate.normal)))
                angle, i = min((angle_to_light(point, mirrored, i), i) for i in range(4))
                if angle <= math.acos(0.5 ** (1 / plate.n)):
                    box = boxes.setdefault((p, i), [column, row, column + 1, row + 1])
                    boxes[p, i] = [min(box[0], column), min(box[1], row), max(box[2], column + 1), max(box[3], row + 1)]
    return [{"plate": PLATES[p][0], "light": i + 1, "half_angle_deg": round(half_angle_deg(plates[p], i), 5),
             "rect": [round(b[0] / WIDTH, 5), round(b[1] / HEIGHT, 5), round(b[2] / WIDTH, 5), round(b[3] / HEIGHT, 5)]}
            for (p, i), b in sorted(boxes.items())]


def half_angle_deg(plate, i):
    """Angle from the centre to the rim of light i, seen from where the plate mirrors it to the camera."""
    center = (LIGHT_X[i], 0.0, 0.0)
    image = sub(center, mul(plate.normal, 2 * dot(sub(center, plate.center), plate.normal)))
    point = plate.hit(sub(image, CAMERA.origin))[1]
    to_light = sub(center, point)
    return math.degrees(math.asin(LIGHT_RADII[i] / math.sqrt(dot(to_light, to_light))))


def angle_to_light(point, direction, i):
    """Angle between a direction and the rim of light i (0 where the direction meets it), in radians."""
    to_light = sub((LIGHT_X[i], 0.0, 0.0), point)
    distance = math.sqrt(dot(to_light, to_light))
    angle = math.acos(max(-1.0, min(1.0, dot(direction, to_light) / distance)))
    return max(0.0, angle - math.asin(LIGHT_RADII[i] / distance))


if __name__ == "__main__":
    MESHES.mkdir(exist_ok=True)
    make_still_life()
    make_plates()
