// ObjectIdentityTest.cpp - names of objects, of which an address is not one. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ObjectIdentity.h"

#include "tests/Catch.h"

#include <set>

using namespace osgRayTrace::engine;

TEST_CASE("object names: without OSG, too, they are equal if they are of one object", "[bridge]")
{
    const osg::ref_ptr<osg::Referenced> one = new osg::Referenced, other = new osg::Referenced;
    CHECK(ObjectName(one).hostName() == ObjectName(one).hostName());
    CHECK(ObjectName(one).hostName() != ObjectName(other).hostName());
    CHECK(ObjectName(one).hostName() != nullptr);
    CHECK(ObjectName().hostName() == nullptr);
}

TEST_CASE("object names: that of a deleted object is not given to a later one", "[bridge]")
{
    std::set<std::shared_ptr<const void>> names;
    for (int i = 0; i < 1000; ++i)
    {
        const osg::ref_ptr<osg::Referenced> object = new osg::Referenced;
        names.insert(ObjectName(object).hostName());
    }
    CHECK(names.size() == 1000);
}
