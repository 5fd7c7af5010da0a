// RayTracedScene.cpp - RayTracedScene in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/RayTracedScene>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

// A file has the scene as the group's children. The constructor makes the drawable that shows them
// anew.
REGISTER_OBJECT_WRAPPER(osgRayTrace_RayTracedScene, new osgRayTrace::RayTracedScene,
                        osgRayTrace::RayTracedScene,
                        "osg::Object osg::Node osg::Group osgRayTrace::RayTracedScene")
{
    ADD_BOOL_SERIALIZER(Enabled, true);
    ADD_OBJECT_SERIALIZER(Settings, osgRayTrace::RayTraceSettings, nullptr);
    writeInClassicLocale(*wrapper);
}
