# sky.py - writes the environment that both renderers are lit by, as a Radiance picture.
# SPDX-License-Identifier: MIT
import numpy

WIDTH, HEIGHT = 512, 256


def directions():
    """Returns unit vectors of the middles of all pixels: z is up, the middle column looks at +y."""
    azimuth = (numpy.arange(WIDTH) + 0.5) / WIDTH * 2 * numpy.pi - numpy.pi
    polar = (numpy.arange(HEIGHT) + 0.5) / HEIGHT * numpy.pi
    azimuth, polar = numpy.meshgrid(azimuth, polar)
    sine = numpy.sin(polar)
    return numpy.stack([sine * numpy.sin(azimuth), sine * numpy.cos(azimuth), numpy.cos(polar)], -1)


def spot(towards, centre, degrees, color):
    """Returns the radiance of a soft round light, Gaussian in the angle from its centre."""
    centre = numpy.array(centre) / numpy.linalg.norm(centre)
    cosine = numpy.clip(towards @ centre, -1, 1)
    share = numpy.exp(-0.5 * (numpy.arccos(cosine) / numpy.radians(degrees)) ** 2)
    return share[..., None] * numpy.array(color)


def even():
    """Returns a sky of 1/2 everywhere, before which a white body cannot be seen."""
    return numpy.full((HEIGHT, WIDTH, 3), 0.5)


def outdoors():
    """Returns sky, ground, a soft sun and two softer lights; nothing is sharper than 6 pixels."""
    towards = directions()
    height = towards[..., 2]
    above = 1 / (1 + numpy.exp(-height / 0.03))
    zenith = numpy.clip(height, 0, 1)[..., None] ** 0.5
    sky = (1 - zenith) * numpy.array([0.80, 0.75, 0.70]) + zenith * numpy.array([0.15, 0.28, 0.55])
    ground = numpy.array([0.16, 0.13, 0.10])
    picture = above[..., None] * sky + (1 - above[..., None]) * ground
    picture += spot(towards, (-1.0, -0.8, 1.2), 4, (40, 36, 30))
    picture += spot(towards, (1.5, -1.0, 0.6), 12, (1.5, 1.7, 2.0))
    picture += spot(towards, (0.3, 1.0, 0.5), 8, (3.0, 2.2, 1.4))
    return picture


def write(file, picture):
    """Writes radiance with 8 bits of mantissa a channel and one exponent a pixel [Ward91]."""
    exponent = numpy.frexp(picture.max(-1))[1]
    mantissa = picture / numpy.exp2(exponent)[..., None] * 256
    pixels = numpy.concatenate([mantissa, (exponent + 128)[..., None]], -1).astype(numpy.uint8)
    with open(file, "wb") as out:
        out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n")
        out.write(f"-Y {HEIGHT} +X {WIDTH}\n".encode())
        out.write(pixels.tobytes())
