// ImageFile.cpp - libpng's simplified API, and libjpeg with its own error handler. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/ImageFile.h"

#include "apps/common/Output.h"

#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <csetjmp>
#include <cstdio> // before jpeglib.h, which needs it

#include <jpeglib.h>
#include <png.h>

#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace osgRayTrace::app
{

namespace
{

constexpr int kJpegQuality = 100;    ///< quality of OSG's plugin
constexpr int kLargestPng = 1000000; ///< libpng's own limit of width and height

bool isJpeg(const std::string& extension)
{
    return extension == "jpg" || extension == "jpeg";
}

/// Returns the image without alpha, which JPEG lacks and which a picture for display does not need.
osg::ref_ptr<osg::Image> withoutAlpha(const osg::Image& image)
{
    const bool hasAlpha = image.getPixelFormat() == GL_RGBA;
    if ((!hasAlpha && image.getPixelFormat() != GL_RGB) || image.getDataType() != GL_UNSIGNED_BYTE)
        throw std::runtime_error("the image has no bytes of red, green and blue");
    osg::ref_ptr<osg::Image> rgb = new osg::Image;
    rgb->allocateImage(image.s(), image.t(), 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    if (!rgb->data()) throw std::bad_alloc();
    const int step = hasAlpha ? 4 : 3;
    for (int y = 0; y < image.t(); ++y)
    {
        const unsigned char* from = image.data(0, y);
        unsigned char* to = rgb->data(0, y);
        for (int x = 0; x < image.s(); ++x)
            std::memcpy(to + 3 * x, from + step * x, 3);
    }
    return rgb;
}

void writePng(const std::string& file, const osg::Image& rgb)
{
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(rgb.s());
    png.height = static_cast<png_uint_32>(rgb.t());
    const bool alpha = rgb.getPixelFormat() == GL_RGBA;
    png.format = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    const png_int_32 fromTheTop = (alpha ? -4 : -3) * rgb.s();
    errno = 0;
    if (png_image_write_to_file(&png, file.c_str(), 0, rgb.data(), fromTheTop, nullptr) == 0)
        throw std::runtime_error(errno ? std::strerror(errno) : png.message);
}

/// Replaces libjpeg's own error handler, which calls exit().
struct JpegErrors
{
    jpeg_error_mgr manager; ///< comes first: libjpeg knows this part alone
    std::jmp_buf giveUp;
    char message[JMSG_LENGTH_MAX];
};

extern "C" void giveUpJpeg(j_common_ptr jpeg)
{
    JpegErrors* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
    errors->manager.format_message(jpeg, errors->message);
    std::longjmp(errors->giveUp, 1);
}

extern "C" void ignoreJpegMessage(j_common_ptr) {}

/// Writes an image; false: see errors.message. No object in the function has a destructor, as the
/// jump out of libjpeg would not call it.
bool compressJpeg(std::FILE* file, const osg::Image& rgb, JpegErrors& errors)
{
    jpeg_compress_struct jpeg;
    jpeg.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = giveUpJpeg;
    errors.manager.output_message = ignoreJpegMessage;
    jpeg.mem = nullptr; // jpeg_destroy_compress reads it if the creation fails
    if (setjmp(errors.giveUp) != 0)
    {
        jpeg_destroy_compress(&jpeg);
        return false;
    }
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, file);
    jpeg.image_width = static_cast<JDIMENSION>(rgb.s());
    jpeg.image_height = static_cast<JDIMENSION>(rgb.t());
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, kJpegQuality, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height)
    {
        const int row = rgb.t() - 1 - static_cast<int>(jpeg.next_scanline);
        JSAMPROW pixels = const_cast<JSAMPROW>(rgb.data(0, row));
        jpeg_write_scanlines(&jpeg, &pixels, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    return true;
}

void writeJpeg(const std::string& path, const osg::Image& rgb)
{
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) throw std::runtime_error(std::strerror(errno));
    JpegErrors errors = {};
    errno = 0;
    const bool compressed = compressJpeg(file, rgb, errors);
    const int error = errno;
    const bool closed = std::fclose(file) == 0;
    if (!compressed && error == 0) throw std::runtime_error(errors.message);
    if (!compressed || !closed) throw std::runtime_error(std::strerror(error ? error : errno));
}

void writeByPlugin(const std::string& file, const osg::Image& image, const std::string& extension)
{
    osgDB::ReaderWriter* writer =
        osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    if (!writer) throw std::runtime_error("OpenSceneGraph has no plugin for ." + extension);
    std::ofstream stream(file, std::ios::binary);
    const osgDB::ReaderWriter::WriteResult result = writer->writeImage(image, stream);
    stream.close();
    if (!stream) throw std::runtime_error(std::strerror(errno));
    if (!result.success())
        throw std::runtime_error("the " + extension + " plugin failed " + result.message());
}

} // namespace

std::string whyNotInFormat(const std::string& extension, int width, int height)
{
    const int largest = isJpeg(extension)    ? JPEG_MAX_DIMENSION
                        : extension == "png" ? kLargestPng
                                             : INT_MAX;
    if (width <= largest && height <= largest) return "";
    return "a ." + extension + " is at most " + std::to_string(largest) + " pixels wide and high";
}

void writeImageFile(const std::string& path, const osg::Image& image, bool keepsAlpha)
{
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    writeOutput(path,
                [&](const std::string& file)
                {
                    const std::string problem = whyNotInFormat(extension, image.s(), image.t());
                    if (!problem.empty()) throw std::runtime_error(problem);
                    if (isJpeg(extension)) return writeJpeg(file, *withoutAlpha(image));
                    if (extension == "png")
                        return writePng(file, keepsAlpha ? image : *withoutAlpha(image));
                    writeByPlugin(file, image, extension);
                });
}

} // namespace osgRayTrace::app
