// VolumeTiles.cpp - reads the properties of osgVolume's tiles. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/VolumeTiles.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/common/LibraryName.h"
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/scene/VolumeLimits.h"

#include <osg/Group>
#include <osgVolume/MultipassTechnique>
#include <osgVolume/Property>
#include <osgVolume/RayTracedTechnique>
#include <osgVolume/VolumeSettings>

#include <algorithm>
#include <cmath>
#include <typeinfo>
#include <unordered_set>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

class PropertyReader : public osgVolume::PropertyVisitor
{
public:
    PropertyReader() : osgVolume::PropertyVisitor(true) {}

    using osgVolume::PropertyVisitor::apply;
    void apply(osgVolume::TransferFunctionProperty& property) override
    {
        found.transfer =
            dynamic_cast<const osg::TransferFunction1D*>(property.getTransferFunction());
        found.settings = found.settings || (property.getTransferFunction() && !found.transfer);
    }
    void apply(osgVolume::LightingProperty&) override { found.lit = true; }
    void apply(osgVolume::MaximumIntensityProjectionProperty&) override { found.projected = true; }
    void apply(osgVolume::IsoSurfaceProperty& p) override { found.isoValue = p.getValue(); }
    void apply(osgVolume::VolumeSettings&) override { found.settings = true; }
    void apply(osgVolume::AlphaFuncProperty& p) override { found.cutoff = p.getValue(); }
    void apply(osgVolume::TransparencyProperty& p) override { found.transparency = p.getValue(); }
    void apply(osgVolume::SampleRatioProperty& p) override { found.sampleRatio = p.getValue(); }
    void apply(osgVolume::SampleDensityProperty& p) override { found.sampleDensity = p.getValue(); }

    VolumeProperties found;
};

uint64_t matrixHash(const osgVolume::Locator* locator)
{
    if (!locator) return 1;
    const osg::Matrixd& matrix = locator->getTransform();
    return memoryHash(matrix.ptr(), 16 * sizeof(double));
}

/// Returns a hash of optional values: those that are not there are told from all that are.
uint64_t valueHash(std::initializer_list<std::optional<float>> values)
{
    uint64_t hash = 0;
    for (const std::optional<float>& value : values)
        hash = fold(hash, value ? memoryHash(&*value, sizeof *value) : 1);
    return hash;
}

} // namespace

VolumeProperties propertiesOf(const osgVolume::VolumeTile& tile)
{
    PropertyReader reader;
    // Visitors of properties take them as they may be changed; this one only reads.
    auto* property = const_cast<osgVolume::Property*>(tile.getLayer()->getProperty());
    if (property) property->accept(reader);
    return reader.found;
}

bool isRayTraced(const osgVolume::VolumeTile& tile)
{
    return dynamic_cast<const osgVolume::RayTracedTechnique*>(tile.getVolumeTechnique()) != nullptr;
}

const char* untracedTile(const osgVolume::VolumeTile& tile)
{
    const osgVolume::VolumeTechnique* technique = tile.getVolumeTechnique();
    if (!technique) return "it has no technique";
    const bool known = typeid(*technique) == typeid(osgVolume::MultipassTechnique) ||
                       typeid(*technique) == typeid(osgVolume::RayTracedTechnique);
    if (!known) return "its technique is neither MultipassTechnique nor RayTracedTechnique";
    if (tile.getNumChildren() > 0) return "it has a hull";
    const auto* layer = dynamic_cast<const osgVolume::ImageLayer*>(tile.getLayer());
    if (!layer) return "its layer is no ImageLayer";
    const VolumeProperties properties = propertiesOf(tile);
    if (properties.projected) return "it is a maximum intensity projection";
    if (properties.settings)
        return "it has VolumeSettings, or a transfer function of two or more dimensions";
    return nullptr;
}

bool setTransfer(const osg::TransferFunction1D& source, const osgVolume::ImageLayer& layer,
                 bool linear, Volume& volume, uint64_t& repaired)
{
    const osg::Image* table = source.getImage();
    if (!table || !table->data() || table->s() < 1) return false;
    if (static_cast<std::size_t>(table->s()) > kMostTransferEntries) return false;
    for (int i = 0; i < table->s(); ++i)
    {
        const osg::Vec4 color = table->getColor(static_cast<unsigned int>(i));
        Vec4 entry(color.r(), color.g(), color.b(), color.a());
        for (int c = 0; c < 4; ++c)
        {
            if (!std::isfinite(entry[c]))
            {
                entry[c] = 0.0f;
                ++repaired;
            }
            // OpenGL keeps the table as a texture of bytes.
            entry[c] = std::round(std::clamp(entry[c], 0.0f, 1.0f) * 255.0f) / 255.0f;
            if (linear && c < 3) entry[c] = linearFromSrgb(entry[c]);
        }
        volume.transfer.push_back(entry);
    }
    const float extent = source.getMaximum() - source.getMinimum();
    volume.transferScale = layer.getTexelScale()[3] / extent;
    volume.transferOffset = (layer.getTexelOffset()[3] - source.getMinimum()) / extent;
    return std::isfinite(volume.transferScale) && std::isfinite(volume.transferOffset);
}

const char* untracedTileBelow(const osg::Node& node)
{
    std::vector<const osg::Node*> open{&node};
    std::unordered_set<const osg::Node*> seen;
    while (!open.empty())
    {
        const osg::Node* next = open.back();
        open.pop_back();
        if (!next || !seen.insert(next).second) continue;
        if (isFrom(next, "osgVolume"))
            if (const auto* tile = dynamic_cast<const osgVolume::VolumeTile*>(next))
            {
                if (const char* reason = untracedTile(*tile)) return reason;
                continue;
            }
        if (const osg::Group* group = next->asGroup())
            for (unsigned int i = 0; i < group->getNumChildren(); ++i)
                open.push_back(group->getChild(i));
    }
    return nullptr;
}

uint64_t volumeHash(const osgVolume::VolumeTile& tile)
{
    const osgVolume::VolumeTechnique* technique = tile.getVolumeTechnique();
    uint64_t hash =
        fold(technique ? typeid(*technique).hash_code() : 1, matrixHash(tile.getLocator()));
    const auto* layer = dynamic_cast<const osgVolume::ImageLayer*>(tile.getLayer());
    hash = fold(hash, bitsOf(tile.getLayer()));
    if (!layer) return hash;
    hash = fold(hash, matrixHash(layer->getLocator()));
    if (const osg::Image* image = layer->getImage())
        hash = fold(fold(hash, bitsOf(image->data())), image->getModifiedCount());
    hash = fold(hash, memoryHash(layer->getTexelScale().ptr(), sizeof(osg::Vec4)));
    hash = fold(hash, memoryHash(layer->getTexelOffset().ptr(), sizeof(osg::Vec4)));
    const VolumeProperties properties = propertiesOf(tile);
    hash = fold(hash, unsigned(properties.lit) + 2u * unsigned(properties.projected) +
                          8u * unsigned(properties.settings));
    hash = fold(hash, valueHash({properties.cutoff, properties.transparency, properties.sampleRatio,
                                 properties.sampleDensity, properties.isoValue}));
    if (!properties.transfer) return hash;
    const float range[] = {properties.transfer->getMinimum(), properties.transfer->getMaximum()};
    hash = fold(hash, memoryHash(range, sizeof range));
    const osg::Image* table = properties.transfer->getImage();
    // Functions are written entry by entry, without a count of changes.
    if (table && table->data())
        hash = fold(hash, memoryHash(table->data(), table->getTotalSizeInBytes()));
    return hash;
}

} // namespace osgRayTrace::engine
