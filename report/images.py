"""EXR files into arrays, and arrays into the PNGs that the page holds."""
import base64
import io

import matplotlib
import numpy as np
import OpenImageIO as oiio
from PIL import Image

LUMINANCE = np.array([0.212671, 0.715160, 0.072169])
# Packing: luminance is 2^(code / 64 - 16) with a 16-bit code, its standard error 2^(code / 4 - 20) with an 8-bit code;
# code 0 is zero. viewer.js undoes it.
VALUE_STEPS, VALUE_SHIFT = 64, 16
ERROR_STEPS, ERROR_SHIFT = 4, 20


def read_exr(path):
    """Image and standard error, each height x width x 3."""
    file = oiio.ImageInput.open(str(path))
    if not file:
        raise OSError(f"{path}: {oiio.geterror()}")
    names = list(file.spec().channelnames)
    pixels = file.read_image(oiio.FLOAT)
    file.close()
    missing = [n for n in channel_names() if n not in names]
    if missing:
        raise ValueError(f"{path} has no channel {missing[0]}")
    pixels = np.asarray(pixels)[..., [names.index(n) for n in channel_names()]]
    return pixels[..., :3], pixels[..., 3:]


def channel_names():
    return ["R", "G", "B", "stderr.R", "stderr.G", "stderr.B"]


def luminance(rgb):
    return rgb @ LUMINANCE


def encode(values, steps, shift, top):
    """Codes of positive numbers on a logarithmic scale; 0 for zero."""
    with np.errstate(divide="ignore"):
        codes = np.rint((np.log2(np.maximum(values, 0)) + shift) * steps)
    return np.where(values > 0, np.clip(codes, 1, top), 0).astype(np.int64)


def decode(codes, steps, shift):
    return np.where(codes > 0, 2.0 ** (codes / steps - shift), 0)


def pack(rgb, stderr=None):
    """A grey PNG of five planes on top of each other: luminance (high byte, low byte), share of red, share of green,
    standard error of the luminance. Much smaller than RGBE, since noise sits in one plane only."""
    sums = rgb.sum(axis=2)
    shares = np.where(sums[..., None] > 0, rgb / np.where(sums > 0, sums, 1)[..., None], 1 / 3)
    value = encode(luminance(rgb), VALUE_STEPS, VALUE_SHIFT, 65535)
    error = np.zeros_like(value) if stderr is None else encode(luminance(stderr), ERROR_STEPS, ERROR_SHIFT, 255)
    planes = [value >> 8, value & 255, np.rint(shares[..., 0] * 255), np.rint(shares[..., 1] * 255), error]
    return png(Image.fromarray(np.concatenate(planes).astype(np.uint8), "L"))


def unpack(packed):
    """The inverse of pack, as viewer.js does it: rgb and standard error of the luminance."""
    planes = np.asarray(Image.open(io.BytesIO(packed))).astype(np.int64)
    high, low, red, green, error = np.split(planes, 5)
    shares = np.stack([red, green, 255 - red - green], axis=2) / 255
    lum = decode(high * 256 + low, VALUE_STEPS, VALUE_SHIFT)
    return shares * (lum / (shares @ LUMINANCE))[..., None], decode(error, ERROR_STEPS, ERROR_SHIFT)


def srgb(rgb):
    """8-bit sRGB (IEC 61966-2-1) of linear values; 1 is white."""
    v = np.clip(rgb, 0, 1)
    return np.rint(255 * np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)).astype(np.uint8)


def heat(values, low, high, colors="inferno"):
    """8-bit colours of values on a logarithmic scale from low to high."""
    x = np.log(np.maximum(values, low * 1e-6) / low) / np.log(high / low)
    return (matplotlib.colormaps[colors](np.clip(x, 0, 1))[..., :3] * 255).astype(np.uint8)


def png(image):
    out = io.BytesIO()
    image.save(out, "PNG", optimize=True)
    return out.getvalue()


def jpeg(pixels, quality=80):
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, "JPEG", quality=quality, subsampling=0)
    return out.getvalue()


def crop(pixels, rect, width, height):
    """A window of width x height pixels around the middle of a rectangle given in image fractions, inside the image."""
    h, w = pixels.shape[:2]
    x = int(np.clip((rect[0] + rect[2]) / 2 * w - width / 2, 0, w - width))
    y = int(np.clip((rect[1] + rect[3]) / 2 * h - height / 2, 0, h - height))
    return pixels[y:y + height, x:x + width]


def data_uri(data, kind):
    return f"data:image/{kind};base64," + base64.b64encode(data).decode()
