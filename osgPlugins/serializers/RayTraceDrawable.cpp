// RayTraceDrawable.cpp - RayTraceDrawable in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/RayTraceDrawable>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

REGISTER_OBJECT_WRAPPER(osgRayTrace_RayTraceDrawable, new osgRayTrace::RayTraceDrawable,
                        osgRayTrace::RayTraceDrawable,
                        "osg::Object osg::Node osg::Drawable osgRayTrace::RayTraceDrawable")
{
    ADD_OBJECT_SERIALIZER(Scene, osg::Node, nullptr);
    ADD_OBJECT_SERIALIZER(Settings, osgRayTrace::RayTraceSettings, nullptr);
    writeInClassicLocale(*wrapper);
}
