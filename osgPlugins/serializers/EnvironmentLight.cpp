// EnvironmentLight.cpp - EnvironmentLight in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include "osgPlugins/OwnFolder.h"

#include <osgRayTrace/EnvironmentLight>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

REGISTER_OBJECT_WRAPPER(osgRayTrace_EnvironmentLight, new osgRayTrace::EnvironmentLight,
                        osgRayTrace::EnvironmentLight,
                        "osg::Object osg::Node osgRayTrace::EnvironmentLight")
{
    osgRayTrace::engine::preferOwnFolder(); // the light's image may be a .hdr file
    ADD_IMAGE_SERIALIZER(Image, osg::Image, nullptr);
    ADD_OBJECT_SERIALIZER(CubeMap, osg::TextureCubeMap, nullptr);
    ADD_QUAT_SERIALIZER(Rotation, osg::Quat());
    ADD_VEC3_SERIALIZER(Scale, osg::Vec3(1.0f, 1.0f, 1.0f));
    ADD_BOOL_SERIALIZER(Visible, true);
    writeInClassicLocale(*wrapper);
}
