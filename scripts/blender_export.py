#!/usr/bin/env python3
"""A Blender scene -> a scene for etendue: OUT.xml with the camera and the lights, OUT.obj and OUT.mtl with the rest.

usage: python blender_export.py SCENE.blend OUT.xml              with the module bpy, from PyPI
       blender -b SCENE.blend -P blender_export.py -- OUT.xml    with Blender itself

What becomes what, and what is lost: docs/blender.md. Tried with Blender 4.2.
"""
import math
import sys
from pathlib import Path

import bpy
from mathutils import Matrix


def numbers(values):
    return " ".join(f"{value:.9g}" for value in values)


def transform(matrix):
    rows = numbers(value for row in matrix for value in row)
    return f'<transform name="toWorld"><matrix value="{rows}"/></transform>'


def say(name, what):
    print(f"{name}: {what}", file=sys.stderr)


def camera(scene):
    place = scene.camera.matrix_world
    # Whatever the sensor and the shape of the picture: the frame, seen from the camera.
    corners = scene.camera.data.view_frame(scene=scene)
    width = max(corner.x for corner in corners) - min(corner.x for corner in corners)
    middle = sum(corner.x for corner in corners) / 4, sum(corner.y for corner in corners) / 4
    if scene.camera.data.type != "PERSP" or max(map(abs, middle)) > 1e-6:
        say(scene.camera.name, "an orthographic, panoramic or shifted camera is exported as a plain one")
    fov = 2 * math.degrees(math.atan(width / 2 / abs(corners[0].z)))
    origin, up = place.translation, place.col[1].to_3d()
    target = origin - place.col[2].to_3d()
    size = scene.render.resolution_percentage / 100
    return f"""  <camera type="perspective">
    <integer name="width" value="{round(scene.render.resolution_x * size)}"/>
    <integer name="height" value="{round(scene.render.resolution_y * size)}"/>
    <float name="fov" value="{fov:.9g}"/>
    <transform name="toWorld">
      <lookat origin="{numbers(origin)}" target="{numbers(target)}" up="{numbers(up)}"/>
    </transform>
  </camera>"""


def shape(kind, matrix, radiance):
    return f"""  <shape type="{kind}">
    {transform(matrix)}
    <bsdf type="diffuse"><color name="albedo" value="0"/></bsdf>
    <emitter type="area"><color name="radiance" value="{numbers(radiance)}"/></emitter>
  </shape>"""


def light(thing):
    data, place = thing.data, thing.matrix_world
    power = [data.energy * channel for channel in data.color]
    if data.type == "AREA":
        width = data.size
        height = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
        # Ours face +z, Blender's -z.
        half = place @ Matrix.Diagonal((width / 2, -height / 2, -1, 1))
        across = half.col[0].to_3d().cross(half.col[1].to_3d()).length
        is_round = data.shape in ("DISK", "ELLIPSE")
        area = across * (math.pi if is_round else 4)
        return shape("disk" if is_round else "rectangle", half, [p / (math.pi * area) for p in power])
    if data.type == "POINT" and data.shadow_soft_size > 0:
        r = data.shadow_soft_size
        return shape("sphere", Matrix.Translation(place.translation) @ Matrix.Scale(r, 4),
                     [p / (4 * math.pi**2 * r * r) for p in power])
    if data.type == "POINT":
        return f"""  <emitter type="point">
    <point name="position" value="{numbers(place.translation)}"/>
    <color name="power" value="{numbers(power)}"/>
  </emitter>"""
    if data.type == "SUN":
        return f"""  <emitter type="directional">
    <vector name="direction" value="{numbers(-place.col[2].to_3d())}"/>
    <color name="irradiance" value="{numbers(power)}"/>
  </emitter>"""
    say(thing.name, f"a light of type {data.type} is left out")
    return ""


def world(scene):
    nodes = scene.world.node_tree.nodes if scene.world and scene.world.use_nodes else []
    for node in nodes:
        if node.type == "BACKGROUND":
            if node.inputs["Color"].is_linked:
                say(scene.world.name, "an environment texture is left out: give it to an <emitter type=\"envmap\">")
            radiance = [node.inputs["Strength"].default_value * c for c in node.inputs["Color"].default_value[:3]]
            if not node.inputs["Color"].is_linked and max(radiance) > 0:
                return f'  <emitter type="constant"><color name="radiance" value="{numbers(radiance)}"/></emitter>'
    return ""


def lessen_speculars():
    """Blender's exporter writes the "IOR Level" as Ks: 0.5 for what reflects 4 % head on."""
    for material in bpy.data.materials:
        for node in material.node_tree.nodes if material.use_nodes else []:
            if node.type == "BSDF_PRINCIPLED" and node.inputs["Metallic"].default_value == 0:
                node.inputs["Specular IOR Level"].default_value *= 0.08


def export(out):
    scene = bpy.context.scene
    if not scene.camera:
        sys.exit("the scene has no camera")
    lessen_speculars()
    bpy.ops.wm.obj_export(filepath=str(out.with_suffix(".obj")), forward_axis="Y", up_axis="Z", path_mode="RELATIVE")
    lights = [light(thing) for thing in scene.objects if thing.type == "LIGHT" and not thing.hide_render]
    parts = [camera(scene), *filter(None, lights), world(scene)]
    body = "\n".join(filter(None, parts))
    out.write_text(f"""<scene dialect="nori">
  <integrator type="path_mis"/>
{body}
  <mesh type="obj">
    <string name="filename" value="{out.with_suffix(".obj").name}"/>
    <boolean name="materials" value="true"/>
  </mesh>
</scene>
""")


arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else sys.argv[1:]
if not 1 <= len(arguments) <= 2:
    sys.exit(__doc__)
if len(arguments) == 2:
    bpy.ops.wm.open_mainfile(filepath=str(Path(arguments[0]).resolve()))
export(Path(arguments[-1]).resolve())
