// PictureFile.cpp - OpenEXR with its channels, or an image for display. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PictureFile.h"

#include "apps/common/ImageFile.h"
#include "apps/common/Output.h"
#include "osgPlugins/exr/ExrImage.h"

#include <osgDB/FileNameUtils>

namespace osgRayTrace::app
{

namespace
{

void appendChannels(engine::ExrImage& exr, const osg::Image& image,
                    const std::vector<std::string>& names)
{
    const size_t step = names.size();
    const size_t pixels = size_t(image.s()) * image.t();
    const float* values = reinterpret_cast<const float*>(image.data());
    for (size_t c = 0; c < step; ++c)
    {
        engine::ExrChannel channel;
        channel.name = names[c];
        channel.values.resize(pixels);
        for (size_t i = 0; i < pixels; ++i)
            channel.values[i] = values[i * step + c];
        exr.channels.push_back(std::move(channel));
    }
}

/// Returns the customary names: depth and distance are Z, directions and positions X, Y, Z, the
/// rest colours.
std::vector<std::string> exrNames(const std::string& channel, bool vector)
{
    if (channel == "id") return {"id.I"};
    if (!vector) return {channel + ".Z"};
    if (channel == "normal" || channel == "position")
        return {channel + ".X", channel + ".Y", channel + ".Z"};
    return {channel + ".R", channel + ".G", channel + ".B"};
}

/// Returns an image of radiance and channels.
engine::ExrImage exrImageOf(const Picture& picture)
{
    engine::ExrImage exr;
    exr.width = picture.radiance->s();
    exr.height = picture.radiance->t();
    exr.texts = picture.texts;
    appendChannels(exr, *picture.radiance, {"R", "G", "B", "A"});
    for (const auto& [name, image] : picture.channels)
        appendChannels(exr, *image, exrNames(name, image->getPixelFormat() == GL_RGB));
    return exr;
}

} // namespace

void writePicture(const std::string& path, const Picture& picture)
{
    if (formatOf(path) == Format::Exr)
    {
        const std::string problem = engine::writeExr(path, exrImageOf(picture));
        if (!problem.empty()) throw cannotWrite(path, problem);
        return;
    }
    const bool keepsAlpha = picture.straight && osgDB::getLowerCaseFileExtension(path) == "png";
    writeImageFile(path, keepsAlpha ? *picture.straight : *picture.display, keepsAlpha);
}

} // namespace osgRayTrace::app
