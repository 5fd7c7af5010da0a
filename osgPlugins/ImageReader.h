// ImageReader.h - the frame of plugins that read a format of pictures. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>

#include <string>

namespace osgRayTrace::engine
{

/// Reads objects as images, and images from files as from streams.
class ImageReader : public osgDB::ReaderWriter
{
public:
    ReadResult readObject(std::istream& stream, const Options* options) const override
    {
        return readImage(stream, options);
    }

    ReadResult readObject(const std::string& file, const Options* options) const override
    {
        return readImage(file, options);
    }

    ReadResult readImage(std::istream& stream, const Options* options) const override
    {
        osg::ref_ptr<osg::Image> image;
        const std::string problem = decode(stream, options, image);
        if (!problem.empty()) return ReadResult(_format + ": " + problem);
        return image.get();
    }

    ReadResult readImage(const std::string& file, const Options* options) const override
    {
        if (!handles(file)) return ReadResult::FILE_NOT_HANDLED;
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;

        osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
        if (!stream) return ReadResult(_format + ": '" + path + "' cannot be opened");
        ReadResult result = readImage(stream, options);
        if (!result.success()) return ReadResult("'" + path + "': " + result.message());
        result.getImage()->setFileName(file);
        return result;
    }

protected:
    /// format: begins the messages.
    explicit ImageReader(const std::string& format) : _format(format) {}

    bool handles(const std::string& file) const
    {
        return acceptsExtension(osgDB::getLowerCaseFileExtension(file));
    }

    WriteResult written(const std::string& problem) const
    {
        if (problem.empty()) return WriteResult::FILE_SAVED;
        return WriteResult(_format + ": " + problem);
    }

private:
    /// Makes the image. Returns what is wrong with the stream, or nothing.
    virtual std::string decode(std::istream& stream, const Options* options,
                               osg::ref_ptr<osg::Image>& image) const = 0;

    const std::string _format;
};

} // namespace osgRayTrace::engine
