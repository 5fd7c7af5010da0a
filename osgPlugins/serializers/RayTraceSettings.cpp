// RayTraceSettings.cpp - RayTraceSettings in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/RayTraceSettings>

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

// All options by name: files of other versions, with more options or fewer, stay readable, and the
// environment of the reader changes nothing that the writer had set. Names are single words.

static bool checkOptions(const osgRayTrace::RayTraceSettings&)
{
    return true;
}

static bool readOptions(osgDB::InputStream& is, osgRayTrace::RayTraceSettings& settings)
{
    const unsigned int count = is.readSize();
    is >> is.BEGIN_BRACKET;
    for (unsigned int i = 0; i < count && !is.getException(); ++i)
    {
        std::string name;
        std::string value;
        is >> name;
        is.readWrappedString(value);
        if (is.getException() || settings.set(name, value)) continue;
        OSG_WARN << "osgRayTrace: a file sets " << name << " to '" << value
                 << "', which this version does not know; ignored" << std::endl;
    }
    is >> is.END_BRACKET;
    return !is.getException();
}

static bool writeOptions(osgDB::OutputStream& os, const osgRayTrace::RayTraceSettings& settings)
{
    const auto options = osgRayTrace::RayTraceSettings::options();
    os.writeSize(options.size());
    os << os.BEGIN_BRACKET << std::endl;
    for (const auto& option : options)
    {
        os << option.name;
        os.writeWrappedString(settings.get(option.name));
        os << std::endl;
    }
    os << os.END_BRACKET << std::endl;
    return true;
}

REGISTER_OBJECT_WRAPPER(osgRayTrace_RayTraceSettings, new osgRayTrace::RayTraceSettings,
                        osgRayTrace::RayTraceSettings, "osg::Object osgRayTrace::RayTraceSettings")
{
    ADD_USER_SERIALIZER(Options);
}
