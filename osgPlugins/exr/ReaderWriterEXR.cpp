// ReaderWriterEXR.cpp - osgdb_exr: OpenEXR images for every OSG program. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrImage.h"
#include "osgPlugins/exr/ImageConversion.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <sstream>

namespace
{

using namespace osgRayTrace::engine;

struct ExrOptions
{
    GLenum readType = GL_FLOAT;
    bool half = false;
    bool full = false; ///< "float"
    ExrCompression compression = ExrCompression::Zip;
    std::string problem; ///< empty, or one sentence

    explicit ExrOptions(const osgDB::Options* options)
    {
        std::istringstream words(options ? options->getOptionString() : "");
        for (std::string word; words >> word;)
        {
            if (word == "half") readType = GL_HALF_FLOAT;
            if (word == "half") half = true;
            if (word == "float") full = true;
            if (word == "srgb8") readType = GL_UNSIGNED_BYTE;
            if (word.rfind("compression=", 0) == 0) parseCompression(word.substr(12));
        }
    }

private:
    void parseCompression(const std::string& name)
    {
        if (name == "zip")
            compression = ExrCompression::Zip;
        else if (name == "piz")
            compression = ExrCompression::Piz;
        else if (name == "none")
            compression = ExrCompression::None;
        else
            problem = "compression is zip, piz or none, not '" + name + "'";
    }
};

class ReaderWriterEXR : public osgDB::ReaderWriter
{
public:
    ReaderWriterEXR()
    {
        supportsExtension("exr", "OpenEXR image format");
        supportsOption("half", "Reading: the image has half values. Writing: the file has");
        supportsOption("srgb8", "Reading: the image has bytes, sRGB, for formats such as PNG");
        supportsOption("float",
                       "Writing: the file has float values, though the image has half values");
        supportsOption("compression=<zip|piz|none>", "Writing: how, without loss. Default zip");
    }

    const char* className() const override { return "OpenEXR Image Reader/Writer"; }

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
        ExrImage image;
        osg::ref_ptr<osg::Image> result;
        std::string problem = readExr(stream, image, exrColorChannels());
        if (problem.empty()) problem = toOsgImage(image, ExrOptions(options).readType, result);
        if (!problem.empty()) return ReadResult("OpenEXR: " + problem);
        return result.get();
    }

    ReadResult readImage(const std::string& file, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;

        osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
        if (!stream) return ReadResult("OpenEXR: '" + path + "' cannot be opened");
        ReadResult result = readImage(stream, options);
        if (!result.success()) return ReadResult("'" + path + "': " + result.message());
        result.getImage()->setFileName(file);
        return result;
    }

    WriteResult writeImage(const osg::Image& image, std::ostream& stream,
                           const Options* options) const override
    {
        return write(image, options,
                     [&](const ExrImage& exr, ExrCompression compression)
                     { return writeExr(stream, exr, compression); });
    }

    WriteResult writeImage(const osg::Image& image, const std::string& file,
                           const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return WriteResult::FILE_NOT_HANDLED;
        WriteResult result = write(image, options,
                                   [&](const ExrImage& exr, ExrCompression compression)
                                   { return writeExr(file, exr, compression); });
        if (!result.success()) result.message() = "'" + file + "': " + result.message();
        return result;
    }

private:
    template <class WriteFunction>
    static WriteResult write(const osg::Image& image, const Options* options,
                             WriteFunction writeFunction)
    {
        const ExrOptions exrOptions(options);
        const bool half =
            exrOptions.half || (image.getDataType() == GL_HALF_FLOAT && !exrOptions.full);
        ExrImage exr;
        std::string problem = exrOptions.problem;
        if (problem.empty()) problem = toExrImage(image, half, exr);
        if (problem.empty()) problem = writeFunction(exr, exrOptions.compression);
        if (!problem.empty()) return WriteResult("OpenEXR: " + problem);
        return WriteResult::FILE_SAVED;
    }
};

} // namespace

REGISTER_OSGPLUGIN(exr, ReaderWriterEXR)
