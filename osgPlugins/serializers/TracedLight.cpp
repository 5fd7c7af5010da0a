// TracedLight.cpp - TracedLight in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/TracedLight>

#include <osgDB/ObjectWrapper>

REGISTER_OBJECT_WRAPPER(osgRayTrace_TracedLight, new osgRayTrace::TracedLight,
                        osgRayTrace::TracedLight,
                        "osg::Object osg::StateAttribute osg::Light osgRayTrace::TracedLight")
{
    writeInClassicLocale(*wrapper);
}
