// Output.cpp - files that appear whole. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Output.h"

#include "apps/common/Failure.h"
#include "osgPlugins/exr/ExrImage.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace osgRayTrace::app
{

namespace fs = std::filesystem;

namespace
{

Failure cannotWrite(const std::string& path, const std::string& reason)
{
    return Failure(kCannotWrite, "cannot write " + path + ": " + reason);
}

/// The file itself where path is a link, so that a rename replaces what the link points to.
fs::path fileBehind(const std::string& path)
{
    std::error_code error;
    const fs::path file = fs::weakly_canonical(path, error);
    return error ? fs::path(path) : file;
}

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
        {
            channel.values[i] = values[i * step + c];
        }
        exr.channels.push_back(std::move(channel));
    }
}

/// By custom: depth and distance are Z, directions and positions X, Y, Z, the rest colours.
std::vector<std::string> exrNames(const std::string& channel, bool vector)
{
    if (channel == "id") return {"id.I"};
    if (!vector) return {channel + ".Z"};
    if (channel == "normal" || channel == "position")
        return {channel + ".X", channel + ".Y", channel + ".Z"};
    return {channel + ".R", channel + ".G", channel + ".B"};
}

void writeExrFile(const std::string& file, const Picture& picture)
{
    engine::ExrImage exr;
    exr.width = picture.radiance->s();
    exr.height = picture.radiance->t();
    appendChannels(exr, *picture.radiance, {"R", "G", "B", "A"});
    for (const auto& [name, image] : picture.channels)
    {
        appendChannels(exr, *image, exrNames(name, image->getPixelFormat() == GL_RGB));
    }
    const std::string problem = engine::writeExr(file, exr);
    if (!problem.empty()) throw std::runtime_error(problem);
}

/// Without alpha, which JPEG has not and which a picture for display does not need.
osg::ref_ptr<osg::Image> withoutAlpha(const osg::Image& rgba)
{
    osg::ref_ptr<osg::Image> rgb = new osg::Image;
    rgb->allocateImage(rgba.s(), rgba.t(), 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    const size_t pixels = size_t(rgba.s()) * rgba.t();
    for (size_t i = 0; i < pixels; ++i)
    {
        std::memcpy(rgb->data() + 3 * i, rgba.data() + 4 * i, 3);
    }
    return rgb;
}

void writeDisplayFile(const std::string& file, const Picture& picture, const std::string& extension)
{
    osgDB::ReaderWriter* writer =
        osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (!writer) throw std::runtime_error("OpenSceneGraph has no plugin for ." + extension);
    std::ofstream stream(file, std::ios::binary);
    const osgDB::ReaderWriter::WriteResult result =
        writer->writeImage(*withoutAlpha(*picture.display), stream);
    stream.close();
    if (!stream) throw std::runtime_error(std::strerror(errno));
    if (!result.success())
        throw std::runtime_error("the " + extension + " plugin failed " + result.message());
}

} // namespace

std::optional<Format> formatOf(const std::string& path)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (extension == "exr") return Format::Exr;
    if (extension == "png") return Format::Png;
    if (extension == "jpg" || extension == "jpeg") return Format::Jpeg;
    return std::nullopt;
}

void checkWritable(const std::string& path)
{
    const fs::path file = fileBehind(path);
    std::error_code error;
    if (fs::is_directory(file, error)) throw cannotWrite(path, "it is a folder");
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error))
        throw cannotWrite(path, "there is no folder " + folder.string());
    if (access(folder.c_str(), W_OK | X_OK) != 0) throw cannotWrite(path, std::strerror(errno));
}

void replaceFile(const std::string& path, const std::function<void(const std::string&)>& write)
{
    const fs::path file = fileBehind(path);
    fs::path beside = file;
    beside.replace_filename("." + std::to_string(getpid()) + "." + file.filename().string());
    try
    {
        write(beside.string());
        fs::rename(beside, file);
    }
    catch (const std::exception& problem)
    {
        std::error_code ignored;
        fs::remove(beside, ignored);
        throw cannotWrite(path, problem.what());
    }
}

void writePicture(const std::string& path, const Picture& picture)
{
    const Format format = formatOf(path).value();
    replaceFile(path,
                [&](const std::string& file)
                {
                    if (format == Format::Exr) return writeExrFile(file, picture);
                    writeDisplayFile(file, picture, format == Format::Png ? "png" : "jpg");
                });
}

void writeText(const std::string& path, const std::string& text)
{
    replaceFile(path,
                [&text](const std::string& file)
                {
                    std::ofstream stream(file, std::ios::binary);
                    stream << text;
                    stream.close();
                    if (!stream) throw std::runtime_error(std::strerror(errno));
                });
}

} // namespace osgRayTrace::app
