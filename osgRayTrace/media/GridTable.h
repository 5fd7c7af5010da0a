// GridTable.h - the volumes of a scene, ready for rays. Layer: media.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/media/GridBlocks.h"
#include "osgRayTrace/media/MediumTable.h"
#include "osgRayTrace/scene/Scene.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// A volume with its bounds and its coefficients in engine units.
struct GridRecord
{
    const Volume* volume = nullptr; ///< of the scene
    std::shared_ptr<const GridBlocks> blocks;
    Affine imageFromEngine, tileFromEngine;
    Vec3 sigmaT{0.0f}, sigmaS{0.0f}, emission{0.0f}; ///< at an amount of 1, with VolumeLaw::Density
    Phase phase;
    float depthPerWidth = 0.0f; ///< optical depth of an amount of 1 along a way of 1 in the unit
                                ///< cube of the image, with other laws
    bool scatters = false;

    /// Returns the extinction at an amount of 1 along a unit direction [1/engine unit]. Volumes
    /// whose law counts cells or steps have another one in each direction if their locator does
    /// not scale evenly, as OpenGL draws them.
    Vec3 extinction(Vec3 direction) const
    {
        if (volume->law == VolumeLaw::Density) return sigmaT;
        return Vec3(glm::length(imageFromEngine.linear * direction) * depthPerWidth);
    }
};

/// Holds the volumes of a scene that are fit for rays.
class GridTable
{
public:
    GridTable() = default;

    /// previous: the table of the last version of the scene, from which the blocks of images and
    /// transfer functions that have not changed are taken over; may be null, as may workers.
    GridTable(const Scene& scene, const GridTable* previous, const Scene* previousScene,
              const Workers* workers);

    std::size_t size() const { return _records.size(); }
    const GridRecord& operator[](std::size_t i) const { return _records[i]; }

    /// Returns the number of images whose blocks were found anew, and of volumes whose bounds were.
    std::size_t builtValues() const { return _builtValues; }
    std::size_t builtBlocks() const { return _builtBlocks; }

    /// Returns whether a volume glows in colours that a light lights: see VolumeLighting.h.
    bool isLit() const { return _isLit; }

    /// Widens a box [engine space] by the boxes of the volumes.
    void widen(Vec3& low, Vec3& high) const;

private:
    std::vector<GridRecord> _records;
    std::size_t _builtValues = 0, _builtBlocks = 0;
    bool _isLit = false;
};

} // namespace osgRayTrace::engine
