// ExrFiles.h - images and files for tests of osgdb_exr. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/exr/ExrImage.h"
#include "tests/Catch.h"

#include <osgDB/Registry>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace osgRayTrace::engine::test
{

inline osg::ref_ptr<osgDB::Options> makeOptions(const std::string& text)
{
    return new osgDB::Options(text);
}

inline osgDB::ReaderWriter* plugin()
{
    osgDB::ReaderWriter* result = osgDB::Registry::instance()->getReaderWriterForExtension("exr");
    REQUIRE(result);
    return result;
}

inline osgDB::ReaderWriter::ReadResult readImage(const std::string& path,
                                                 const std::string& options = "")
{
    return plugin()->readImage(path, makeOptions(options));
}

inline osgDB::ReaderWriter::WriteResult writeImage(const osg::Image& image, const std::string& path,
                                                   const std::string& options = "")
{
    return plugin()->writeImage(image, path, makeOptions(options));
}

/// Returns an image with different values in each component of each pixel, all of which are halves.
inline osg::ref_ptr<osg::Image> makeImage(int width, int height, GLenum format = GL_RGBA)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, GL_FLOAT);
    const int components = osg::Image::computeNumComponents(format);
    for (int y = 0; y < height; ++y)
    {
        auto* row = reinterpret_cast<float*>(image->data(0, y));
        for (int i = 0; i < width * components; ++i)
            row[i] = (i - y * 3) / 16.0f;
    }
    return image;
}

inline std::string bytesOf(const std::string& path)
{
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

inline void writeBytes(const std::string& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

inline ExrImage makeExrImage(int width, int height, const std::vector<std::string>& names,
                             bool asHalf = false)
{
    ExrImage image;
    image.width = width;
    image.height = height;
    for (const std::string& name : names)
    {
        ExrChannel channel{name, asHalf, {}};
        for (int i = 0; i < width * height; ++i)
        {
            channel.values.push_back(i / 4.0f + 100.0f * image.channels.size());
        }
        image.channels.push_back(channel);
    }
    return image;
}

} // namespace osgRayTrace::engine::test
