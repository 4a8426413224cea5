"""Writes a scene as a file of each renderer, with the meshes beside them."""
import pickle

import numpy as np
import OpenEXR

from shapes import Diffuse, Mesh, Rectangle, Sphere, Texels


def write_scene(scene, folder, size_px, suffix=""):
    """Writes NAME.etendue.xml, NAME.mitsuba.xml, and NAME.cycles for its worker, the meshes as PLY and the textures as
    EXR; returns the paths of the scenes."""
    folder.mkdir(parents=True, exist_ok=True)
    for thing in scene.objects:
        if isinstance(thing.shape, Mesh):
            write_ply(thing.shape, folder / mesh_name(scene, thing))
        if isinstance(thing.radiance, Texels):
            write_exr(thing.radiance.colors, folder / texels_name(scene, thing))
            write_exr(thing.radiance.colors[::-1], folder / upside_down_name(scene, thing))
    paths = []
    for renderer, text in (("etendue", etendue_xml), ("mitsuba", mitsuba_xml)):
        paths.append(folder / f"{scene.name}{suffix}.{renderer}.xml")
        paths[-1].write_text(text(scene, size_px))
    paths.append(folder / f"{scene.name}{suffix}.cycles")
    paths[-1].write_bytes(pickle.dumps((scene, size_px)))
    return paths


def mesh_name(scene, thing):
    return f"{scene.name}.{thing.name}.ply"


def texels_name(scene, thing):
    return f"{scene.name}.{thing.name}.exr"


def upside_down_name(scene, thing):
    """For Mitsuba, whose v runs down the picture: it samples by texels where no transform turns them."""
    return f"{scene.name}.{thing.name}.upside_down.exr"


def write_exr(colors, path):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": np.ascontiguousarray(colors, np.float32)}).write(str(path))


def write_ply(mesh, path):
    vertices = np.ascontiguousarray(mesh.vertices, "<f4")
    faces = np.empty(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, mesh.faces
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\n"
              f"property float y\nproperty float z\nelement face {len(faces)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    path.write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())


def numbers(values):
    return " ".join(f"{value:.9g}" for value in np.ravel(values))


def shape_opening(scene, thing, naming, to_world, of_mesh=""):
    """The tag that opens a shape, and what says its form: both formats have the same, by other names."""
    shape = thing.shape
    opening = f'{naming}="{thing.name}">'
    if isinstance(shape, Mesh):
        return (f'\t<shape type="ply" {opening}<string name="filename" value="{mesh_name(scene, thing)}"/>{of_mesh}')
    if isinstance(shape, Sphere):
        return (f'\t<shape type="sphere" {opening}<point name="center" value="{numbers(shape.center)}"/>'
                f'<float name="radius" value="{shape.radius:g}"/>')
    return (f'\t<shape type="rectangle" {opening}<transform name="{to_world}"><matrix '
            f'value="{numbers(shape.world_from_square())}"/></transform>')


def etendue_xml(scene, size_px):
    camera = scene.camera
    lines = ['<?xml version="1.0" encoding="utf-8"?>', f"<!-- {scene.about} -->", '<scene dialect="nori">',
             '\t<sampler type="sobol"/>', '\t<rfilter type="box"/>', '\t<camera type="perspective">',
             f'\t\t<transform name="toWorld"><lookat origin="{numbers(camera.origin)}" '
             f'target="{numbers(camera.target)}" up="{numbers(camera.up)}"/></transform>',
             f'\t\t<float name="fov" value="{camera.fov_deg:g}"/>', f'\t\t<integer name="width" value="{size_px}"/>',
             f'\t\t<integer name="height" value="{size_px}"/>', "\t</camera>"]
    for thing in scene.objects:
        lines.append(shape_opening(scene, thing, naming="name", to_world="toWorld"))
        material = thing.material
        if isinstance(material, Diffuse):
            lines.append(f'\t\t<bsdf type="diffuse"><color name="albedo" value="{numbers(material.albedo)}"/></bsdf>')
        else:
            lines.append('\t\t<bsdf type="roughconductor"><string name="distribution" value="ggx"/>'
                         f'<float name="alpha" value="{material.alpha:g}"/>'
                         f'<color name="eta" value="{numbers(material.eta)}"/>'
                         f'<color name="k" value="{numbers(material.k)}"/></bsdf>')
        if isinstance(thing.radiance, Texels):
            lines.append('\t\t<emitter type="area"><texture type="imagetexture" name="radiance">'
                         f'<string name="filename" value="{texels_name(scene, thing)}"/>'
                         '<string name="wrap" value="clamp"/></texture></emitter>')
        elif thing.radiance:
            lines.append(f'\t\t<emitter type="area"><color name="radiance" value="{numbers(thing.radiance)}"/></emitter>')
        lines.append("\t</shape>")
    return "\n".join(lines + ["</scene>", ""])


def mitsuba_xml(scene, size_px):
    """Lights are weighted by their power; who wants them alike sets their sampling_weight after loading."""
    camera = scene.camera
    integrator = "path" if scene.is_by_paths else "direct"
    lines = [f"<!-- {scene.about} -->", '<scene version="3.0.0">',
             '\t<default name="sampler" value="multijitter"/>', f'\t<integrator type="{integrator}"/>',
             '\t<sensor type="perspective">',
             f'\t\t<transform name="to_world"><lookat origin="{numbers(camera.origin)}" '
             f'target="{numbers(camera.target)}" up="{numbers(camera.up)}"/></transform>',
             f'\t\t<float name="fov" value="{camera.fov_deg:g}"/>',
             '\t\t<film type="hdrfilm"><string name="pixel_format" value="rgb"/>'
             '<string name="component_format" value="float32"/>'
             f'<integer name="width" value="{size_px}"/><integer name="height" value="{size_px}"/>'
             '<rfilter type="box"/></film>', '\t\t<sampler type="$sampler"/>', "\t</sensor>"]
    for thing in scene.objects:
        lines.append(shape_opening(scene, thing, naming="id", to_world="to_world",
                                   of_mesh='<boolean name="face_normals" value="true"/>'))
        material = thing.material
        if isinstance(material, Diffuse):
            lines.append(f'\t\t<bsdf type="diffuse"><rgb name="reflectance" value="{numbers(material.albedo)}"/></bsdf>')
        else:
            lines.append('\t\t<bsdf type="roughconductor"><string name="distribution" value="ggx"/>'
                         f'<float name="alpha" value="{material.alpha:g}"/>'
                         f'<rgb name="eta" value="{numbers(material.eta)}"/><rgb name="k" value="{numbers(material.k)}"/>'
                         '</bsdf>')
        if isinstance(thing.radiance, Texels):
            lines.append('\t\t<emitter type="area"><texture type="bitmap" name="radiance">'
                         f'<string name="filename" value="{upside_down_name(scene, thing)}"/>'
                         '<string name="wrap_mode" value="clamp"/><boolean name="raw" value="true"/>'
                         '</texture>'
                         f'<float name="sampling_weight" value="{thing.power():.9g}"/></emitter>')
        elif thing.radiance:
            lines.append(f'\t\t<emitter type="area"><rgb name="radiance" value="{numbers(thing.radiance)}"/>'
                         f'<float name="sampling_weight" value="{thing.power():.9g}"/></emitter>')
        lines.append("\t</shape>")
    return "\n".join(lines + ["</scene>", ""])
