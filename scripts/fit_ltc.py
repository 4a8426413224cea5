#!/usr/bin/env python3
"""Fits linearly transformed cosines to the glossy lobes of GGX, Beckmann and Phong: writes src/bsdf/ltc_tables.cpp.

usage: fit_ltc.py -o src/bsdf/ltc_tables.cpp   (needs numpy and scipy; half a minute)

After Heitz, Dupuy, Hill and Neubelt 2016, "Real-time polygonal-light shading with linearly transformed cosines", with
another measure of fit: what is least is the relative variance of samples of the fitted lobe as estimates of its whole
integral, a twentieth of them being uniform over the hemisphere. A lobe is f cos without Fresnel's factor. The frame is
that of the mirror direction: x in the plane of incidence towards the normal, y across. With t the tilt, the lobe's
direction is M (cosine direction), M = (turn z by t towards x) [[a, 0, c], [0, b, 0], [0, 0, 1]]. Rows: roughness
2^(-k/2), of Phong sqrt(2 / (n + 2)); columns: sqrt(1 - cos theta) from 0 to 1. a, b, c and the tangent of t are stored
over the roughness, so that the last row does for smoother lobes too, and after them the lobe's albedo. Says how large
the variance is.
"""
import argparse

import numpy as np
from scipy.optimize import minimize
from scipy.special import erf

ROWS, COLUMNS = 12, 16
POINTS = 4096
UNIFORM_SHARE = 0.05


def lattice():
    k = np.arange(POINTS)
    return (k + 0.5) / POINTS, (k * 0.6180339887498949 + 0.5) % 1


def mirror(wo):
    return np.array([-wo[0], 0, wo[2]])


def shadowing_over_cos(kind, cosine, alpha):
    sine = np.sqrt(np.maximum(1 - cosine**2, 0))
    if kind == "ggx":
        return 2 / (cosine + np.sqrt(cosine**2 + (alpha * sine) ** 2))
    slope = cosine / np.maximum(alpha * sine, 1e-12)
    bell = np.exp(-np.minimum(slope**2, 500))
    return 2 / (cosine * (1 + erf(slope)) + alpha * sine * bell / np.sqrt(np.pi))


class Points:
    """Directions wi with f cos there, and the weights of a quadrature over them."""

    def __init__(self, kind, alpha, wo):
        u, v = lattice()
        if kind == "phong":
            n = 2 / alpha**2 - 2
            cosine = (1 - u) ** (1 / (n + 1))
            sine = np.sqrt(1 - cosine**2)
            z = mirror(wo)
            x = np.array([wo[2], 0, wo[0]])
            phi = 2 * np.pi * v
            y = np.array([0, 1, 0])
            self.wi = np.outer(sine * np.cos(phi), x) + np.outer(sine * np.sin(phi), y) + np.outer(cosine, z)
            density = (n + 1) / (2 * np.pi) * cosine**n
            self.f_cos = (n + 2) / (2 * np.pi) * cosine**n * np.maximum(self.wi[:, 2], 0)
        else:
            tangent = alpha * (np.sqrt(u / (1 - u)) if kind == "ggx" else np.sqrt(-np.log(1 - u)))
            z = 1 / np.sqrt(1 + tangent**2)
            h = np.stack([tangent * z * np.cos(2 * np.pi * v), tangent * z * np.sin(2 * np.pi * v), z], 1)
            cos_h = h @ wo
            self.wi = 2 * cos_h[:, None] * h - wo
            if kind == "ggx":
                d = alpha**2 / (np.pi * (z**2 * (alpha**2 - 1) + 1) ** 2)
            else:
                d = np.exp(-((tangent / alpha) ** 2)) / (np.pi * alpha**2 * z**4)
            density = d * z / (4 * np.maximum(cos_h, 1e-9))
            cos_i = self.wi[:, 2]
            is_lit = (cos_i > 0) & (cos_h > 0)
            shadowing = shadowing_over_cos(kind, wo[2], alpha)
            shadowing = shadowing * shadowing_over_cos(kind, np.maximum(cos_i, 1e-6), alpha)
            self.f_cos = np.where(is_lit, d * shadowing / 4 * cos_i, 0)
        self.weight = np.where(self.f_cos > 0, 1 / np.maximum(density, 1e-30), 0) / POINTS
        self.albedo = float(np.sum(self.f_cos * self.weight))


