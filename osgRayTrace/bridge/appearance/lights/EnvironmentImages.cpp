// EnvironmentImages.cpp - reads the pixels of environments. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/lights/EnvironmentImages.h"

#include "osgRayTrace/bridge/appearance/textures/PixelDecoder.h"
#include "osgRayTrace/film/ToneMap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr int64_t kMostPixels = int64_t(1) << 28;

struct Pixels
{
    int width = 0, height = 0;
    std::vector<Vec3> radiance; ///< row 0 is the lowest
};

void repair(Vec3& pixel, ReplacedPixels& replaced)
{
    if (!isFinite(pixel))
    {
        ++replaced.notFinite;
        pixel = Vec3(0.0f);
    }
    const Vec3 clamped = glm::clamp(pixel, Vec3(0.0f), Vec3(kBrightestSky));
    if (clamped == pixel) return;
    ++(pixel.x < 0.0f || pixel.y < 0.0f || pixel.z < 0.0f ? replaced.negative : replaced.tooBright);
    pixel = clamped;
}

/// Counts pixels of floats and halfs that are not finite, because the decoder of textures makes
/// them black without a message.
uint64_t countNotFinite(const osg::Image& image)
{
    const auto channels = osg::Image::computeNumComponents(image.getPixelFormat());
    uint64_t count = 0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
        {
            const unsigned char* data = image.data(x, y);
            bool finite = true;
            for (unsigned int c = 0; c < channels; ++c)
                finite &= image.getDataType() == GL_FLOAT
                              ? std::isfinite(reinterpret_cast<const float*>(data)[c])
                              : (reinterpret_cast<const uint16_t*>(data)[c] & 0x7c00u) != 0x7c00u;
            count += !finite;
        }
    return count;
}

bool isPlainFloat(const osg::Image& image)
{
    return image.getDataType() == GL_FLOAT &&
           (image.getPixelFormat() == GL_RGB || image.getPixelFormat() == GL_RGBA);
}

/// Reads the floats of .hdr and .exr files without a copy of four channels in between.
void readFloats(const osg::Image& image, Pixels& pixels)
{
    const int channels = image.getPixelFormat() == GL_RGBA ? 4 : 3;
    Vec3* pixel = pixels.radiance.data();
    for (int y = 0; y < image.t(); ++y)
    {
        const auto* row = reinterpret_cast<const float*>(image.data(0, y));
        for (int x = 0; x < image.s(); ++x, row += channels)
            *pixel++ = Vec3(row[0], row[1], row[2]);
    }
}

bool readOthers(const osg::Image& image, bool decodeSrgb, ReplacedPixels& replaced, Pixels& pixels)
{
    Texture texture;
    if (!decodePixels(image, texture)) return false;
    const bool mayNotBeFinite =
        image.getDataType() == GL_FLOAT || image.getDataType() == GL_HALF_FLOAT;
    if (mayNotBeFinite && !image.isCompressed()) // the data type of compressed images tells nothing
        replaced.notFinite += countNotFinite(image);
    for (std::size_t i = 0; i < pixels.radiance.size(); ++i)
    {
        Vec3& pixel = pixels.radiance[i];
        for (int c = 0; c < 3; ++c)
        {
            const std::size_t at = i * 4 + static_cast<std::size_t>(c);
            if (!texture.floats.empty())
                pixel[c] = texture.floats[at];
            else
            {
                const float value = static_cast<float>(texture.bytes[at]) / 255.0f;
                pixel[c] = decodeSrgb ? linearFromSrgb(value) : value;
            }
        }
    }
    return true;
}

bool read(const osg::Image& image, bool decodeSrgb, int64_t mostPixels, ReplacedPixels& replaced,
          Pixels& pixels)
{
    if (!image.data() || image.s() < 1 || image.t() < 1 ||
        int64_t(image.s()) * image.t() > mostPixels)
        return false;
    pixels.width = image.s();
    pixels.height = image.t();
    pixels.radiance.resize(static_cast<std::size_t>(pixels.width) *
                           static_cast<std::size_t>(pixels.height));
    if (isPlainFloat(image))
        readFloats(image, pixels);
    else if (!readOthers(image, decodeSrgb, replaced, pixels))
        return false;
    for (Vec3& pixel : pixels.radiance)
        repair(pixel, replaced);
    return true;
}

