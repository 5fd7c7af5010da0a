// IsoSurfaces.cpp - has isosurfaces meshed, and gives them the state of osgVolume's shaders. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/IsoSurfaces.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/appearance/textures/VolumeImages.h"
#include "osgRayTrace/bridge/common/FlatMatrix.h"
#include "osgRayTrace/bridge/common/Unshared.h"
#include "osgRayTrace/bridge/geometry/MatrixMaps.h"
#include "osgRayTrace/bridge/graph/VolumeTiles.h"
#include "osgRayTrace/media/IsoSurface.h"
#include "osgRayTrace/media/VolumeSample.h"

#include <osg/BlendFunc>
#include <osg/Material>
#include <osg/Program>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kSmallestVolume = 1e-12; ///< of a box that another one is seen from

/// Returns the places of an image and of its tile, as osgVolume's techniques choose them.
std::pair<osg::Matrixd, osg::Matrixd> placesOf(const osgVolume::VolumeTile& tile)
{
    const osgVolume::Locator* outer = tile.getLocator();
    const osgVolume::Locator* inner = tile.getLayer()->getLocator();
    if (!outer) outer = inner;
    if (!inner) inner = outer;
    if (!inner) return {};
    return {inner->getTransform(), outer->getTransform()};
}

/// Returns the map from the unit cube of the image to that of the tile; nothing if one of them has
/// no volume.
std::optional<Affine> tileFromImage(const osg::Matrixd& image, const osg::Matrixd& tile)
{
    if (image == tile) return Affine();
    if (matrixFault(image, kSmallestVolume) || matrixFault(tile, kSmallestVolume))
        return std::nullopt;
    const osg::Matrixd matrix = image * osg::Matrixd::inverse(tile);
    if (matrixFault(matrix, kSmallestVolume)) return std::nullopt;
    const PointMap map(matrix);
    return Affine{Mat3(Vec3(map.x), Vec3(map.y), Vec3(map.z)), Vec3(map.translation)};
}

void setArrays(const IsoSurface& surface, osg::Geometry& geometry)
{
    const auto count = static_cast<unsigned int>(surface.positions.size());
    // The arrays of the last scene may still be read.
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array(count),
                                       normals = new osg::Vec3Array(count);
    for (unsigned int i = 0; i < count; ++i)
    {
        const Vec3 &p = surface.positions[i], &n = surface.normals[i];
        (*vertices)[i].set(p.x, p.y, p.z);
        (*normals)[i].set(n.x, n.y, n.z);
    }
    const osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    triangles->reserve(static_cast<unsigned int>(3 * surface.triangles.size()));
    for (const UVec3& t : surface.triangles)
        for (int k = 0; k < 3; ++k)
            triangles->push_back(t[k]);
    geometry.setVertexArray(vertices);
    geometry.setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry.setPrimitiveSetList({triangles});
    geometry.dirtyBound();
}

/// Returns the colour and the opacity that osgVolume's shaders give a surface before they light it.
osg::Vec4 colorOf(const osgVolume::VolumeTile& tile, const VolumeProperties& properties,
                  const Volume& volume)
{
    if (!volume.transfer.empty())
    {
        const Vec4 color = transferred(volume, *properties.isoValue);
        return {color.x, color.y, color.z, color.w};
    }
    const float opacity = isRayTraced(tile) ? 1.0f : properties.transparency.value_or(1.0f);
    return {1.0f, 1.0f, 1.0f, opacity > 0.0f ? std::min(opacity, 1.0f) : 0.0f};
}

/// Returns the state of a surface: that of osgVolume's shaders takes the place of what the tile
/// inherits.
osg::ref_ptr<osg::StateSet> stateOf(const osg::Vec4* color)
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    state->setAttribute(new osg::Program); // without shaders: none of those above
    state->setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
    if (!color) return state;
    state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    for (unsigned int unit = 0; unit < 2; ++unit)
        for (const GLenum target : {GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_3D,
                                    GL_TEXTURE_CUBE_MAP, GL_TEXTURE_RECTANGLE})
            state->setTextureMode(unit, target, osg::StateAttribute::OFF);
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setAmbient(osg::Material::FRONT_AND_BACK, *color);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, *color);
    state->setAttribute(material);
    const bool blends = color->a() < 1.0f;
    state->setMode(GL_BLEND, blends ? osg::StateAttribute::ON : osg::StateAttribute::OFF);
    if (blends) state->setAttribute(new osg::BlendFunc);
    return state;
}

} // namespace

IsoSurfaces::Result IsoSurfaces::of(const osgVolume::VolumeTile& tile, bool hasMaterial)
{
    Entry& entry = _entries[&tile];
    entry.tile = &tile;
    entry.used = _round;
    const auto& layer = *static_cast<const osgVolume::ImageLayer*>(tile.getLayer());
    const VolumeProperties properties = propertiesOf(tile);
    const osg::Image* image = layer.getImage();
    if (!image) return {nullptr, "it has no image"};
    Volume look;
    uint64_t repaired = 0;
    if (properties.transfer && !setTransfer(*properties.transfer, layer, false, look, repaired))
        return {nullptr, kTransferFault};
    const float value = *properties.isoValue;
    if (!std::isfinite(value)) return {nullptr, "the value of its isosurface is not finite"};
    const auto [place, tilePlace] = placesOf(tile);
    const std::optional<Affine> box = tileFromImage(place, tilePlace);
    if (!box) return {nullptr, "its locator has no volume"};

    uint64_t hash = fold(bitsOf(image->data()), image->getModifiedCount());
    hash = fold(fold(hash, memoryHash(&value, sizeof value)), memoryHash(&*box, sizeof *box));
    if (!entry.node || entry.image != image || entry.hash != hash)
    {
        if (!entry.node)
        {
            entry.node = new osg::MatrixTransform;
            entry.geometry = new osg::Geometry;
            entry.geometry->setName("isosurface");
            entry.node->addChild(entry.geometry);
        }
        const VolumeImages::Result voxels = VolumeImages::values(*image);
        entry.image = image;
        entry.hash = hash;
        entry.repaired = voxels.repaired;
        entry.fault = voxels.image ? nullptr : voxels.fault;
        IsoSurface surface;
        if (voxels.image)
        {
            if (auto found = isoSurface(*voxels.image, value, *box, kMostIsoTriangles))
                surface = std::move(*found);
            else
                entry.fault = "its isosurface has more than 33,554,432 triangles";
        }
        setArrays(surface, *entry.geometry);
    }
    if (entry.fault) return {nullptr, entry.fault};
    if (entry.geometry->getVertexArray()->getNumElements() == 0)
        return {nullptr, nullptr, entry.repaired};
    entry.node->setMatrix(place);
    const osg::Vec4 color = colorOf(tile, properties, look);
    entry.geometry->setStateSet(stateOf(hasMaterial ? nullptr : &color));
    return {entry.node, nullptr, entry.repaired + repaired};
}

void IsoSurfaces::end()
{
    eraseUnused(_entries, _round);
}

void IsoSurfaces::dropUnshared()
{
    eraseUnshared(_entries, [](const Entry& entry) { return entry.tile.get(); });
}

} // namespace osgRayTrace::engine
