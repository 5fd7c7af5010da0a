// ReaderWriterEXR.cpp - osgdb_exr: OpenEXR images for every OSG program. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/ImageReader.h"
#include "osgPlugins/exr/ExrImage.h"
#include "osgPlugins/exr/ImageConversion.h"

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

class ReaderWriterEXR : public ImageReader
{
public:
    ReaderWriterEXR() : ImageReader("OpenEXR")
    {
        supportsExtension("exr", "OpenEXR image format");
        supportsOption("half", "Reading: the image has half values. Writing: the file has");
        supportsOption("srgb8", "Reading: the image has bytes, sRGB, for formats such as PNG");
        supportsOption("float",
                       "Writing: the file has float values, though the image has half values");
        supportsOption("compression=<zip|piz|none>", "Writing: how, without loss. Default zip");
    }

    const char* className() const override { return "OpenEXR Image Reader/Writer"; }

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
        if (!handles(file)) return WriteResult::FILE_NOT_HANDLED;
        WriteResult result = write(image, options,
                                   [&](const ExrImage& exr, ExrCompression compression)
                                   { return writeExr(file, exr, compression); });
        if (!result.success()) result.message() = "'" + file + "': " + result.message();
        return result;
    }

private:
    std::string decode(std::istream& stream, const Options* options,
                       osg::ref_ptr<osg::Image>& image) const override
    {
        ExrImage exr;
        const std::string problem = readExr(stream, exr, exrColorChannels());
        return problem.empty() ? toOsgImage(exr, ExrOptions(options).readType, image) : problem;
    }

    template <class WriteFunction>
    WriteResult write(const osg::Image& image, const Options* options,
                      WriteFunction writeFunction) const
    {
        const ExrOptions exrOptions(options);
        const bool half =
            exrOptions.half || (image.getDataType() == GL_HALF_FLOAT && !exrOptions.full);
        ExrImage exr;
        std::string problem = exrOptions.problem;
        if (problem.empty()) problem = toExrImage(image, half, exr);
        if (problem.empty()) problem = writeFunction(exr, exrOptions.compression);
        return written(problem);
    }
};

} // namespace

REGISTER_OSGPLUGIN(exr, ReaderWriterEXR)
