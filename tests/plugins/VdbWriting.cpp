// VdbWriting.cpp - fills grids of OpenVDB. Layer: tests.
// SPDX-License-Identifier: MIT
#include "VdbWriting.h"

#include "TemporaryFolder.h"
#include "VdbFiles.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <limits>
#include <memory>

namespace osgRayTrace::test
{

namespace
{

using openvdb::Coord;
using openvdb::CoordBBox;

const CoordBBox kBallBox(Coord(10, -42, 2), Coord(32, -19, 24));

template <class Grid> void fillBall(Grid& grid, bool levels)
{
    auto accessor = grid.getAccessor();
    for (auto voxel = kBallBox.begin(); voxel; ++voxel)
    {
        const Coord& p = *voxel;
        const float value =
            levels ? ballLevel(p.x(), p.y(), p.z()) : ballDensity(p.x(), p.y(), p.z());
        const bool active = levels ? std::fabs(value) < kLevelSetWidth : value > 0.0f;
        if (active)
            accessor.setValue(p, value);
        else if (levels && value < 0.0f)
            accessor.setValueOff(p, value);
    }
}

template <class Grid> void fillTiles(Grid& grid)
{
    grid.fill(CoordBBox(Coord(0), Coord(127)), 0.25, true);                 // a tile of 128
    grid.fill(CoordBBox(Coord(128, 0, 0), Coord(135, 7, 7)), 2.0, true);    // one of 8
    grid.fill(CoordBBox(Coord(128, 8, 0), Coord(135, 15, 7)), -1.0, false); // an inactive one
    grid.fill(CoordBBox(Coord(136, 3, 2), Coord(140, 9, 20)), 0.75, true);  // a part of leaves
    grid.fill(CoordBBox(Coord(-8, 0, 0), Coord(-1, 7, 7)), 4.0, true);      // in another node
}

template <class Grid> void fillInactive(Grid& grid)
{
    auto accessor = grid.getAccessor();
    const float background = static_cast<float>(grid.background());
    for (int leaf = 0; leaf < 8; ++leaf)
        for (int i = 0; i < 512; ++i)
        {
            const Coord p(8 * leaf + (i >> 6), i >> 3 & 7, i & 7);
            if (i % 3 == 0)
                accessor.setValue(p, 0.01f * static_cast<float>(i));
            else if (leaf == 1)
                accessor.setValueOff(p, -background);
            else if (leaf == 2)
                accessor.setValueOff(p, 7.0f);
            else if (leaf == 3)
                accessor.setValueOff(p, i % 2 ? background : -background);
            else if (leaf == 4)
                accessor.setValueOff(p, i % 2 ? background : 7.0f);
            else if (leaf == 5)
                accessor.setValueOff(p, i % 2 ? 9.0f : 7.0f);
            else if (leaf == 6)
                accessor.setValueOff(p, static_cast<float>(i));
            else
                accessor.setValueOff(p, background);
        }
}

template <class Grid> void fill(Grid& grid, VdbContent content)
{
    auto accessor = grid.getAccessor();
    switch (content)
    {
    case VdbContent::LevelSet:
        return fillBall(grid, true);
    case VdbContent::Tiles:
        return fillTiles(grid);
    case VdbContent::Inactive:
        return fillInactive(grid);
    case VdbContent::Octants:
        for (int i = -150; i < 150; i += 3)
            accessor.setValue(Coord(i, (7 * i) % 31, -i / 2),
                              1.0f + 0.001f * static_cast<float>(i));
        return;
    case VdbContent::Far:
        accessor.setValue(Coord(0), 1.0f);
        accessor.setValue(Coord(100000, 3, 2), 2.0f);
        return;
    case VdbContent::Empty:
        return;
    case VdbContent::NotFinite:
    case VdbContent::Fog:
        fillBall(grid, false);
        if (content == VdbContent::Fog) return;
        accessor.setValue(Coord(20, -30, 13), std::numeric_limits<float>::quiet_NaN());
        accessor.setValue(Coord(21, -30, 13), std::numeric_limits<float>::infinity());
        return;
    }
}

openvdb::math::Transform::Ptr transformOf(VdbMap map)
{
    using namespace openvdb::math;
    const auto of = [](MapBase* made) { return std::make_shared<Transform>(MapBase::Ptr(made)); };
    switch (map)
    {
    case VdbMap::UniformScale:
        return Transform::createLinearTransform(0.125);
    case VdbMap::Scale:
        return of(new ScaleMap(Vec3d(0.5, 0.25, 0.125)));
    case VdbMap::ScaleTranslate:
        return of(new ScaleTranslateMap(Vec3d(0.5, 0.25, 2.0), Vec3d(10.0, -3.0, 7.0)));
    case VdbMap::Translation:
        return of(new TranslationMap(Vec3d(1.0, 2.0, 3.0)));
    case VdbMap::Affine:
    {
        Transform::Ptr result = Transform::createLinearTransform(0.5);
        result->postRotate(0.7, X_AXIS);
        result->postScale(Vec3d(1.0, 2.0, 0.5));
        result->postRotate(-0.3, Z_AXIS);
        result->postTranslate(Vec3d(5.0, 6.0, -7.0));
        return result;
    }
    case VdbMap::Unitary:
        return of(new UnitaryMap(Vec3d(1.0, 1.0, 0.0), 0.5));
    case VdbMap::Frustum:
        return Transform::createFrustumTransform(openvdb::BBoxd(Vec3d(0.0), Vec3d(100.0)), 0.5,
                                                 10.0, 1.0);
    }
    return nullptr;
}

std::string bytesOf(const openvdb::GridPtrVec& grids, std::uint32_t compression, bool asStream)
{
    if (asStream)
    {
        std::ostringstream stream;
        openvdb::io::Stream(stream).write(grids);
        return stream.str();
    }
    const TemporaryFolder folder;
    openvdb::io::File file(folder / "grids.vdb");
    file.setCompression(compression);
    file.write(grids);
    file.close();
    return fileBytes(folder / "grids.vdb");
}

template <class Grid> VdbWritten written(const VdbStyle& style)
{
    const float background = style.content == VdbContent::LevelSet   ? float(kLevelSetWidth)
                             : style.content == VdbContent::Tiles    ? 0.5f
                             : style.content == VdbContent::Inactive ? 5.0f
                                                                     : 0.0f;
    const auto grid = Grid::create(background);
    fill(*grid, style.content);
    grid->setName(style.name);
    grid->setTransform(transformOf(style.map));
    grid->setSaveFloatAsHalf(style.half);
    if (style.isFog) grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    if (style.content == VdbContent::LevelSet) grid->setGridClass(openvdb::GRID_LEVEL_SET);

    openvdb::GridPtrVec grids{grid};
    if (style.others)
    {
        const auto velocity = openvdb::Vec3SGrid::create();
        velocity->tree().setValue(Coord(1, 2, 3), openvdb::Vec3s(1.0f, 2.0f, 3.0f));
        velocity->setName("vel");
        const auto same = openvdb::FloatGrid::create();
        same->tree().setValue(Coord(4, 5, 6), 8.0f);
        same->setName("flame");
        const auto shared = grid->copyGrid();
        shared->setName("shared");
        shared->setTransform(transformOf(VdbMap::Translation));
        grids = {velocity, same, grid, shared};
    }

    VdbWritten result;
    result.bytes = bytesOf(grids, style.compression, style.asStream);
    const CoordBBox box = grid->evalActiveVoxelBoundingBox();
    for (int k = 0; k < 3; ++k)
    {
        result.low[std::size_t(k)] = box.min()[k];
        result.size[std::size_t(k)] = box.dim()[k];
    }
    result.value = [grid](int x, int y, int z)
    { return static_cast<float>(grid->tree().getValue(Coord(x, y, z))); };
    result.world = [grid](int x, int y, int z)
    {
        const openvdb::Vec3d p = grid->indexToWorld(Coord(x, y, z));
        return std::array<double, 3>{p.x(), p.y(), p.z()};
    };
    return result;
}

} // namespace

VdbWritten writeVdb(const VdbStyle& style)
{
    openvdb::initialize();
    return style.isDouble ? written<openvdb::DoubleGrid>(style)
                          : written<openvdb::FloatGrid>(style);
}

std::string writeDenseVdb(int size, std::uint32_t compression)
{
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create();
    auto accessor = grid->getAccessor();
    for (int x = 0; x < size; ++x)
        for (int y = 0; y < size; ++y)
            for (int z = 0; z < size; ++z)
                accessor.setValue(Coord(x, y, z), 0.5f + 0.4f * std::sin(0.05f * float(x)) *
                                                             std::sin(0.07f * float(y + z)));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return bytesOf({grid}, compression, false);
}

} // namespace osgRayTrace::test
