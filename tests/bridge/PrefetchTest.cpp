// PrefetchTest.cpp - the bytes that are fetched ahead are those of the members that are read.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/bridge/changes/Prefetch.h"

#include <osg/Array>
#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <cstdlib>

using namespace osgRayTrace::engine;

namespace
{

constexpr int kCacheLine = 64;

template <class Object, class Member> int offsetIn(const Object& object, const Member& member)
{
    return static_cast<int>(reinterpret_cast<const char*>(&member) -
                            reinterpret_cast<const char*>(&object));
}

/// Whether a member begins less than a cache line away from a byte that is fetched.
template <std::size_t N> bool isFetched(int offset, const int (&bytes)[N])
{
    for (const int byte : bytes)
        if (std::abs(byte - offset) < kCacheLine) return true;
    return false;
}

struct GeometryMembers : osg::Geometry
{
    void check() const
    {
        const osg::Geometry& self = *this;
        CHECK(isFetched(offsetIn(self, _userDataContainer), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _nodeMask), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _stateset), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _drawCallback), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _primitives), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _vertexArray), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _normalArray), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _colorArray), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _texCoordList), kGeometryBytes));
        CHECK(isFetched(offsetIn(self, _vertexAttribList), kGeometryBytes));
    }
};

struct TransformMembers : osg::MatrixTransform
{
    void check() const
    {
        const osg::MatrixTransform& self = *this;
        CHECK(isFetched(offsetIn(self, _userDataContainer), kGroupBytes));
        CHECK(isFetched(offsetIn(self, _nodeMask), kGroupBytes));
        CHECK(isFetched(offsetIn(self, _stateset), kGroupBytes));
        CHECK(isFetched(offsetIn(self, _children), kGroupBytes));
        const int matrix = offsetIn(self, _matrix);
        for (int byte = matrix; byte < matrix + int(16 * sizeof(double)); byte += 8)
            CHECK(isFetched(byte, kGroupBytes));
    }
};

struct ArrayMembers : osg::Vec3Array
{
    void check() const
    {
        const osg::Vec3Array& self = *this;
        CHECK(isFetched(offsetIn(self, _modifiedCount), kBufferBytes));
        CHECK(isFetched(offsetIn(self, self.asVector()), kBufferBytes));
    }
};

} // namespace

TEST_CASE("prefetch: the offsets are those of the members of this version of OSG", "[bridge]")
{
    osg::ref_ptr<GeometryMembers> geometry = new GeometryMembers;
    geometry->check();
    osg::ref_ptr<TransformMembers> transform = new TransformMembers;
    transform->check();
    osg::ref_ptr<ArrayMembers> array = new ArrayMembers;
    array->check();
}
