// VolumeTiles.h - what osgVolume's tiles ask for, and which of them rays can show. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Volume.h"

#include <osg/Node>
#include <osg/TransferFunction>
#include <osgVolume/VolumeTile>

#include <optional>

namespace osgRayTrace::engine
{

/// The properties of a tile's layer. What no property sets is nothing.
struct VolumeProperties
{
    osg::ref_ptr<const osg::TransferFunction1D> transfer;
    bool lit = false;              ///< LightingProperty
    bool projected = false;        ///< MaximumIntensityProjectionProperty
    bool settings = false;         ///< VolumeSettings, or a transfer function of another class
    std::optional<float> isoValue; ///< IsoSurfaceProperty
    std::optional<float> cutoff, transparency, sampleRatio, sampleDensity;
};

/// Returns the active properties of a tile with a layer.
VolumeProperties propertiesOf(const osgVolume::VolumeTile& tile);

/// Sets the table of a transfer function. linear: its colours are decoded from sRGB. Adds the
/// number of entries that are not finite to repaired. Returns false, for kTransferFault, if the
/// function is not usable.
bool setTransfer(const osg::TransferFunction1D& source, const osgVolume::ImageLayer& layer,
                 bool linear, Volume& volume, uint64_t& repaired);
constexpr const char* kTransferFault =
    "its transfer function has no entries, more than 65,536 or no extent";

/// Returns whether the tile is one of osgVolume::RayTracedTechnique. Others that are traced have a
/// MultipassTechnique.
bool isRayTraced(const osgVolume::VolumeTile& tile);

/// Returns why OpenGL has to draw a tile, for messages; null: rays can show the tile.
const char* untracedTile(const osgVolume::VolumeTile& tile);

/// Returns untracedTile() of the first tile at or below a node for which it is not null. A
/// VolumeScene draws its tiles together, so one of them decides for all.
const char* untracedTileBelow(const osg::Node& node);

/// Returns a number that changes with all that a traced tile shows, but for its place and state.
uint64_t volumeHash(const osgVolume::VolumeTile& tile);

} // namespace osgRayTrace::engine