def rows_of_inverse(wo, parameters):
    a, b, c, tangent = parameters
    z = mirror(wo) + np.array([wo[2], 0, wo[0]]) * tangent
    z /= np.linalg.norm(z)
    x = np.array([z[2], 0, -z[0]])
    return np.array([(x - z * c) / a, [0, 1 / b, 0], z])


def density(wo, parameters, wi):
    t = wi @ rows_of_inverse(wo, parameters).T
    return np.maximum(t[:, 2], 0) / (np.pi * parameters[0] * parameters[1] * np.sum(t * t, 1) ** 2)


def variance(points, wo, parameters):
    p = (1 - UNIFORM_SHARE) * density(wo, parameters, points.wi) + UNIFORM_SHARE / (2 * np.pi)
    return float(np.sum(points.f_cos**2 / p * points.weight)) / points.albedo**2 - 1


def fit(points, wo, start, alpha, is_round):
    def unpack(v):
        if is_round:
            return np.array([np.exp(v[0]), np.exp(v[0]), 0, 0])
        return np.array([np.exp(v[0]), np.exp(v[1]), v[2] * alpha, v[3] * alpha])

    first = np.array([*np.log(start[:2]), *(start[2:] / alpha)])[: 1 if is_round else 4]
    result = minimize(
        lambda v: variance(points, wo, unpack(v)),
        first,
        method="Nelder-Mead",
        options={
            "xatol": 1e-4,
            "fatol": 1e-7,
            "maxiter": 800,
            "initial_simplex": np.vstack([first, first + 0.15 * np.eye(len(first))]),
        },
    )
    return unpack(result.x), result.fun


def fit_lobe(kind):
    table = np.zeros((ROWS, COLUMNS, 5))
    variances = np.zeros((ROWS, COLUMNS))
    for row in range(ROWS):
        alpha = 2 ** (-row / 2)
        width = 1.4 * alpha if kind == "phong" else 2 * alpha
        parameters = np.array([min(width, 1), min(width, 1), 0, 0])
        for column in range(COLUMNS):
            cosine = max(1 - (column / (COLUMNS - 1)) ** 2, 1e-3)
            wo = np.array([np.sqrt(1 - cosine**2), 0, cosine])
            points = Points(kind, alpha, wo)
            parameters, variances[row, column] = fit(points, wo, parameters, alpha, column == 0)
            table[row, column] = [*(parameters / alpha), points.albedo]
    return table, variances


def literal(value):
    text = f"{value + 0.0:.5g}"
    return (text if "." in text or "e" in text else text + ".0") + "f"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    text = [
        "// Written by scripts/fit_ltc.py.",
        '#include "bsdf/ltc_tables.h"',
        "",
        "namespace etendue::ltc {",
        "",
        "// clang-format off",
    ]
    for kind in ("ggx", "beckmann", "phong"):
        table, variances = fit_lobe(kind)
        print(f"{kind}: relative variance, its median over angles and the most, the last two columns apart")
        for row in range(ROWS):
            steep = " ".join(f"{v:.3f}" for v in variances[row, -2:])
            print(f"  {2 ** (-row / 2):.3f}  {np.median(variances[row]):.3f}  {variances[row, :-2].max():.3f}  {steep}")
        text.append(f"const Table {kind}{{{{")
        for row in table:
            text.append("    {{" + ", ".join("{" + ", ".join(literal(v) for v in entry) + "}" for entry in row) + "}},")
        text += ["}};", ""]
    text += ["// clang-format on", "", "}  // namespace etendue::ltc", ""]
    with open(options.output, "w", encoding="utf-8") as file:
        file.write("\n".join(text))


if __name__ == "__main__":
    main()
