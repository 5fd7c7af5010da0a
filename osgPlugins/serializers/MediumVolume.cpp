// MediumVolume.cpp - Medium and MediumVolume in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/MediumVolume>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

namespace medium
{

REGISTER_OBJECT_WRAPPER(osgRayTrace_Medium, new osgRayTrace::Medium, osgRayTrace::Medium,
                        "osg::Object osgRayTrace::Medium")
{
    ADD_VEC3_SERIALIZER(Absorption, osg::Vec3());
    ADD_VEC3_SERIALIZER(Scattering, osg::Vec3());
    ADD_VEC3_SERIALIZER(Emission, osg::Vec3());
    ADD_FLOAT_SERIALIZER(Anisotropy, 0.0f);
    ADD_INT_SERIALIZER(Priority, 0);
    BEGIN_ENUM_SERIALIZER(Phase, HENYEY_GREENSTEIN);
    ADD_ENUM_VALUE(HENYEY_GREENSTEIN);
    ADD_ENUM_VALUE(DROPLETS);
    END_ENUM_SERIALIZER();
    ADD_FLOAT_SERIALIZER(DropletSize, 10.0f);
    writeInClassicLocale(*wrapper);
}

} // namespace medium

namespace volume
{

REGISTER_OBJECT_WRAPPER(osgRayTrace_MediumVolume, new osgRayTrace::MediumVolume,
                        osgRayTrace::MediumVolume,
                        "osg::Object osg::Node osgRayTrace::MediumVolume")
{
    ADD_OBJECT_SERIALIZER(Medium, osgRayTrace::Medium, nullptr);
    ADD_FLOAT_SERIALIZER(Radius, 0.0f);
    writeInClassicLocale(*wrapper);
}

} // namespace volume
