// RayTracedScene.cpp - RayTracedScene in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/RayTracedScene>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

// The scene is the group's children. The drawable that shows it is made anew by the constructor.
REGISTER_OBJECT_WRAPPER(osgRayTrace_RayTracedScene, new osgRayTrace::RayTracedScene,
                        osgRayTrace::RayTracedScene,
                        "osg::Object osg::Node osg::Group osgRayTrace::RayTracedScene")
{
    ADD_BOOL_SERIALIZER(Enabled, true);
    ADD_OBJECT_SERIALIZER(Settings, osgRayTrace::RayTraceSettings, nullptr);
    writeInClassicLocale(*wrapper);
}
