// AreaLight.cpp - AreaLight in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/AreaLight>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

REGISTER_OBJECT_WRAPPER(osgRayTrace_AreaLight, new osgRayTrace::AreaLight, osgRayTrace::AreaLight,
                        "osg::Object osg::Node osgRayTrace::AreaLight")
{
    ADD_VEC3_SERIALIZER(Corner, osg::Vec3(-0.5f, -0.5f, 0.0f));
    ADD_VEC3_SERIALIZER(EdgeU, osg::Vec3(1.0f, 0.0f, 0.0f));
    ADD_VEC3_SERIALIZER(EdgeV, osg::Vec3(0.0f, 1.0f, 0.0f));
    ADD_VEC3_SERIALIZER(Radiance, osg::Vec3(10.0f, 10.0f, 10.0f));
    ADD_BOOL_SERIALIZER(TwoSided, false);
    writeInClassicLocale(*wrapper);
}
