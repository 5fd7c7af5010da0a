// GridTable.cpp - puts the volumes of a scene into a table. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/GridTable.h"

#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/scene/VolumeLimits.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// A cell's diagonal takes the opacity of a cell 1.73 times: the factor of osgVolume's shaders.
constexpr float kDepthPerCell = 1.73f;

/// The shortest way over which an opacity is lost, so that depths stay finite.
constexpr float kShortestSample = 1e-6f;

/// Bounds that leave floats for the products with densities and colours [1/engine unit].
constexpr float kLargestCoefficient = 1e24f, kLargestEmission = 1e18f;

Vec3 usable(Vec3 coefficient, float largest)
{
    Vec3 result;
    for (int c = 0; c < 3; ++c) // comparisons with NaN are false
        result[c] = coefficient[c] > 0.0f ? std::min(coefficient[c], largest) : 0.0f;
    return result;
}

bool isSmall(const Vec3& v)
{
    return std::fabs(v.x) <= kLargestVolumeMap && std::fabs(v.y) <= kLargestVolumeMap &&
           std::fabs(v.z) <= kLargestVolumeMap; // false for NaN
}

bool isUsable(const Affine& m)
{
    const double volume = glm::determinant(glm::dmat3(m.linear));
    return isSmall(m.translation) && isSmall(m.linear[0]) && isSmall(m.linear[1]) &&
           isSmall(m.linear[2]) && std::isfinite(volume) && volume != 0.0;
}

GridRecord recordOf(const Volume& volume, float unit)
{
    GridRecord record;
    record.volume = &volume;
    record.imageFromEngine = volume.imageFromEngine;
    record.tileFromEngine = volume.tileFromEngine;
    const VolumeImage& image = *volume.image;
    switch (volume.law)
    {
    case VolumeLaw::Density:
        record.sigmaS = usable(volume.medium.sigmaS * unit, kLargestCoefficient);
        record.sigmaT = record.sigmaS + usable(volume.medium.sigmaA * unit, kLargestCoefficient);
        record.emission = usable(volume.medium.emission * unit, kLargestEmission);
        record.phase = phaseOf(volume.medium);
        record.scatters = volume.medium.scatters();
        break;
    case VolumeLaw::Cells:
    {
        const Vec3 cell = 1.0f / Vec3(Vec3d(image.width, image.height, image.depth));
        record.depthPerWidth = kDepthPerCell / glm::length(cell);
        break;
    }
    case VolumeLaw::Samples:
        record.depthPerWidth = 1.0f / std::max(volume.sampleLength, kShortestSample);
        break;
    }
    return record;
}

/// Returns whether two volumes have the same bounds.
bool sameBounds(const Volume& a, const Volume& b)
{
    return a.image == b.image && a.transfer == b.transfer && a.transferScale == b.transferScale &&
           a.transferOffset == b.transferOffset && a.law == b.law &&
           a.transparency == b.transparency && a.cutoff == b.cutoff;
}

} // namespace

GridTable::GridTable(const Scene& scene, const GridTable* previous, const Scene* previousScene,
                     const Workers* workers)
{
    const auto unit = static_cast<float>(scene.unit);
    for (const Volume& volume : scene.volumes)
    {
        if (!isUsable(volume.imageFromEngine) || !isUsable(volume.tileFromEngine)) continue;
        if (_records.size() == kMostVolumes) break;
        GridRecord record = recordOf(volume, unit);
        std::shared_ptr<const ValueBlocks> values;
        const auto takeOver = [&](const GridTable& table)
        {
            for (const GridRecord& known : table._records)
            {
                if (known.volume->image == volume.image) values = known.blocks->values;
                if (!record.blocks && sameBounds(*known.volume, volume))
                    record.blocks = known.blocks;
            }
        };
        if (previous && previousScene) takeOver(*previous);
        takeOver(*this);
        if (!values)
        {
            values = ValueBlocks::of(*volume.image, workers);
            ++_builtValues;
        }
        if (!record.blocks)
        {
            record.blocks = GridBlocks::of(volume, values);
            ++_builtBlocks;
        }
        _isLit = _isLit || (volume.lit && volume.law != VolumeLaw::Density);
        _records.push_back(std::move(record));
    }
}

void GridTable::widen(Vec3& low, Vec3& high) const
{
    for (const GridRecord& record : _records)
    {
        const Mat3 linear = glm::inverse(record.tileFromEngine.linear);
        for (int k = 0; k < 8; ++k)
        {
            const Vec3 corner(float(k & 1), float(k >> 1 & 1), float(k >> 2));
            const Vec3 p = linear * (corner - record.tileFromEngine.translation);
            if (!isFinite(p)) continue;
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
}

} // namespace osgRayTrace::engine
