// ModelFiles.cpp - reads models through osgDB; refuses files that make it hang. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ModelFiles.h"

#include "osgRayTrace/base/TextFile.h"

#include <osg/Group>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace osgRayTrace::app
{

namespace
{

constexpr const char* kOsgtHeader = "#Ascii";

/// Returns whether an .osgt text ends before its first block, or within a block or a string: osgDB
/// 3.6 may read such a text for ever.
bool isCutShort(std::istream& stream)
{
    int blocks = 0;
    int depth = 0;
    bool quoted = false;
    bool escaped = false;
    for (std::istreambuf_iterator<char> at(stream), end; at != end; ++at)
    {
        const char c = *at;
        if (escaped)
            escaped = false;
        else if (quoted && c == '\\')
            escaped = true;
        else if (c == '"')
            quoted = !quoted;
        else if (!quoted && c == '{')
        {
            ++blocks;
            ++depth;
        }
        else if (!quoted && c == '}')
            --depth;
    }
    return quoted || depth > 0 || blocks == 0;
}

bool isCutShort(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    return isCutShort(stream);
}

osg::ref_ptr<osgDB::Options> readingOptions()
{
    osgDB::Registry* registry = osgDB::Registry::instance();
    const osg::ref_ptr<osgDB::Options> options =
        registry->getOptions() ? registry->getOptions()->cloneOptions() : new osgDB::Options;
    options->setPluginStringData("ForceReadingImage",
                                 "true"); // keeps the names of images that are missing
    return options;
}

osg::ref_ptr<osg::Node> readModel(const std::string& file)
{
    // Names with further extensions are for pseudo-loaders and may be no files themselves.
    const std::string found = osgDB::findDataFile(file);
    const std::string irregularity = found.empty() ? "" : engine::irregularityOf(found);
    if (!irregularity.empty() && !std::filesystem::is_directory(found)) // some plugins read folders
        throw Failure(kCannotLoad, "cannot load " + file + ": " + irregularity);
    if (!found.empty() && osgDB::getLowerCaseFileExtension(found) == "osgt" && isCutShort(found))
    {
        throw Failure(kCannotLoad, "cannot load " + file + ": it is cut short");
    }

    const osg::ref_ptr<osgDB::Options> options = readingOptions();
    osgDB::ReaderWriter::ReadResult result =
        osgDB::Registry::instance()->readNode(file, options.get());
    if (!result.validNode()) throw cannotLoad(file, result);
    return result.getNode();
}

} // namespace

osg::ref_ptr<osg::Node> readScene(const std::vector<std::string>& files)
{
    if (files.size() == 1) return readModel(files.front());
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const std::string& file : files)
    {
        scene->addChild(readModel(file));
    }
    return scene;
}

osg::ref_ptr<osg::Node> readSceneText(const std::string& text)
{
    const std::string name = "the text";
    std::istringstream stream(text);
    if (text.compare(0, std::strlen(kOsgtHeader), kOsgtHeader) != 0)
        throw Failure(kCannotLoad, "cannot load " + name + ": it does not begin with " +
                                       kOsgtHeader + ", as .osgt files do");
    if (isCutShort(stream)) throw Failure(kCannotLoad, "cannot load " + name + ": it is cut short");
    stream.clear();
    stream.seekg(0);
    osgDB::ReaderWriter* reader = osgDB::Registry::instance()->getReaderWriterForExtension("osgt");
    if (!reader) throw Failure(kCannotLoad, "OpenSceneGraph has no plugin for .osgt");
    osgDB::ReaderWriter::ReadResult result = reader->readNode(stream, readingOptions().get());
    if (!result.validNode()) throw cannotLoad(name, result);
    return result.getNode();
}

Failure cannotLoad(const std::string& file, const osgDB::ReaderWriter::ReadResult& result)
{
    std::string reason = result.message();
    if (reason.empty())
        reason = result.notFound() ? "there is no such file" : result.statusMessage();
    return Failure(kCannotLoad, "cannot load " + file + ": " + reason);
}

} // namespace osgRayTrace::app
