"""What the geometry alone predicts for the mirror image of a round light in a Phong plate.

Directions around the mirror direction are taken as points of a plane, in radians. The samples are independent, the
plate has no diffuse part, and no other light is near.
"""
import math

import numpy as np


def hit_chance(n, half_angle_deg):
    """Chance that a sample of the Phong lobe meets a round light in the mirror direction."""
    return 1 - math.cos(math.radians(half_angle_deg)) ** (n + 1)


def spread(n, half_angle_deg):
    """E[f^2] / E[f]^2 of cos^n over a round light in the mirror direction."""
    c = math.cos(math.radians(half_angle_deg))
    return (n + 1) ** 2 * (1 - c) * (1 - c ** (2 * n + 1)) / ((2 * n + 1) * (1 - c ** (n + 1)) ** 2)


def moments(n, light, offset_x, offset_y, cells=48):
    """For pixels whose mirror directions are so far (rad) from the middle of a light of the half angle `light` (rad):
    the integrals over the light of f and of f^2 cos(theta''), f = cos^n around the mirror direction, theta'' the angle
    at the surface of the spherical light."""
    lobe = 6 / math.sqrt(n)
    radius = min(light, lobe)  # integrate over the smaller of light and lobe
    r = (np.arange(cells) + 0.5) / cells * radius
    phi = (np.arange(cells) + 0.5) / cells * 2 * np.pi
    x, y = (r[:, None] * np.cos(phi)).ravel(), (r[:, None] * np.sin(phi)).ravel()
    area = np.repeat(r, cells) * (radius / cells) * (2 * np.pi / cells)
    if light <= lobe:
        from_middle = np.broadcast_to(np.hypot(x, y), (offset_x.size, x.size))
        from_mirror = np.hypot(x - offset_x[:, None], y - offset_y[:, None])
    else:
        from_middle = np.hypot(x + offset_x[:, None], y + offset_y[:, None])
        from_mirror = np.broadcast_to(np.hypot(x, y), from_middle.shape)
    f = np.where(from_middle < light, np.cos(np.minimum(from_mirror, np.pi / 2)) ** n, 0)
    cos_at_light = np.sqrt(np.maximum(0, 1 - (from_middle / light) ** 2))
    return f @ area, (f ** 2 * cos_at_light) @ area


def relative_variances(n, half_angle_deg, lights, samples):
    """Relative variance over the place (the square around light and half-maximum of the lobe) of the two methods:
    `direct`, which draws from the lobe, and `light`, which draws one of the lights and a point on the whole of its
    sphere, half of which faces away."""
    light = math.radians(half_angle_deg)
    edge = light + math.acos(0.5 ** (1 / n))
    at = (np.arange(40) + 0.5) / 40 * edge  # one quadrant is enough
    first, second = moments(n, light, *(g.ravel() for g in np.meshgrid(at, at)))
    chance = np.minimum(1, first * (n + 1) / (2 * np.pi))
    direct = (chance * (1 - chance)).mean() / chance.mean() ** 2
    area = ((lights * 4 * np.pi * light ** 2) * second - first ** 2).mean() / first.mean() ** 2
    return {"light": area / samples, "direct": direct / samples}
