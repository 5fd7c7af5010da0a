// IsoSurfaces.h - isosurfaces of osgVolume's tiles, as geometry in the tile's place. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgVolume/VolumeTile>

#include <cstddef>
#include <map>

namespace osgRayTrace::engine
{

/// The largest number of triangles of an isosurface: with its BVH it takes about 6 GiB.
constexpr std::size_t kMostIsoTriangles = std::size_t(1) << 25;

/// Holds the isosurfaces of tiles between conversions. The triangles are in the unit cube of the
/// image, so that an edit of the locator moves them and an edit of colours changes a state alone.
class IsoSurfaces
{
public:
    struct Result
    {
        osg::ref_ptr<osg::MatrixTransform> node; ///< null: see fault
        const char* fault = nullptr;             ///< why there is none; null: it has no triangles
        uint64_t repaired = 0; ///< values that are not finite, taken as 0, or too large
    };

    void begin() { ++_round; }

    /// Returns the surface of a tile with an ImageLayer and an IsoSurfaceProperty, below the
    /// transform of its locator. It is of the colour that osgVolume gives it, unless hasMaterial:
    /// then the tile's own state tells. Until end() the node stays, and from one conversion to the
    /// next as long as the tile is asked for.
    Result of(const osgVolume::VolumeTile& tile, bool hasMaterial);

    /// Forgets the tiles that were not asked for.
    void end();

    /// Forgets the tiles that nobody else holds.
    void dropUnshared();

private:
    struct Entry
    {
        osg::ref_ptr<const osgVolume::VolumeTile> tile; ///< keeps the address unique
        osg::ref_ptr<const osg::Image> image;           ///< likewise
        osg::ref_ptr<osg::MatrixTransform> node;
        osg::ref_ptr<osg::Geometry> geometry;
        uint64_t hash = 0; ///< of what the triangles depend on
        const char* fault = nullptr;
        uint64_t repaired = 0;
        unsigned int used = 0;
    };

    std::map<const osgVolume::VolumeTile*, Entry> _entries;
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
