// RayTraceSettings.cpp - RayTraceSettings in .osgt, .osgb and .osgx files. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "ClassicLocale.h"

#include <osgRayTrace/RayTraceSettings>

#include <osg/Notify>
#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

#include <cstdio>
#include <cstring>
#include <string>

// A file has all options by name: files of other versions, with more options or fewer, stay
// readable, and the environment of the reader changes nothing that the writer had set. Names and
// values are single words: characters of values that may not be in a word are written as %20.

// A file does not say to whom whoever reads it sends scenes.
static const char* const kServers = "servers";

static bool isPlain(char c)
{
    const bool alphanumeric =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    return alphanumeric || std::strchr("-+_.,;:=/*", c) != nullptr;
}

static std::string wordOf(const std::string& value)
{
    std::string word;
    for (const char c : value)
    {
        char code[4];
        std::snprintf(code, sizeof code, "%%%02x", static_cast<unsigned char>(c));
        word += c != '\0' && isPlain(c) ? std::string(1, c) : code;
    }
    return word;
}

static std::string valueOf(const std::string& word)
{
    std::string value;
    for (std::size_t i = 0; i < word.size(); ++i)
    {
        unsigned int code = 0;
        const bool coded =
            word[i] == '%' && std::sscanf(word.substr(i + 1, 2).c_str(), "%2x", &code) == 1;
        value += coded ? static_cast<char>(code) : word[i];
        if (coded) i += 2;
    }
    return value;
}

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
        is >> name >> value;
        if (name == kServers)
        {
            OSG_WARN << "osgRayTrace: a file names render servers; ignored, the viewer decides "
                        "where its scenes go"
                     << std::endl;
            continue;
        }
        if (is.getException() || settings.set(name, valueOf(value))) continue;
        OSG_WARN << "osgRayTrace: a file sets " << name << " to '" << value
                 << "', which this version does not know; ignored" << std::endl;
    }
    is >> is.END_BRACKET;
    return !is.getException();
}

static bool writeOptions(osgDB::OutputStream& os, const osgRayTrace::RayTraceSettings& settings)
{
    const auto options = osgRayTrace::RayTraceSettings::options();
    os.writeSize(options.size() - 1); // all but the servers
    os << os.BEGIN_BRACKET << std::endl;
    for (const auto& option : options)
    {
        if (option.name == kServers) continue;
        os << option.name << wordOf(settings.get(option.name)) << std::endl;
    }
    os << os.END_BRACKET << std::endl;
    return true;
}

REGISTER_OBJECT_WRAPPER(osgRayTrace_RayTraceSettings, new osgRayTrace::RayTraceSettings,
                        osgRayTrace::RayTraceSettings, "osg::Object osgRayTrace::RayTraceSettings")
{
    ADD_USER_SERIALIZER(Options);
    writeInClassicLocale(*wrapper);
}
