// ModelFiles.cpp - reads models through osgDB; refuses files that make it hang. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ModelFiles.h"

#include "osgRayTrace/base/TextFile.h"

#include <osg/Group>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace osgRayTrace::app
{

namespace
{

/// Returns whether an .osgt file ends before its first block, or within a block or a string: osgDB
/// 3.6 may read such a file for ever.
bool isCutShort(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
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

    osgDB::Registry* registry = osgDB::Registry::instance();
    const osg::ref_ptr<osgDB::Options> options =
        registry->getOptions() ? registry->getOptions()->cloneOptions() : new osgDB::Options;
    options->setPluginStringData("ForceReadingImage",
                                 "true"); // keeps the names of images that are missing
    osgDB::ReaderWriter::ReadResult result = registry->readNode(file, options.get());
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

Failure cannotLoad(const std::string& file, const osgDB::ReaderWriter::ReadResult& result)
{
    std::string reason = result.message();
    if (reason.empty())
        reason = result.notFound() ? "there is no such file" : result.statusMessage();
    return Failure(kCannotLoad, "cannot load " + file + ": " + reason);
}

} // namespace osgRayTrace::app
