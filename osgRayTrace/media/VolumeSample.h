// VolumeSample.h - the value, the colour and the opacity of a volume at a point. Layer: media.
// SPDX-License-Identifier: MIT
//
// What a volume does with light grows in proportion to its *amount*, which is additive along rays:
// the opacity itself if it is a density, and the optical depth -ln(1 - opacity) of a step or a cell
// if the opacity is a share of light that a step or a cell takes away.
#pragma once

#include "osgRayTrace/base/Kernel.h"
#include "osgRayTrace/scene/Volume.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

/// The largest opacity of a step or a cell: it leaves 1/255 of the light.
constexpr float kLargestOpacity = 1.0f - 1.0f / 255.0f;

/// The largest density. Values of images may be any finite float.
constexpr float kLargestDensity = 1e6f;

/// What an image has at a point: a colour and a value.
struct Voxel
{
    Vec3 color{0.0f};
    float value = 0.0f;
};

/// Returns the amount that an opacity is, times the volume's transparency.
inline float amountOf(const Volume& volume, float opacity)
{
    const float alpha = opacity * volume.transparency;
    if (!(alpha > 0.0f)) return 0.0f; // NaN, too
    if (volume.law == VolumeLaw::Density) return std::min(alpha, kLargestDensity);
    return -std::log1p(-std::min(alpha, kLargestOpacity));
}

namespace detail
{

/// Returns the value of a voxel, 0 beyond the image.
template <class T>
float valueAt(const VolumeImage& image, const T* data, int x, int y, int z, int c)
{
    if (x < 0 || y < 0 || z < 0 || x >= image.width || y >= image.height || z >= image.depth)
        return 0.0f;
    const std::size_t place =
        (static_cast<std::size_t>(z) * static_cast<std::size_t>(image.height) +
         static_cast<std::size_t>(y)) *
            static_cast<std::size_t>(image.width) +
        static_cast<std::size_t>(x);
    return static_cast<float>(
        data[place * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(c)]);
}

/// The eight voxels around a point: the lowest one, and the weights of the upper ones.
struct Corner
{
    int x, y, z;
    float fx, fy, fz;
};

OSGRAYTRACE_INLINE Corner cornerOf(const VolumeImage& image, Vec3 p)
{
    const float x = p.x * static_cast<float>(image.width) - 0.5f;
    const float y = p.y * static_cast<float>(image.height) - 0.5f;
    const float z = p.z * static_cast<float>(image.depth) - 0.5f;
    // Points far beyond the box have no voxels; NaN becomes -1.
    const auto low = [](float v, int size) {
        return v > -1.0f ? static_cast<int>(std::floor(std::min(v, static_cast<float>(size)))) : -1;
    };
    const Corner corner{low(x, image.width), low(y, image.height), low(z, image.depth), 0, 0, 0};
    const auto share = [](float v, int begin) // NaN becomes 0
    {
        const float t = v - static_cast<float>(begin);
        return t > 0.0f ? std::min(t, 1.0f) : 0.0f;
    };
    return {corner.x,           corner.y,           corner.z,
            share(x, corner.x), share(y, corner.y), share(z, corner.z)};
}

/// Returns the mean of eight values, of which those of v[0] are the lower ones along z, and within
/// them the lower row along y first.
OSGRAYTRACE_INLINE float meanOf(const float (&v)[2][2][2], const Corner& at)
{
    const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
    const float low =
        mix(mix(v[0][0][0], v[0][0][1], at.fx), mix(v[0][1][0], v[0][1][1], at.fx), at.fy);
    const float high =
        mix(mix(v[1][0][0], v[1][0][1], at.fx), mix(v[1][1][0], v[1][1][1], at.fx), at.fy);
    return mix(low, high, at.fz);
}

/// The same where some of the voxels are beyond the image, and 0.
template <class T>
float channelAtEdge(const VolumeImage& image, const T* data, const Corner& at, int c)
{
    float v[2][2][2];
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x)
                v[z][y][x] = valueAt(image, data, at.x + x, at.y + y, at.z + z, c);
    return meanOf(v, at);
}

