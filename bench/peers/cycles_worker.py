"""Renders with Cycles (bpy) what it is told on standard input, one JSON object a line; answers as mitsuba_worker.py.

Its scene file is a pickled Scene with its size. Blender has no exact spheres: they are meshes of 130,000 triangles with
smooth normals. A render's time holds the hand-over of the scene, so that of one sample a pixel is taken off.
"""
import json
import os
import pickle
import statistics
import sys
import time
from pathlib import Path

import bpy  # first, as it brings the next
import mathutils
import numpy as np

from renderers import read_exr
from shapes import Diffuse, Mesh, Rectangle, Sphere, Texels

SPHERE_SEGMENTS = 256
WARM_UPS = 4  # of one sample a pixel, of which the first is not counted


def main():
    loaded = None
    for line in sys.stdin:
        job = json.loads(line)
        wanted = json.dumps([job["scene"], job["setting"]])
        image = Path(job["to"]).with_suffix(".cycles.exr")
        if loaded != wanted:
            loaded = wanted
            load(job["scene"], job["setting"])
            overhead = [timed(0, 1, image) for _ in range(WARM_UPS)][1:]
            overhead = [statistics.median(column) for column in zip(*overhead)]
        spp = job["spp"]
        processor, wall = ((whole - one) * spp / (spp - 1)
                           for whole, one in zip(timed(job["seed"], spp, image), overhead))
        np.save(job["to"], read_exr(image))
        print(json.dumps({"seconds": processor, "wall_seconds": wall}), file=ANSWERS, flush=True)


def timed(seed, spp, image):
    """Processor seconds of this process, and seconds by the clock."""
    scene = bpy.context.scene
    scene.cycles.seed, scene.cycles.samples = seed, spp
    scene.render.filepath = str(image)
    wall, processor = time.perf_counter(), time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - processor, time.perf_counter() - wall


def load(path, setting):
    description, size_px = pickle.loads(Path(path).read_bytes())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    render, cycles = scene.render, scene.cycles
    render.resolution_x = render.resolution_y = size_px
    render.threads_mode, render.threads = "FIXED", int(sys.argv[1])
    render.use_persistent_data = True
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = cycles.light_sampling_threshold = 0.0
    bounces = 1024 if description.is_by_paths else 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.use_light_tree = setting["light_tree"]
    cycles.sampling_pattern = setting["sampling_pattern"]
    for thing in description.objects:
        add(scene, thing)
    add_camera(scene, description.camera)


def add(scene, thing):
    mesh = bpy.data.meshes.new(thing.name)
    shape = thing.shape
    if isinstance(shape, Rectangle):
        corners = np.array([[-1, -1, 0, 1], [1, -1, 0, 1], [1, 1, 0, 1], [-1, 1, 0, 1]])
        shape = Mesh((corners @ shape.world_from_square().T)[:, :3], np.array([[0, 1, 2], [0, 2, 3]]))
    elif isinstance(shape, Sphere):
        shape = round_mesh(shape)
    mesh.from_pydata(shape.vertices.tolist(), [], shape.faces.tolist())
    mesh.polygons.foreach_set("use_smooth", [isinstance(thing.shape, Sphere)] * len(mesh.polygons))
    if isinstance(thing.radiance, Texels):  # The faces of a rectangle, see above.
        uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)[shape.faces.ravel()]
        mesh.uv_layers.new(name="uv").data.foreach_set("uv", uvs.ravel())
    mesh.materials.append(material(thing))
    scene.collection.objects.link(bpy.data.objects.new(thing.name, mesh))


def round_mesh(sphere):
    """Rings of vertices from pole to pole; the outermost rings are so small that they stand for the poles."""
    polar = np.linspace(1e-3, np.pi - 1e-3, SPHERE_SEGMENTS + 1)[:, None]
    around = 2 * np.pi * np.arange(SPHERE_SEGMENTS) / SPHERE_SEGMENTS
    unit = np.stack([np.sin(polar) * np.sin(around), np.cos(polar) + 0 * around, np.sin(polar) * np.cos(around)], -1)
    index = np.arange(unit[..., 0].size).reshape(SPHERE_SEGMENTS + 1, SPHERE_SEGMENTS)
    above, below = index[:-1], index[1:]
    right_above, right_below = np.roll(above, -1, axis=1), np.roll(below, -1, axis=1)
    faces = np.concatenate([np.stack([above, below, right_below], -1).reshape(-1, 3),
                            np.stack([above, right_below, right_above], -1).reshape(-1, 3)])
    return Mesh(sphere.center + sphere.radius * unit.reshape(-1, 3), faces)


def material(thing):
    made = bpy.data.materials.new(thing.name)
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if thing.radiance:  # A lamp is black, and only its front shines.
        shine, geometry, mix = (nodes.new(f"ShaderNode{kind}") for kind in ("Emission", "NewGeometry", "MixShader"))
        if isinstance(thing.radiance, Texels):
            links.new(texture(nodes, thing).outputs["Color"], shine.inputs["Color"])
            shine.inputs["Strength"].default_value = 1
        else:
            shine.inputs["Strength"].default_value = max(thing.radiance)
            shine.inputs["Color"].default_value = (*(c / max(thing.radiance) for c in thing.radiance), 1)
        links.new(geometry.outputs["Backfacing"], mix.inputs[0])
        links.new(shine.outputs[0], mix.inputs[1])
        links.new(mix.outputs[0], output.inputs["Surface"])
        made.cycles.emission_sampling = "FRONT"
        return made
    if isinstance(thing.material, Diffuse):
        node = nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = (*thing.material.albedo, 1)
        node.inputs["Roughness"].default_value = 0
    else:
        node = nodes.new("ShaderNodeBsdfMetallic")
        node.distribution, node.fresnel_type = "GGX", "PHYSICAL_CONDUCTOR"
        node.inputs["IOR"].default_value = thing.material.eta
        node.inputs["Extinction"].default_value = thing.material.k
        node.inputs["Roughness"].default_value = thing.material.alpha ** 0.5
    links.new(node.outputs[0], output.inputs["Surface"])
    return made


def texture(nodes, thing):
    colors = thing.radiance.colors
    image = bpy.data.images.new(thing.name, colors.shape[1], colors.shape[0], float_buffer=True, is_data=True)
    pixels = np.ones((*colors.shape[:2], 4), np.float32)
    pixels[..., :3] = colors[::-1]
    image.pixels.foreach_set(pixels.ravel())
    node = nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation, node.extension = image, "Linear", "EXTEND"
    return node


def add_camera(scene, description):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "HORIZONTAL", np.radians(description.fov_deg)
    camera.clip_start, camera.clip_end = 1e-3, 1e4
    backwards = np.array(description.origin, float) - description.target
    backwards /= np.linalg.norm(backwards)
    right = np.cross(description.up, backwards)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([right, np.cross(backwards, right), backwards, description.origin])
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.matrix_world = mathutils.Matrix(matrix.tolist())
    scene.collection.objects.link(scene.camera)


if __name__ == "__main__":
    ANSWERS = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Blender talks on standard output.
    main()