/// Returns the radiance of a cube by direction [OpenGL21, table 3.19]; faces are stored from their
/// first row in memory.
Vec3 cubeRadiance(const std::array<Pixels, 6>& faces, Vec3d d)
{
    const Vec3d size = glm::abs(d);
    int face;
    double s, t, major;
    if (size.x >= size.y && size.x >= size.z)
    {
        face = d.x >= 0.0 ? 0 : 1;
        s = d.x >= 0.0 ? -d.z : d.z;
        t = -d.y;
        major = size.x;
    }
    else if (size.y >= size.z)
    {
        face = d.y >= 0.0 ? 2 : 3;
        s = d.x;
        t = d.y >= 0.0 ? d.z : -d.z;
        major = size.y;
    }
    else
    {
        face = d.z >= 0.0 ? 4 : 5;
        s = d.z >= 0.0 ? d.x : -d.x;
        t = -d.y;
        major = size.z;
    }
    const Pixels& pixels = faces[static_cast<std::size_t>(face)];
    const auto index = [&](double at)
    {
        return std::clamp(static_cast<int>((at / major + 1.0) * 0.5 * pixels.width), 0,
                          pixels.width - 1);
    };
    return pixels
        .radiance[static_cast<std::size_t>(index(t)) * static_cast<std::size_t>(pixels.width) +
                  static_cast<std::size_t>(index(s))];
}

} // namespace

std::shared_ptr<const EnvironmentImage>
environmentFromImage(const osg::Image& image, bool decodeSrgb, ReplacedPixels& replaced)
{
    Pixels pixels;
    if (!read(image, decodeSrgb, kMostPixels, replaced, pixels)) return nullptr;
    auto environment = std::make_shared<EnvironmentImage>();
    environment->width = pixels.width;
    environment->height = pixels.height;
    environment->radiance = std::move(pixels.radiance);
    if (image.getOrigin() != osg::Image::TOP_LEFT) return environment;
    for (int y = 0; y < pixels.height / 2; ++y)
    {
        const auto row = [&](int r)
        { return environment->radiance.begin() + std::ptrdiff_t(r) * pixels.width; };
        std::swap_ranges(row(y), row(y) + pixels.width, row(pixels.height - 1 - y));
    }
    return environment;
}

std::shared_ptr<const EnvironmentImage>
environmentFromCube(const std::vector<const osg::Image*>& images, bool decodeSrgb,
                    ReplacedPixels& replaced)
{
    if (images.size() != 6) return nullptr;
    constexpr int64_t kMostOfFace = kMostPixels / 8; // two by four faces are resampled
    std::array<Pixels, 6> faces;
    for (std::size_t f = 0; f < 6; ++f)
    {
        if (!images[f] || !read(*images[f], decodeSrgb, kMostOfFace, replaced, faces[f]))
            return nullptr;
        if (faces[f].width != faces[f].height || faces[f].width != faces[0].width) return nullptr;
    }
    constexpr int kPoints = 4; // points along a side of a pixel
    auto environment = std::make_shared<EnvironmentImage>();
    environment->width = 4 * faces[0].width;
    environment->height = 2 * faces[0].width;
    environment->radiance.reserve(static_cast<std::size_t>(environment->width) *
                                  static_cast<std::size_t>(environment->height));
    for (int y = 0; y < environment->height; ++y)
        for (int x = 0; x < environment->width; ++x)
        {
            Vec3 sum(0.0f);
            for (int k = 0; k < kPoints * kPoints; ++k)
            {
                const double column = x + (k % kPoints + 0.5) / kPoints;
                const double row = y + (k / kPoints + 0.5) / kPoints;
                const double azimuth = (column / environment->width - 0.5) * 2.0 * osg::PI;
                const double elevation = (row / environment->height - 0.5) * osg::PI;
                const double across = std::cos(elevation);
                sum += cubeRadiance(faces, {across * std::sin(azimuth), across * std::cos(azimuth),
                                            std::sin(elevation)}) *
                       (1.0f / (kPoints * kPoints));
            }
            environment->radiance.push_back(sum);
        }
    return environment;
}

std::shared_ptr<const EnvironmentImage> magentaEnvironment()
{
    auto environment = std::make_shared<EnvironmentImage>();
    environment->width = environment->height = 1;
    environment->radiance = {Vec3(1.0f, 0.0f, 1.0f)};
    return environment;
}

} // namespace osgRayTrace::engine
