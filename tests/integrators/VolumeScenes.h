// VolumeScenes.h - volumes for the tests of integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/integrators/MediaScenes.h"

#include "osgRayTrace/sampling/Hash.h"

#include <functional>

namespace osgRayTrace::engine::test
{

/// Returns an image of floats whose voxels have the value that the function gives.
inline std::shared_ptr<const VolumeImage>
newVolumeImage(int width, int height, int depth, const std::function<float(int, int, int)>& value)
{
    const auto image = std::make_shared<VolumeImage>();
    image->width = width;
    image->height = height;
    image->depth = depth;
    for (int z = 0; z < depth; ++z)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                image->floats.push_back(value(x, y, z));
    return image;
}

/// Returns voxels of random densities, a fifth of them above 0.
inline std::shared_ptr<const VolumeImage> clumps(int n)
{
    uint32_t state = 7;
    return newVolumeImage(n, n, n,
                          [&state](int, int, int)
                          {
                              state = hash(state, 1u);
                              const float u = unitFloat(state);
                              return u < 0.8f ? 0.0f : (u - 0.8f) * 20.0f;
                          });
}

/// Returns n voxels along x with the values (i + 1/2) / n.
inline std::shared_ptr<const VolumeImage> ramp(int n)
{
    return newVolumeImage(n, 3, 3, [n](int x, int, int) { return (float(x) + 0.5f) / float(n); });
}

/// The integral over x from 0 to 1 of a density of n voxels with the value (i + 1/2) / n: trapezia
/// between the middles of voxels, with 0 beyond the image.
inline double rampDepth(int n)
{
    const auto value = [n](int i) { return i < 0 || i >= n ? 0.0 : (i + 0.5) / n; };
    double sum = 0.0;
    for (int i = 0; i + 1 < n; ++i)
        sum += 0.5 * (value(i) + value(i + 1)) / n;
    // Half a cell at each face, in which the value falls to half of the outermost one.
    return sum + 0.75 * 0.5 * (value(0) + value(n - 1)) / n;
}

/// Returns an affine map from an axis-aligned box to the unit cube.
inline Affine cubeFromBox(Vec3 low, Vec3 high)
{
    Affine map;
    const Vec3 scale = 1.0f / (high - low);
    map.linear = Mat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z);
    map.translation = -low * scale;
    return map;
}

/// Returns a volume of densities in a box.
inline Volume densityIn(Vec3 low, Vec3 high, const std::shared_ptr<const VolumeImage>& image,
                        const Medium& medium)
{
    Volume volume;
    volume.image = image;
    volume.imageFromEngine = volume.tileFromEngine = cubeFromBox(low, high);
    volume.law = VolumeLaw::Density;
    volume.medium = medium;
    return volume;
}

/// Makes a volume have one opacity and colour whatever its values are, up to its faces.
inline void makeEven(Volume& volume, Vec4 color)
{
    volume.transfer = {color, color};
    volume.transferScale = 0.0f;
    volume.transferOffset = 0.5f;
}

} // namespace osgRayTrace::engine::test
