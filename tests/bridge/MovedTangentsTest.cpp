// MovedTangentsTest.cpp - tangents of rigs and morphs. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/bridge/geometry/GeometryConverter.h"
#include "osgRayTrace/bridge/geometry/MovedTangents.h"

#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>

using namespace osgRayTrace::engine;

namespace
{

osg::ref_ptr<osg::Vec4Array> tangents(const osg::Vec4& value)
{
    return new osg::Vec4Array(osg::Array::BIND_PER_VERTEX, 3,
                              std::vector<osg::Vec4>(3, value).data());
}

template <class Animated> osg::ref_ptr<Animated> triangle()
{
    const osg::ref_ptr<Animated> geometry = new Animated;
    const auto plain = triangleGeometry();
    geometry->setVertexArray(plain->getVertexArray());
    geometry->setPrimitiveSetList(plain->getPrimitiveSetList());
    geometry->setVertexAttribArray(6, tangents(osg::Vec4(1, 0, 0, -1)));
    return geometry;
}

osg::ref_ptr<osg::Geometry> target(osg::Array* moves)
{
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(new osg::Vec3Array(3));
    if (moves) geometry->setVertexAttribArray(6, moves, osg::Array::BIND_PER_VERTEX);
    return geometry;
}

osg::Vec4 first(const osg::Array& array)
{
    return static_cast<const osg::Vec4Array&>(array)[0];
}

} // namespace

TEST_CASE("moved tangents: those of plain geometry hold until it deforms", "[bridge]")
{
    const auto geometry = triangle<osg::Geometry>();
    CHECK(tangentsNow(*geometry, false) == geometry->getVertexAttribArray(6));
    CHECK_FALSE(tangentsNow(*geometry, true));
    CHECK_FALSE(tangentsNow(*triangleGeometry(), false));
}

TEST_CASE("moved tangents: targets of a morph move them by the weights above 0", "[bridge]")
{
    using osgAnimation::MorphGeometry;
    const auto morph = triangle<MorphGeometry>();
    morph->setMethod(MorphGeometry::RELATIVE);
    morph->addMorphTarget(target(nullptr), 1.0f);
    CHECK_FALSE(tangentsNow(*morph, false)); // nobody has moved them
    const osg::ref_ptr<osg::Vec3Array> moves = new osg::Vec3Array(3);
    std::fill(moves->begin(), moves->end(), osg::Vec3(0, 2, 0));
    morph->addMorphTarget(target(moves), 0.5f);
    morph->addMorphTarget(target(tangents(osg::Vec4(0, 0, 4, 99))), 0.25f);
    morph->addMorphTarget(target(tangents(osg::Vec4(7, 7, 7, 7))), -1.0f);
    morph->addMorphTarget(target(new osg::Vec4Array(2)), 1.0f); // does not fit
    for (const bool deforms : {false, true})
    {
        const auto now = tangentsNow(*morph, deforms);
        REQUIRE(now);
        CHECK(first(*now) == osg::Vec4(1, 1, 1, -1));
    }
    morph->setMethod(MorphGeometry::NORMALIZED); // base weight 1 - (1 + 0.5 + 0.25 - 1 + 1)
    CHECK(first(*tangentsNow(*morph, true)) == osg::Vec4(-0.75f, 1, 1, -1));
    CHECK(first(*morph->getVertexAttribArray(6)) == osg::Vec4(1, 0, 0, -1)); // stays

    MeshRequest request;
    request.copies = true;
    request.transform = osg::Matrixd::scale(2.0, 1.0, 1.0);
    CHECK(convertGeometry(*morph, request).mesh->tangents[2] == Vec4(-1.5f, 1, 1, -1));
}

TEST_CASE("moved tangents: rigs have none that would fit their pose", "[bridge]")
{
    const auto rig = triangle<osgAnimation::RigGeometry>();
    CHECK_FALSE(tangentsNow(*rig, false));
    CHECK_FALSE(tangentsNow(*rig, true));
}
