"""What a scene is made of, whatever the renderer: shapes with a material and perhaps a radiance, and a camera.

Lengths are metres, radiance is in W/(m^2 sr), y is up. All surfaces are one-sided: they shine and scatter on the side of
their normal.
"""
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Diffuse:
    """Lambert's reflection."""
    albedo: tuple = (0.5, 0.5, 0.5)


@dataclass(frozen=True)
class RoughMetal:
    """GGX microfacets of a metal: eta and k are its refractive index and extinction."""
    alpha: float
    eta: tuple = (1.66, 0.88, 0.52)
    k: tuple = (9.22, 6.27, 4.84)


BLACK = Diffuse((0.0, 0.0, 0.0))


@dataclass(frozen=True, eq=False)
class Texels:
    """Radiance over a rectangle, bilinear between the middles of texels, and beyond the outermost as theirs."""
    colors: np.ndarray  # float, rows from the top x columns x 3

    def mean(self):
        return self.colors.mean(axis=(0, 1))


@dataclass(frozen=True)
class Rectangle:
    """The points center + s half_u + t half_v for s, t from -1 to 1; faces half_u x half_v."""
    center: tuple
    half_u: tuple
    half_v: tuple

    def area(self):
        return 4 * float(np.linalg.norm(np.cross(self.half_u, self.half_v)))

    def world_from_square(self):
        """The 4 x 4 matrix that takes the square [-1, 1]^2 at z = 0 here, with z to the unit normal."""
        normal = np.cross(self.half_u, self.half_v)
        matrix = np.eye(4)
        matrix[:3, :] = np.column_stack([self.half_u, self.half_v, normal / np.linalg.norm(normal), self.center])
        return matrix


@dataclass(frozen=True)
class Sphere:
    center: tuple
    radius: float

    def area(self):
        return 4 * np.pi * self.radius**2


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles; a face's normal is the one that sees its corners run counter-clockwise."""
    vertices: np.ndarray  # float, n x 3
    faces: np.ndarray  # int, m x 3

    def area(self):
        a, b, c = (self.vertices[self.faces[:, i]] for i in range(3))
        return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


@dataclass(frozen=True)
class Object:
    name: str
    shape: object
    material: object = Diffuse()
    radiance: object = None  # None: no light; Texels, of a Rectangle only; else a colour

    def power(self):
        """Luminance of the power that the front side sends out, in W."""
        weights = (0.212671, 0.715160, 0.072169)
        radiance = self.radiance.mean() if isinstance(self.radiance, Texels) else self.radiance
        return float(np.dot(weights, radiance)) * np.pi * self.shape.area()


@dataclass(frozen=True)
class Camera:
    origin: tuple
    target: tuple
    fov_deg: float
    up: tuple = (0.0, 1.0, 0.0)


@dataclass
class Scene:
    name: str
    about: str
    camera: Camera
    objects: list = field(default_factory=list)
    is_by_paths: bool = False  # else direct light only

    def add(self, name, shape, material=Diffuse(), radiance=None):
        self.objects.append(Object(name, shape, material, radiance))


def join(meshes):
    """One mesh of the triangles of all."""
    offsets = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    return Mesh(np.concatenate([mesh.vertices for mesh in meshes]),
                np.concatenate([mesh.faces + offset for mesh, offset in zip(meshes, offsets)]))


def block(low, high, turn_deg=0.0):
    """A closed box from corner to corner that faces outwards, turned about the upright axis through its middle."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    angle = np.radians(turn_deg)
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    middle = 0.5 * (low + high)
    vertices = (low + corners * (high - low) - middle) @ turn.T + middle
    return Mesh(vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))


def grid_mesh(point, rows, columns):
    """The closed surface point(u, v), u and v arrays in [0, 1) with period 1, as 2 rows x columns triangles that face
    d/du x d/dv."""
    u, v = np.meshgrid(np.arange(columns) / columns, np.arange(rows) / rows)
    index = np.arange(rows * columns).reshape(rows, columns)
    right, up = np.roll(index, -1, axis=1), np.roll(index, -1, axis=0)
    both = np.roll(right, -1, axis=0)
    faces = np.concatenate([np.stack([index, right, both], -1).reshape(-1, 3),
                            np.stack([index, both, up], -1).reshape(-1, 3)])
    return Mesh(point(u.ravel(), v.ravel()), faces)


def floor(half_size, height=0.0, center=(0.0, 0.0)):
    return Rectangle((center[0], height, center[1]), (half_size, 0, 0), (0, 0, -half_size))


def ceiling_lamp(center, half_x, half_z):
    """A rectangle that faces down."""
    return Rectangle(center, (half_x, 0, 0), (0, 0, half_z))
