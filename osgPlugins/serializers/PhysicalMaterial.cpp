// PhysicalMaterial.cpp - PhysicalMaterial in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"
#include "MaterialDetails.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

REGISTER_OBJECT_WRAPPER(osgRayTrace_PhysicalMaterial, new osgRayTrace::PhysicalMaterial,
                        osgRayTrace::PhysicalMaterial,
                        "osg::Object osg::StateAttribute osgRayTrace::PhysicalMaterial")
{
    ADD_VEC3_SERIALIZER(BaseColor, osg::Vec3(1.0f, 1.0f, 1.0f));
    ADD_FLOAT_SERIALIZER(Metallic, 0.0f);
    ADD_FLOAT_SERIALIZER(Roughness, 1.0f);
    ADD_FLOAT_SERIALIZER(Transmission, 0.0f);
    ADD_FLOAT_SERIALIZER(Ior, 1.5f);
    ADD_VEC3_SERIALIZER(Emission, osg::Vec3());
    ADD_OBJECT_SERIALIZER(BaseColorTexture, osg::Texture2D, nullptr);
    ADD_OBJECT_SERIALIZER(MetallicRoughnessTexture, osg::Texture2D, nullptr);
    ADD_OBJECT_SERIALIZER(TransmissionTexture, osg::Texture2D, nullptr);
    ADD_OBJECT_SERIALIZER(EmissionTexture, osg::Texture2D, nullptr);
    wrapper->addSerializer(materialDetails(), osgDB::BaseSerializer::RW_USER);
    writeInClassicLocale(*wrapper);
}
