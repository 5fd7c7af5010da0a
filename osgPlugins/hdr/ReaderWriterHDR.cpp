// ReaderWriterHDR.cpp - osgdb_hdr: Radiance's pictures for every OSG program. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/ImageReader.h"
#include "osgPlugins/hdr/RgbeConversion.h"

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

class ReaderWriterHDR : public ImageReader
{
public:
    ReaderWriterHDR() : ImageReader("Radiance picture")
    {
        supportsExtension("hdr", "Radiance picture format");
        supportsOption("RGB8", "Reading: the image has bytes, linear, cut off at 1");
        supportsOption("RGBMUL <factor>", "Reading: what RGB8 multiplies by. Default 1");
        supportsOption("RAW", "Reading and writing: the four bytes of a pixel as they are");
        supportsOption("YFLIP", "Reading: the image is upside down");
        supportsOption("NO_YFLIP", "Writing: the picture is upside down");
    }

    const char* className() const override { return "Radiance Image Reader/Writer"; }

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
        if (!handles(file)) return WriteResult::FILE_NOT_HANDLED;
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
    std::string decode(std::istream& stream, const Options* options,
                       osg::ref_ptr<osg::Image>& image) const override
    {
        const HdrOptions hdrOptions(options);
        RgbeImage rgbe;
        std::string problem = readRgbe(stream, rgbe);
        if (problem.empty()) problem = toOsgImage(rgbe, hdrOptions.kind, hdrOptions.factor, image);
        if (problem.empty() && hdrOptions.flipped) image->flipVertical();
        return problem;
    }

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
};

} // namespace

REGISTER_OSGPLUGIN(hdr, ReaderWriterHDR)