template <class T>
OSGRAYTRACE_INLINE float channelAt(const VolumeImage& image, const T* data, const Corner& at, int c)
{
    float v[2][2][2];
    const auto isBetween = [](int x, int size)
    { return static_cast<unsigned>(x) < static_cast<unsigned>(size - 1); };
    if (!isBetween(at.x, image.width) || !isBetween(at.y, image.height) ||
        !isBetween(at.z, image.depth))
        return channelAtEdge(image, data, at, c);
    // Most points have all eight voxels.
    const auto column = static_cast<std::size_t>(image.channels);
    const std::size_t row = column * static_cast<std::size_t>(image.width);
    const std::size_t slice = row * static_cast<std::size_t>(image.height);
    const T* first = data + static_cast<std::size_t>(at.z) * slice +
                     static_cast<std::size_t>(at.y) * row +
                     static_cast<std::size_t>(at.x) * column + static_cast<std::size_t>(c);
    for (std::size_t z = 0; z < 2; ++z)
        for (std::size_t y = 0; y < 2; ++y)
            for (std::size_t x = 0; x < 2; ++x)
                v[z][y][x] = static_cast<float>(first[z * slice + y * row + x * column]);
    return meanOf(v, at);
}

OSGRAYTRACE_INLINE float channelAt(const VolumeImage& image, const Corner& at, int c)
{
    return image.floats.empty() ? channelAt(image, image.bytes.data(), at, c) * (1.0f / 255.0f)
                                : channelAt(image, image.floats.data(), at, c);
}

} // namespace detail

/// Returns the value of the image at a point of its unit cube; 0 outside of the cube.
inline float volumeValue(const VolumeImage& image, Vec3 p)
{
    return detail::channelAt(image, detail::cornerOf(image, p), image.channels - 1);
}

/// Returns where a value is among the entries of a transfer function, of which the first one is at
/// 1: OpenGL's linear filter of a one-dimensional texture with GL_CLAMP, which osgVolume leaves it.
/// Values of 0 and 1 lie half-way between the outermost entries and a border that is 0.
inline float transferPlace(const Volume& volume, float value)
{
    const float v = value * volume.transferScale + volume.transferOffset;
    const float inside = v > 0.0f ? std::min(v, 1.0f) : 0.0f; // NaN becomes 0
    return inside * static_cast<float>(volume.transfer.size()) + 0.5f;
}

/// Returns the colour and opacity that a transfer function has for a value.
inline Vec4 transferred(const Volume& volume, float value)
{
    const float at = transferPlace(volume, value);
    const auto low = static_cast<std::size_t>(at);
    const auto entry = [&](std::size_t i) // 0 and behind the last one: the border
    { return i == 0 || i > volume.transfer.size() ? Vec4(0.0f) : volume.transfer[i - 1]; };
    const float share = at - static_cast<float>(low);
    return entry(low) * (1.0f - share) + entry(low + 1) * share;
}

/// Returns the colour and the value of the image at a point of its unit cube.
OSGRAYTRACE_INLINE Voxel voxelAt(const VolumeImage& image, Vec3 p)
{
    const detail::Corner at = detail::cornerOf(image, p);
    Voxel voxel;
    voxel.value = detail::channelAt(image, at, image.channels - 1);
    if (image.channels == 1)
        voxel.color = Vec3(voxel.value);
    else
        for (int c = 0; c < 3; ++c)
            voxel.color[c] = detail::channelAt(image, at, c);
    return voxel;
}

/// What a volume is at a point.
struct VolumePoint
{
    Vec3 color{0.0f};
    float opacity = 0.0f; ///< without the volume's transparency
};

/// Returns the colour and opacity at a point of the image's unit cube. Nothing is where the cut-off
/// of the law leaves nothing.
OSGRAYTRACE_INLINE VolumePoint volumePoint(const Volume& volume, Vec3 p)
{
    const Voxel voxel = voxelAt(*volume.image, p);
    VolumePoint point{voxel.color, voxel.value};
    if (!volume.transfer.empty())
    {
        const Vec4 color = transferred(volume, voxel.value);
        point = {Vec3(color), color.w};
    }
    else if (volume.law == VolumeLaw::Density && volume.image->channels == 1)
        point.color = Vec3(1.0f); // a density has no colour of its own
    const float kept =
        volume.law == VolumeLaw::Samples ? point.opacity * volume.transparency : voxel.value;
    if (kept < volume.cutoff) point.opacity = 0.0f;
    return point;
}

} // namespace osgRayTrace::engine
