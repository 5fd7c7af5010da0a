// SceneVolumes.cpp - places tiles in engine space and reads what they show. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneVolumes.h"

#include "osgRayTrace/bridge/appearance/materials/MediumConversion.h"
#include "osgRayTrace/bridge/common/FlatMatrix.h"
#include "osgRayTrace/bridge/geometry/MatrixMaps.h"
#include "osgRayTrace/bridge/graph/VolumeTiles.h"
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/scene/VolumeLimits.h"

#include <osgRayTrace/PhysicalMaterial>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The unit axes of a locator span at least this volume.
constexpr double kSmallestVolume = 1e-12;

/// What osgVolume's shaders take where no property says anything.
constexpr float kDefaultCutoff = 0.1f, kDefaultSampleDensity = 5e-4f;

/// Returns the map from engine space to the unit cube of a locator; nothing if it is singular.
std::optional<Affine> cubeFromEngine(const osgVolume::Locator* locator,
                                     const osg::Matrixd& engineFromLocal)
{
    const osg::Matrixd engineFromCube =
        locator ? locator->getTransform() * engineFromLocal : engineFromLocal;
    if (matrixFault(engineFromCube, kSmallestVolume)) return std::nullopt;
    const osg::Matrixd inverse = osg::Matrixd::inverse(engineFromCube);
    if (!inverse.valid() || matrixFault(inverse, kSmallestVolume)) return std::nullopt;
    for (int k = 0; k < 16; ++k)
        if (!(std::fabs(inverse.ptr()[k]) <= double(kLargestVolumeMap))) return std::nullopt;
    const PointMap map(inverse);
    return Affine{Mat3(Vec3(map.x), Vec3(map.y), Vec3(map.z)), Vec3(map.translation)};
}

float usable(const std::optional<float>& value, float otherwise, float least, float most)
{
    return value && std::isfinite(*value) ? std::clamp(*value, least, most) : otherwise;
}

/// Sets all but the places of a volume. Returns why it cannot be shown; null: it can.
const char* setLook(const CollectedTile& source, bool linear, VolumeImages& images, Volume& volume,
                    uint64_t& repaired)
{
    const osgVolume::VolumeTile& tile = *source.tile;
    const auto* layer = dynamic_cast<const osgVolume::ImageLayer*>(tile.getLayer());
    if (!layer || !layer->getImage()) return "it has no image";
    const VolumeImages::Result result = images.convert(*layer->getImage(), linear);
    repaired = result.repaired;
    if (!result.image) return result.fault;
    volume.image = result.image;

    const VolumeProperties properties = propertiesOf(tile);
    if (properties.transfer && !setTransfer(*properties.transfer, *layer, linear, volume, repaired))
        return kTransferFault;
    volume.law = isRayTraced(tile) ? VolumeLaw::Samples : VolumeLaw::Cells;
    constexpr float kLargest = 1e6f;
    volume.transparency = usable(properties.transparency, 1.0f, 0.0f, kLargest);
    volume.cutoff = usable(properties.cutoff, kDefaultCutoff, 0.0f, kLargest);
    volume.sampleRatio = usable(properties.sampleRatio, 1.0f, 1e-3f, 1e3f);
    volume.sampleLength = usable(properties.sampleDensity, kDefaultSampleDensity, 1e-6f, 1.0f);
    volume.lit = properties.lit;
    for (int c = 0; c < 3; ++c)
    {
        const float tint = std::clamp(source.diffuse[c], 0.0f, 1.0f);
        volume.tint[c] = linear ? linearFromSrgb(tint) : tint;
    }
    if (source.material && source.material->getInterior())
    {
        volume.law = VolumeLaw::Density;
        volume.medium = mediumOf(*source.material->getInterior());
        volume.cutoff = usable(properties.cutoff, 0.0f, 0.0f, kLargest);
    }
    return nullptr;
}

} // namespace

void setVolumes(Scene& scene, const std::vector<CollectedTile>& tiles, VolumeImages& images,
                ConversionReport& report)
{
    scene.volumes.clear();
    for (const CollectedTile& source : tiles)
    {
        const std::string name = "volume '" + source.path + "'";
        const osgVolume::Locator* tile = source.tile->getLocator();
        const osgVolume::Locator* layer =
            source.tile->getLayer() ? source.tile->getLayer()->getLocator() : nullptr;
        const auto tileMap = cubeFromEngine(tile ? tile : layer, source.engineFromLocal);
        const auto imageMap = cubeFromEngine(layer ? layer : tile, source.engineFromLocal);
        Volume volume;
        uint64_t repaired = 0;
        const char* fault = "its locator has no volume";
        if (tileMap && imageMap)
            fault = scene.volumes.size() == kMostVolumes
                        ? "the scene has 16 before it"
                        : setLook(source, !scene.displayReferred, images, volume, repaired);
        if (fault)
        {
            report.warn("skipped.volume", name, std::string(fault) + ", skipped");
            continue;
        }
        if (repaired > 0) report.count("repaired.voxel", repaired);
        volume.tileFromEngine = *tileMap;
        volume.imageFromEngine = *imageMap;
        scene.volumes.push_back(std::move(volume));
        report.count("converted.volume");
    }
    images.end();
}

} // namespace osgRayTrace::engine
