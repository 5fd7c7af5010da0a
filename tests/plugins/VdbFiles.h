// VdbFiles.h - what the OpenVDB files of tests hold, and our plugin. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/Catch.h"

#include <osgDB/Registry>
#include <osgVolume/Property>
#include <osgVolume/VolumeTile>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace osgRayTrace::test
{

/// The files in tests/plugins/vdb, which OpenVDB 10.0.1 has written (VdbWrittenTest.cpp).
constexpr const char* kVdbFiles[] = {"fog_blosc", "fog_zip_half", "fog_active", "level_set",
                                     "tiles_double"};

constexpr double kBallRadius = 7.0; ///< voxels

/// Returns how far a voxel is from the middle of the ball, in voxels.
inline double ballDistance(int x, int y, int z)
{
    return std::sqrt((x - 20.5) * (x - 20.5) + (y + 30.5) * (y + 30.5) + (z - 13.0) * (z - 13.0));
}

/// Returns the density of a voxel of the ball of fog: 0 to 3.
inline float ballDensity(int x, int y, int z)
{
    return static_cast<float>(std::max(0.0, 3.0 * (1.0 - ballDistance(x, y, z) / kBallRadius)));
}

constexpr double kLevelSetRadius = 5.0, kLevelSetWidth = 3.0;

/// Returns the value of a voxel of the level set of a ball.
inline float ballLevel(int x, int y, int z)
{
    return static_cast<float>(
        std::clamp(ballDistance(x, y, z) - kLevelSetRadius, -kLevelSetWidth, kLevelSetWidth));
}

/// Returns our plugin, or fails.
inline osgDB::ReaderWriter* vdbPlugin()
{
    osgDB::ReaderWriter* result = osgDB::Registry::instance()->getReaderWriterForExtension("vdb");
    REQUIRE(result);
    return result;
}

inline osgDB::ReaderWriter::ReadResult readVdb(const std::string& bytes,
                                               const std::string& options = "")
{
    std::istringstream stream(bytes);
    const osg::ref_ptr<osgDB::Options> parsed = new osgDB::Options(options);
    return vdbPlugin()->readNode(stream, parsed);
}

/// Reads the bytes as a tile, or fails.
inline osg::ref_ptr<osgVolume::VolumeTile> tileOf(const std::string& bytes,
                                                  const std::string& options = "")
{
    auto result = readVdb(bytes, options);
    INFO(result.message());
    REQUIRE(result.success());
    osg::ref_ptr<osgVolume::VolumeTile> tile =
        dynamic_cast<osgVolume::VolumeTile*>(result.getNode());
    REQUIRE(tile);
    REQUIRE(dynamic_cast<osgVolume::ImageLayer*>(tile->getLayer()));
    return tile;
}

inline const osgVolume::ImageLayer& layerOf(const osgVolume::VolumeTile& tile)
{
    return static_cast<const osgVolume::ImageLayer&>(*tile.getLayer());
}

/// Returns the value of a cell in the grid's own measure.
inline float valueAt(const osgVolume::VolumeTile& tile, int x, int y, int z)
{
    const osgVolume::ImageLayer& layer = layerOf(tile);
    return *reinterpret_cast<const float*>(layer.getImage()->data(x, y, z)) *
           layer.getTexelScale()[3];
}

/// Returns where the middle of a cell is.
inline osg::Vec3d placeOf(const osgVolume::VolumeTile& tile, int x, int y, int z)
{
    const osg::Image& image = *layerOf(tile).getImage();
    const osg::Vec3d cube((x + 0.5) / image.s(), (y + 0.5) / image.t(), (z + 0.5) / image.r());
    return cube * tile.getLocator()->getTransform();
}

inline std::string fileBytes(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    REQUIRE(stream);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}

} // namespace osgRayTrace::test
