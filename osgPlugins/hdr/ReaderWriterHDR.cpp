// ReaderWriterHDR.cpp - osgdb_hdr: Radiance's pictures for every OSG program. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/hdr/RgbeConversion.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <locale>
#include <sstream>

namespace
{

using namespace osgRayTrace::engine;

/// Holds the options of OSG's own plugin, with its meaning.
struct HdrOptions
{
    RgbeKind kind = RgbeKind::Float;
    float factor = 1.0f;
    bool flipped = false;    ///< for reading
    bool upsideDown = false; ///< for writing

    explicit HdrOptions(const osgDB::Options* options)
    {
        std::istringstream words(options ? options->getOptionString() : "");
        words.imbue(std::locale::classic());
        for (std::string word; words >> word;)
        {
            if (word == "RGBMUL" && !(words >> factor)) factor = 1.0f;
            if (word == "RGB8") kind = RgbeKind::Bytes;
            if (word == "RAW") kind = RgbeKind::Raw;
            if (word == "YFLIP") flipped = true;
            if (word == "NO_YFLIP") upsideDown = true;
        }
    }
};

class ReaderWriterHDR : public osgDB::ReaderWriter
{
public:
    ReaderWriterHDR()
    {
        supportsExtension("hdr", "Radiance picture format");
        supportsOption("RGB8", "Reading: the image has bytes, linear, cut off at 1");
        supportsOption("RGBMUL <factor>", "Reading: what RGB8 multiplies by. Default 1");
        supportsOption("RAW", "Reading and writing: the four bytes of a pixel as they are");
        supportsOption("YFLIP", "Reading: the image is upside down");
        supportsOption("NO_YFLIP", "Writing: the picture is upside down");
    }

    const char* className() const override { return "Radiance Image Reader/Writer"; }

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
        const HdrOptions hdrOptions(options);
        RgbeImage image;
        osg::ref_ptr<osg::Image> result;
        std::string problem = readRgbe(stream, image);
        if (problem.empty())
            problem = toOsgImage(image, hdrOptions.kind, hdrOptions.factor, result);
        if (!problem.empty()) return ReadResult("Radiance picture: " + problem);
        if (hdrOptions.flipped) result->flipVertical();
        return result.get();
    }

    ReadResult readImage(const std::string& file, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string path = osgDB::findDataFile(file, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;

        osgDB::ifstream stream(path.c_str(), std::ios::in | std::ios::binary);
        if (!stream) return ReadResult("Radiance picture: '" + path + "' cannot be opened");
        ReadResult result = readImage(stream, options);
        if (!result.success()) return ReadResult("'" + path + "': " + result.message());
        result.getImage()->setFileName(file);
        return result;
    }

    WriteResult writeImage(const osg::Image& image, std::ostream& stream,
                           const Options* options) const override
    {
        RgbeImage rgbe;
        const std::string problem = encode(image, options, rgbe);
        return written(problem.empty() ? writeRgbe(stream, rgbe) : problem);
    }

    /// Writes a file; an image that cannot be encoded leaves the file as it was.
    WriteResult writeImage(const osg::Image& image, const std::string& file,
                           const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(file)))
            return WriteResult::FILE_NOT_HANDLED;
        RgbeImage rgbe;
        std::string problem = encode(image, options, rgbe);
        if (problem.empty())
        {
            osgDB::ofstream stream(file.c_str(), std::ios::out | std::ios::binary);
            problem = stream ? writeRgbe(stream, rgbe) : "the file cannot be created";
            stream.close();
            if (problem.empty() && !stream) problem = "the file cannot be written";
        }
        if (!problem.empty()) problem = "'" + file + "': " + problem;
        return written(problem);
    }

private:
    static std::string encode(const osg::Image& image, const Options* options, RgbeImage& rgbe)
    {
        const HdrOptions hdrOptions(options);
        const std::string problem = toRgbeImage(image, hdrOptions.kind == RgbeKind::Raw, rgbe);
        if (!problem.empty() || !hdrOptions.upsideDown) return problem;
        for (int y = 0; y < rgbe.height / 2; ++y)
        {
            const auto row = rgbe.pixels.begin() + static_cast<std::ptrdiff_t>(y) * rgbe.width;
            std::swap_ranges(row, row + rgbe.width,
                             rgbe.pixels.end() - static_cast<std::ptrdiff_t>(y + 1) * rgbe.width);
        }
        return problem;
    }

    static WriteResult written(const std::string& problem)
    {
        if (problem.empty()) return WriteResult::FILE_SAVED;
        return WriteResult("Radiance picture: " + problem);
    }
};

} // namespace

REGISTER_OSGPLUGIN(hdr, ReaderWriterHDR)
